// SPDX-License-Identifier: Apache-2.0
// The name of an artifact: SHA-256 of its content, 64 lower-case hexadecimal digits.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "client/call/result.h"

namespace skinframe::client {

class Sha256 {
 public:
  Sha256();
  ~Sha256();
  void add(std::string_view bytes);
  std::string hex();  // once, at the end

 private:
  struct State;
  std::unique_ptr<State> state_;
};

struct FileDigest {
  std::string sha256;
  std::int64_t size_bytes = 0;
};

// kInput when the file is missing, no regular file, unreadable or empty.
Result<FileDigest> digest_input_file(const std::filesystem::path& path);

}  // namespace skinframe::client
