// SPDX-License-Identifier: Apache-2.0
#include "client/transfer/input_file.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>

namespace skinframe::client {

Result<FileDigest> digest_input_file(const std::filesystem::path& path) {
  const auto unreadable = [&](const std::string& why) {
    return Failure{FailureKind::kInput, fmt::format("{}: {}", path.string(), why)};
  };
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (status.type() == std::filesystem::file_type::not_found) return unreadable("there is no such file");
  if (error) return unreadable("cannot be read: " + error.message());
  if (!std::filesystem::is_regular_file(status))
    return unreadable("is not a file; give a mesh (STL, OBJ, PLY, OFF) or a frame problem (JSON)");
  std::ifstream in(path, std::ios::binary);
  if (!in) return unreadable(fmt::format("cannot be read: {}", std::strerror(errno)));
  FileDigest out = transport::digest_of(in);
  if (in.bad()) return unreadable("cannot be read to its end");
  if (out.size_bytes == 0)
    return unreadable("is empty; give a mesh (STL, OBJ, PLY, OFF) or a frame problem (JSON)");
  return out;
}

}  // namespace skinframe::client
