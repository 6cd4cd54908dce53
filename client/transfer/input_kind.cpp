// SPDX-License-Identifier: Apache-2.0
#include "client/transfer/input_kind.h"

#include <fstream>
#include <string>
#include <string_view>
#include <system_error>

namespace skinframe::client {
namespace {

constexpr std::size_t kHeadBytes = 4096;
constexpr std::string_view kSpace = " \t\r\n";

// {" or {} but for white space. The header of a binary STL may hold anything; a zero byte among it gives it
// away.
bool begins_as_json_object(std::string_view head) {
  if (head.starts_with("\xEF\xBB\xBF")) head.remove_prefix(3);
  const std::size_t open = head.find_first_not_of(kSpace);
  if (open == std::string_view::npos || head[open] != '{') return false;
  const std::size_t next = head.find_first_not_of(kSpace, open + 1);
  const bool begins = next == std::string_view::npos || head[next] == '"' || head[next] == '}';
  return begins && head.find('\0') == std::string_view::npos;
}

}  // namespace

InputKind input_kind(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return InputKind::kMesh;
  std::ifstream in(path, std::ios::binary);
  std::string head(kHeadBytes, '\0');
  in.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(in.gcount()));
  return begins_as_json_object(head) ? InputKind::kFrameProblem : InputKind::kMesh;
}

}  // namespace skinframe::client
