// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "worker/profile/import_profile.h"

namespace skinframe {
namespace {

using nlohmann::json;

constexpr std::size_t kMostBytes = std::size_t{8} << 20;
constexpr std::size_t kDeepest = 32;  // parents; and settings within settings

struct Definition {
  std::string file;
  json content;
};

// A name of the format's own kind: no folder, nothing hidden.
bool is_plain_name(const std::string& name) {
  return !name.empty() && name.size() <= 200 && name.front() != '.' &&
         std::all_of(name.begin(), name.end(), [](unsigned char c) {
           return std::isalnum(c) != 0 || c == '_' || c == '-' || c == '.' || c == ' ' || c == '+';
         });
}

Result<Definition> read_definition(const std::filesystem::path& file) {
  auto content = read_json_file(file, kMostBytes);
  if (!content) return content.error();
  if (!content->is_object())
    return invalid_input(fmt::format("{}: not a Cura definition: no JSON object", file.string()));
  return Definition{file.filename().string(), std::move(content).value()};
}

// The file and its ancestors, nearest first. A parent that is not beside it ends the list, with a note.
Result<std::vector<Definition>> read_ancestry(const std::filesystem::path& file, std::string& note) {
  std::vector<Definition> all;
  std::vector<std::string> names;
  for (std::filesystem::path next = file;;) {
    auto definition = read_definition(next);
    if (!definition) return definition.error();
    all.push_back(std::move(definition).value());
    const json& inherits = all.back().content.value("inherits", json());
    if (inherits.is_null()) return all;
    if (!inherits.is_string() || !is_plain_name(inherits.get<std::string>()))
      return invalid_input(
          fmt::format("{}: inherits: not the name of a definition beside it", next.string()));
    const std::string parent = inherits.get<std::string>() + ".def.json";
    names.push_back(all.back().file);
    if (std::find(names.begin(), names.end(), parent) != names.end())
      return invalid_input(
          fmt::format("{}: inherits: runs in a circle: {} was there before", next.string(), parent));
    if (all.size() == kDeepest)
      return invalid_input(
          fmt::format("{}: inherits: more than {} definitions deep", file.string(), kDeepest));
    next = file.parent_path() / parent;
    std::error_code none;
    if (!std::filesystem::exists(next, none)) {
      note = fmt::format("{} inherits from {}, which is not beside it: what it says is left out",
                         all.back().file, parent);
      return all;
    }
  }
}

// Of "settings" a tree by "children", of "overrides" a flat list.
const json* find_setting(const json& settings, const std::string& key, std::size_t depth) {
  if (!settings.is_object() || depth > kDeepest) return nullptr;
  if (const auto here = settings.find(key); here != settings.end())
    return here->is_object() ? &*here : nullptr;
  for (const auto& [name, setting] : settings.items()) {
    if (!setting.is_object() || !setting.contains("children")) continue;
    if (const json* below = find_setting(setting["children"], key, depth + 1)) return below;
  }
  return nullptr;
}

struct Found {
  std::optional<double> value;  // none: a formula
  std::string file;
};

std::optional<Found> find_number(const std::vector<Definition>& ancestry, const std::string& key) {
  for (const Definition& definition : ancestry) {
    for (const char* part : {"overrides", "settings"}) {
      if (!definition.content.contains(part)) continue;
      const json* setting = find_setting(definition.content[part], key, 0);
      if (setting == nullptr) continue;
      for (const char* word : {"value", "default_value"}) {  // a value stands above a default
        if (!setting->contains(word)) continue;
        const json& value = (*setting)[word];
        return Found{value.is_number() ? std::optional(value.get<double>()) : std::nullopt, definition.file};
      }
    }
  }
  return std::nullopt;
}

}  // namespace

Result<ProfileDraft> import_cura(const std::filesystem::path& file) {
  std::string note;
  const auto ancestry = read_ancestry(file, note);
  if (!ancestry) return ancestry.error();
  ProfileDraft draft = ProfileDraft::printer("extrusion");
  const json& top = ancestry->front().content;
  const bool named =
      top.contains("name") && top["name"].is_string() && !top["name"].get<std::string>().empty();
  draft.name(named ? top["name"].get<std::string>().substr(0, 200) : file.filename().string());
  if (!note.empty()) draft.note(note);

  struct Field {
    const char *ours, *theirs;
    double least, most;
  };
  for (const Field& field :
       {Field{"tray_x_mm", "machine_width", 1, 10'000}, Field{"tray_y_mm", "machine_depth", 1, 10'000},
        Field{"tray_z_mm", "machine_height", 1, 10'000},
        Field{"nozzle_mm", "machine_nozzle_size", 0.01, 100}}) {
    const auto found = find_number(*ancestry, field.theirs);
    if (!found) continue;
    if (!found->value) {
      draft.note(fmt::format("{} in {} is a formula: left out", field.theirs, found->file));
      continue;
    }
    if (!(*found->value >= field.least && *found->value <= field.most))
      return invalid_input(fmt::format("{}: {}: {:g} is not within {:g} .. {:g} mm", found->file,
                                       field.theirs, *found->value, field.least, field.most));
    draft.set(field.ours, *found->value, fmt::format("Cura definition {}: {}", found->file, field.theirs));
  }
  return draft;
}

}  // namespace skinframe
