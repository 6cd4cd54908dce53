// SPDX-License-Identifier: GPL-3.0-or-later
// The printer presets of PrusaSlicer files, with inheritance.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "worker/run/result.h"

namespace skinframe {

struct IniValue {
  std::string text;
  std::string file;  // its name without folder
  int line = 0;
};

class IniPresets {
 public:
  // A bundle's [printer:NAME] sections, or a file of bare lines as one preset of the file's name. The parents
  // of such a preset are read from NAME.ini in its folder, where there is one.
  static Result<IniPresets> read(const std::filesystem::path& file);

  // Of the file's own whole presets: neither *abstract* ones nor parents from other files.
  const std::vector<std::string>& names() const { return names_; }
  bool has(const std::string& name) const { return presets_.contains(name); }

  // kInvalidInput: parents in a circle, or more than 64 deep. Names of parents that are nowhere.
  Result<std::vector<std::string>> missing_parents(const std::string& name) const;

  // The preset's own value, or that of its last parent that has one. After missing_parents() was fine.
  std::optional<IniValue> find(const std::string& preset, const std::string& key) const;

 private:
  struct Preset {
    std::map<std::string, IniValue> values;
    std::vector<std::string> parents;
  };
  Status add_file(const std::filesystem::path& file, bool as_parent);
  Status add_parents_beside(const std::filesystem::path& folder);
  Status walk(const std::string& name, std::vector<std::string>& path, std::set<std::string>& done,
              std::vector<std::string>& missing) const;
  std::optional<IniValue> find(const std::string& preset, const std::string& key,
                               std::set<std::string>& asked) const;

  std::map<std::string, Preset> presets_;
  std::vector<std::string> names_;
  std::string file_;
};

}  // namespace skinframe
