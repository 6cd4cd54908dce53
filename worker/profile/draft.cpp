// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/profile/draft.h"

#include <algorithm>

namespace skinframe {

ProfileDraft::ProfileDraft(std::string kind, const std::vector<std::string>& fields)
    : kind_(std::move(kind)) {
  for (const std::string& field : fields) fields_[field] = nullptr;
  fields_["sources"] = nlohmann::ordered_json::object();
}

ProfileDraft ProfileDraft::printer(const std::string& process) {
  ProfileDraft draft("printer", {"id", "display_name", "process", "min_radius_mm", "max_internal_radius_mm",
                                 "tray_x_mm", "tray_y_mm", "tray_z_mm", "nozzle_mm", "default_material_id",
                                 "build_direction", "printable_length", "drain_holes", "neck_diameter_mm"});
  draft.fields_["process"] = process;
  draft.fields_["build_direction"] = process == "resin" ? "hanging" : "up";
  return draft;
}

ProfileDraft ProfileDraft::material() {
  return {"material",
          {"id", "display_name", "tensile_modulus_mpa", "shear_modulus_mpa", "tensile_strength_mpa",
           "shear_strength_mpa", "slenderness", "density_g_cm3", "price_per_kg"}};
}

void ProfileDraft::name(const std::string& display_name) {
  fields_["id"] = id_from_name(display_name);
  fields_["display_name"] = display_name;
}

void ProfileDraft::set(const std::string& field, double value, const std::string& source) {
  fields_[field] = value;
  fields_["sources"][field] = source;
}

std::string ProfileDraft::text() const {
  const nlohmann::ordered_json file = {{kind_, fields_}};
  return file.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

std::vector<std::string> ProfileDraft::unknown() const {
  std::vector<std::string> names;
  for (const auto& [name, value] : fields_.items())
    if (value.is_null()) names.push_back(name);
  return names;
}

std::string id_from_name(const std::string& name) {
  constexpr std::size_t kLongest = 64;
  std::string id;
  for (const char c : name) {
    const bool upper = c >= 'A' && c <= 'Z';
    if ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || upper)
      id += upper ? static_cast<char>(c - 'A' + 'a') : c;
    else if (!id.empty() && id.back() != '-')
      id += '-';
  }
  id.resize(std::min(id.size(), kLongest));
  while (!id.empty() && id.back() == '-') id.pop_back();
  return id.empty() ? "profile" : id;
}

}  // namespace skinframe
