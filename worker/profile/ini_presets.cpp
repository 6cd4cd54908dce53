// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/profile/ini_presets.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "worker/profile/import_profile.h"

namespace skinframe {
namespace {

constexpr std::size_t kMostBytes = std::size_t{16} << 20;
constexpr std::size_t kMostPresets = 20'000;
constexpr std::size_t kDeepest = 64;
constexpr std::string_view kPrinterSection = "printer:";

std::string trimmed(std::string_view text) {
  const auto from = text.find_first_not_of(" \t\r");
  if (from == std::string_view::npos) return "";
  return std::string(text.substr(from, text.find_last_not_of(" \t\r") - from + 1));
}

// "*common*; Original Prusa i3 MK3"
std::vector<std::string> split_parents(const std::string& text) {
  std::vector<std::string> parents;
  for (std::size_t from = 0; from <= text.size();) {
    const auto to = std::min(text.find(';', from), text.size());
    std::string name = trimmed(std::string_view(text).substr(from, to - from));
    if (name.size() >= 2 && name.front() == '"' && name.back() == '"') name = name.substr(1, name.size() - 2);
    if (!name.empty()) parents.push_back(std::move(name));
    from = to + 1;
  }
  return parents;
}

// Whether it is the plain name of a file in the same folder.
bool stays_here(const std::string& name) {
  return !name.empty() && name.front() != '.' && name.find('/') == std::string::npos &&
         name.find('\0') == std::string::npos && name.size() <= 200;
}

std::string arrows(const std::vector<std::string>& path, std::size_t from) {
  std::string text;
  for (std::size_t i = from; i < path.size(); ++i) text += path[i] + " -> ";
  return text + path[from];
}

}  // namespace

Result<IniPresets> IniPresets::read(const std::filesystem::path& file) {
  IniPresets out;
  out.file_ = file.filename().string();
  if (auto added = out.add_file(file, false); !added) return added.error();
  if (out.presets_.empty())
    return invalid_input(fmt::format(
        "{}: neither [printer:NAME] sections nor lines of `key = value` are in it", file.string()));
  for (const auto& [name, preset] : out.presets_)
    if (!name.starts_with('*')) out.names_.push_back(name);
  if (auto added = out.add_parents_beside(file.parent_path()); !added) return added.error();
  return out;
}

Status IniPresets::add_file(const std::filesystem::path& file, bool as_parent) {
  const auto text = read_text_file(file, kMostBytes);
  if (!text) return text.error();
  const std::string name = file.filename().string();
  std::string section = file.stem().string();  // of bare lines, before any section
  bool counts = true, in_bundle = false;
  int line_number = 0;
  for (std::size_t from = 0; from < text->size();) {
    const auto to = std::min(text->find('\n', from), text->size());
    const std::string line = trimmed(std::string_view(*text).substr(from, to - from));
    from = to + 1;
    ++line_number;
    if (line.empty() || line.front() == '#' || line.front() == ';') continue;
    if (line.front() == '[') {
      if (line.back() != ']')
        return invalid_input(fmt::format("{}:{}: a section without its ]", file.string(), line_number));
      if (!in_bundle && !as_parent) presets_.clear();  // lines before the first section are no preset
      in_bundle = true;
      const std::string title = line.substr(1, line.size() - 2);
      counts = title.starts_with(kPrinterSection);
      if (counts) section = trimmed(std::string_view(title).substr(kPrinterSection.size()));
      if (counts) presets_[section];
      continue;
    }
    if (!counts) continue;
    const auto equals = line.find('=');
    if (equals == std::string::npos) {
      if (in_bundle) continue;
      return invalid_input(fmt::format("{}:{}: not `key = value`", file.string(), line_number));
    }
    if (presets_.size() > kMostPresets)
      return invalid_input(
          fmt::format("{}:{}: more than {} presets", file.string(), line_number, kMostPresets));
    Preset& preset = presets_[section];
    const std::string key = trimmed(std::string_view(line).substr(0, equals));
    IniValue value{trimmed(std::string_view(line).substr(equals + 1)), name, line_number};
    if (key == "inherits") preset.parents = split_parents(value.text);
    preset.values[key] = std::move(value);
  }
  return ok_status();
}

Status IniPresets::add_parents_beside(const std::filesystem::path& folder) {
  for (std::size_t round = 0; round < kDeepest; ++round) {
    std::set<std::string> wanted;
    for (const auto& [name, preset] : presets_)
      for (const std::string& parent : preset.parents)
        if (!presets_.contains(parent) && stays_here(parent)) wanted.insert(parent);
    bool added = false;
    for (const std::string& parent : wanted) {
      std::error_code none;
      const auto path = folder / (parent + ".ini");
      if (!std::filesystem::is_regular_file(path, none)) continue;
      presets_[parent];
      if (auto read = add_file(path, true); !read) return read.error();
      added = true;
    }
    if (!added) break;
  }
  return ok_status();
}

Result<std::vector<std::string>> IniPresets::missing_parents(const std::string& name) const {
  std::vector<std::string> path, missing;
  std::set<std::string> done;
  if (auto walked = walk(name, path, done, missing); !walked) return walked.error();
  return missing;
}

Status IniPresets::walk(const std::string& name, std::vector<std::string>& path, std::set<std::string>& done,
                        std::vector<std::string>& missing) const {
  if (const auto at = std::find(path.begin(), path.end(), name); at != path.end())
    return invalid_input(fmt::format("{}: inherits runs in a circle: {}", file_,
                                     arrows(path, static_cast<std::size_t>(at - path.begin()))));
  if (!done.insert(name).second) return ok_status();
  const auto preset = presets_.find(name);
  if (preset == presets_.end()) {
    missing.push_back(name);
    return ok_status();
  }
  path.push_back(name);
  if (path.size() > kDeepest)
    return invalid_input(
        fmt::format("{}: \"{}\" inherits over more than {} presets", file_, path[0], kDeepest));
  for (const std::string& parent : preset->second.parents)
    if (auto walked = walk(parent, path, done, missing); !walked) return walked.error();
  path.pop_back();
  return ok_status();
}

std::optional<IniValue> IniPresets::find(const std::string& preset, const std::string& key) const {
  std::set<std::string> asked;
  return find(preset, key, asked);
}

std::optional<IniValue> IniPresets::find(const std::string& name, const std::string& key,
                                         std::set<std::string>& asked) const {
  const auto preset = presets_.find(name);
  if (preset == presets_.end() || !asked.insert(name).second) return std::nullopt;
  if (const auto own = preset->second.values.find(key); own != preset->second.values.end())
    return own->second;
  const auto& parents = preset->second.parents;
  for (auto parent = parents.rbegin(); parent != parents.rend(); ++parent)
    if (auto found = find(*parent, key, asked)) return found;
  return std::nullopt;
}

}  // namespace skinframe
