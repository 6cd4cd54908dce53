// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <string>

#include "worker/profile/import_profile.h"

namespace skinframe {

Result<std::string> read_text_file(const std::filesystem::path& file, std::size_t most_bytes) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status))
    return io_error(fmt::format("{}: there is no such file", file.string()));
  if (!std::filesystem::is_regular_file(status))
    return io_error(fmt::format("{}: not a regular file", file.string()));
  const auto size = std::filesystem::file_size(file, error);
  if (error) return io_error(fmt::format("{}: {}", file.string(), error.message()));
  if (size > most_bytes)
    return invalid_input(
        fmt::format("{}: {} bytes are too many; {} are the limit", file.string(), size, most_bytes));
  std::string text(size, '\0');
  std::ifstream in(file, std::ios::binary);
  in.read(text.data(), static_cast<std::streamsize>(size));
  if (!in.is_open() || in.bad()) return io_error(fmt::format("{}: cannot be read", file.string()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  return text;
}

Result<nlohmann::json> read_json_file(const std::filesystem::path& file, std::size_t most_bytes) {
  using nlohmann::json;
  const auto text = read_text_file(file, most_bytes);
  if (!text) return text.error();
  try {
    return json::parse(*text);
  } catch (const json::parse_error& error) {
    const auto end = text->begin() + static_cast<std::ptrdiff_t>(std::min(error.byte, text->size()));
    return invalid_input(fmt::format("{}:{}: not JSON: {}", file.string(),
                                     1 + std::count(text->begin(), end, '\n'), error.what()));
  } catch (const json::exception& error) {  // a number beyond all numbers
    return invalid_input(fmt::format("{}: not JSON: {}", file.string(), error.what()));
  }
}

Result<ProfileDraft> import_printer(const std::filesystem::path& file, const std::string& preset) {
  if (file.string().ends_with(".def.json")) return import_cura(file);
  return import_prusa_slicer(file, preset);
}

}  // namespace skinframe
