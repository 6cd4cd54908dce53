// SPDX-License-Identifier: Apache-2.0
#include "server/lined_json/lined_json.h"

#include <fmt/format.h>

#include <iterator>
#include <vector>

namespace skinframe::server {
namespace {

using nlohmann::json;

constexpr int kDeepest = 16;

// Reads the text and counts its lines in passing: the parser reads a string's end and a bracket without
// looking ahead, so that the count is right when it tells of one.
class CountingIterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  CountingIterator(const char* at, int* line) : at_(at), line_(line) {}
  reference operator*() const { return *at_; }
  CountingIterator& operator++() {
    if (*at_ == '\n') ++*line_;
    ++at_;
    return *this;
  }
  CountingIterator operator++(int) {
    CountingIterator before = *this;
    ++*this;
    return before;
  }
  bool operator==(const CountingIterator& other) const { return at_ == other.at_; }
  bool operator!=(const CountingIterator& other) const { return at_ != other.at_; }

 private:
  const char* at_;
  int* line_;
};

// Thrown through the parser, which would else read on: parse_lined_json makes it a status.
struct Problem {
  std::string text;
};

// Where the parser stands: an object with the key that was read last, or an array with its count.
struct Place {
  std::string path;
  bool is_array = false;
  int next = 0;
};

std::string joined(const std::string& path, const std::string& key) {
  return path.empty() ? key : path + "." + key;
}

class Walk {
 public:
  Walk(const std::string& file, const int& line, std::map<std::string, int>& lines)
      : file_(file), line_(line), lines_(lines) {}

  void tell(json::parse_event_t event, json& value) {
    switch (event) {
      case json::parse_event_t::object_start:
      case json::parse_event_t::array_start:
        if (static_cast<int>(places_.size()) >= kDeepest) refuse("is nested too deeply");
        places_.push_back({next_path(), event == json::parse_event_t::array_start, 0});
        lines_.emplace(places_.back().path, line_);
        break;
      case json::parse_event_t::object_end:
      case json::parse_event_t::array_end:
        places_.pop_back();
        break;
      case json::parse_event_t::key:
        key_ = value.get<std::string>();
        if (!lines_.emplace(joined(places_.back().path, key_), line_).second)
          refuse(fmt::format("\"{}\" stands twice", joined(places_.back().path, key_)));
        break;
      case json::parse_event_t::value:
        if (!places_.empty() && places_.back().is_array) lines_.emplace(next_path(), line_);
        break;
    }
  }

 private:
  std::string next_path() {
    if (places_.empty()) return "";
    Place& place = places_.back();
    return place.is_array ? fmt::format("{}[{}]", place.path, place.next++) : joined(place.path, key_);
  }
  [[noreturn]] void refuse(const std::string& what) const {
    throw Problem{fmt::format("{}:{}: {}", file_, line_, what)};
  }

  const std::string& file_;
  const int& line_;
  std::map<std::string, int>& lines_;
  std::vector<Place> places_;
  std::string key_;
};

}  // namespace

int LinedJson::line(const std::string& path) const {
  for (std::string part = path;;) {
    if (const auto at = lines.find(part); at != lines.end()) return at->second;
    const auto end = part.find_last_of(".[");
    if (end == std::string::npos) return 1;
    part.resize(end);
  }
}

absl::StatusOr<LinedJson> parse_lined_json(std::string_view text, const std::string& file) {
  LinedJson out;
  int line = 1;
  Walk walk(file, line, out.lines);
  const json::parser_callback_t tell = [&](int, json::parse_event_t event, json& value) {
    walk.tell(event, value);
    return true;
  };
  try {
    out.value = json::parse(CountingIterator(text.data(), &line),
                            CountingIterator(text.data() + text.size(), &line), tell);
  } catch (const Problem& problem) {
    return absl::InvalidArgumentError(problem.text);
  } catch (const json::exception& error) {  // not JSON, not UTF-8, a number beyond all numbers
    std::string what = error.what();        // "[json.exception.parse_error.101] parse error at line 3, ..."
    if (const auto at = what.find("] "); at != std::string::npos) what.erase(0, at + 2);
    return absl::InvalidArgumentError(fmt::format("{}:{}: not JSON: {}", file, line, what));
  }
  return out;
}

}  // namespace skinframe::server
