// SPDX-License-Identifier: GPL-3.0-or-later
// A profile file as an importer leaves it: every field there, null where the file imported does not say, and
// a source for each number. server/catalog/README.md gives the format.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace skinframe {

class ProfileDraft {
 public:
  static ProfileDraft printer(const std::string& process);
  static ProfileDraft material();

  void name(const std::string& display_name);  // and the id made of it
  void set_id(const std::string& id) { fields_["id"] = id; }
  void set(const std::string& field, double value, const std::string& source);

  std::string text() const;                  // the file
  std::vector<std::string> unknown() const;  // fields that are null, for people
  void note(std::string text) { notes_.push_back(std::move(text)); }
  const std::vector<std::string>& notes() const { return notes_; }  // what was left out, and why

 private:
  ProfileDraft(std::string kind, const std::vector<std::string>& fields);

  std::string kind_;
  nlohmann::ordered_json fields_;
  std::vector<std::string> notes_;
};

// "PLA+ (Silk) 2" becomes "pla-silk-2"; at most 64 of [a-z0-9-]; "profile" when nothing is left.
std::string id_from_name(const std::string& name);

}  // namespace skinframe
