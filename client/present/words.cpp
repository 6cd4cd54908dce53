// SPDX-License-Identifier: Apache-2.0
#include "client/present/words.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace skinframe::client {
namespace {

std::string without_prefix(const std::string& name, std::string_view prefix, int number) {
  if (name.empty()) return fmt::format("{}?", number);  // a newer server's word
  return name.substr(prefix.size());
}

std::string cased(std::string text, int (*change)(int)) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [change](unsigned char c) { return static_cast<char>(change(c)); });
  return text;
}

}  // namespace

std::string state_word(v1::JobState state) {
  return without_prefix(v1::JobState_Name(state), "JOB_STATE_", state);
}

std::string reason_word(v1::Reason reason) {
  if (reason == v1::REASON_UNSPECIFIED) return "NONE";
  return without_prefix(v1::Reason_Name(reason), "REASON_", reason);
}

std::string process_word(v1::PrintProcess process) {
  return cased(without_prefix(v1::PrintProcess_Name(process), "PRINT_PROCESS_", process), std::tolower);
}

std::optional<v1::JobState> state_from_word(std::string_view word) {
  v1::JobState state = v1::JOB_STATE_UNSPECIFIED;
  if (!v1::JobState_Parse("JOB_STATE_" + cased(std::string(word), std::toupper), &state)) return std::nullopt;
  if (state == v1::JOB_STATE_UNSPECIFIED) return std::nullopt;
  return state;
}

std::string time_text(const google::protobuf::Timestamp& time) {
  constexpr std::int64_t kYear10000 = 253402300800;
  if (time.seconds() <= 0 || time.seconds() >= kYear10000) return "-";
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03}Z", fmt::gmtime(static_cast<std::time_t>(time.seconds())),
                     time.nanos() / 1'000'000);
}

std::string one_line(std::string_view text) {
  std::string out(text);
  for (std::size_t i = 0; i < out.size(); ++i) {
    const auto byte = static_cast<unsigned char>(out[i]);
    if (byte < 0x20 || byte == 0x7F) out[i] = ' ';
    // U+0080 .. U+009F, the other control characters, are 0xC2 and 0x80 .. 0x9F in UTF-8.
    const bool control = byte == 0xC2 && i + 1 < out.size() && static_cast<unsigned char>(out[i + 1]) <= 0x9F;
    if (control) out[i] = out[i + 1] = ' ';
  }
  return out;
}

}  // namespace skinframe::client
