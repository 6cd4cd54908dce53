// SPDX-License-Identifier: Apache-2.0
#include "client/transfer/safe_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace skinframe::client {
namespace {

bool plain_name(std::string_view name) {
  if (name.empty() || name == "." || name == ".." || name.size() > 255) return false;
  return std::all_of(name.begin(), name.end(), [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte >= 0x20 && byte != 0x7F && c != '\\';
  });
}

}  // namespace

Result<std::filesystem::path> path_inside(const std::filesystem::path& folder, const std::string& relative) {
  std::filesystem::path out = folder;
  std::string_view rest = relative;
  while (true) {
    const std::size_t slash = rest.find('/');
    const std::string_view name = rest.substr(0, slash);
    if (!plain_name(name)) {
      std::string shown = relative.substr(0, 100);
      std::replace_if(
          shown.begin(), shown.end(), [](unsigned char c) { return c < 0x20 || c > 0x7E; }, '?');
      return Failure{
          FailureKind::kInternal,
          fmt::format("the server names a result file \"{}\"; that is no path inside a folder", shown)};
    }
    out /= name;
    if (slash == std::string_view::npos) return out;
    rest.remove_prefix(slash + 1);
  }
}

}  // namespace skinframe::client
