// SPDX-License-Identifier: Apache-2.0
// Which verbs are not this program's own.
#include <algorithm>
#include <array>
#include <iterator>
#include <string_view>

#include "client/cli/command_line.h"

namespace skinframe::client {
namespace {

constexpr std::array<std::string_view, 5> kLocalVerbs = {"sample", "check", "solve-frame", "calibrate",
                                                         "render"};
// Verbs of the server with a part that runs here: `printers import FILE`.
constexpr std::array<std::string_view, 2> kProfileVerbs = {"printers", "materials"};

constexpr std::array<std::string_view, 6> kGlobalOptionsWithValue = {"--server",  "--tls-ca", "--tls-cert",
                                                                     "--tls-key", "--token",  "--config"};

template <class List>
bool contains(const List& list, std::string_view word) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

// Index of the first word that is neither a global option nor the value of one.
std::optional<std::size_t> verb_index(const std::vector<std::string>& words) {
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (contains(kGlobalOptionsWithValue, words[i])) {
      ++i;
    } else if (words[i].empty() || words[i][0] != '-') {
      return i;
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<LocalVerb> local_verb(const std::vector<std::string>& words) {
  const auto index = verb_index(words);
  if (!index) return std::nullopt;
  const bool imports =
      contains(kProfileVerbs, words[*index]) && *index + 1 < words.size() && words[*index + 1] == "import";
  if (!imports && !contains(kLocalVerbs, words[*index])) return std::nullopt;
  LocalVerb out;
  out.words.assign(words.begin() + static_cast<std::ptrdiff_t>(*index), words.end());
  if (contains(out.words, "--help") || contains(out.words, "-h")) return std::nullopt;
  const bool json_before = std::find(words.begin(), words.begin() + static_cast<std::ptrdiff_t>(*index),
                                     "--json") != words.begin() + static_cast<std::ptrdiff_t>(*index);
  if (json_before) out.words.push_back("--json");
  return out;
}

}  // namespace skinframe::client
