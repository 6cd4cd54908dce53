// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/pipeline/write_json.h"

#include <fmt/format.h>

#include <fstream>

namespace skinframe {

Status write_json(const std::filesystem::path& path, const nlohmann::json& document) {
  std::error_code error;
  std::filesystem::create_directories(path.parent_path(), error);
  if (error) return io_error(fmt::format("{}: {}", path.parent_path().string(), error.message()));
  const std::filesystem::path temporary = path.string() + ".part";
  std::ofstream out(temporary, std::ios::binary);
  out << document.dump(1) << '\n';
  out.close();
  if (!out) return io_error(fmt::format("{}: cannot be written; is the disk full?", temporary.string()));
  std::filesystem::rename(temporary, path, error);
  if (error) return io_error(fmt::format("{}: {}", path.string(), error.message()));
  return ok_status();
}

}  // namespace skinframe
