// SPDX-License-Identifier: Apache-2.0
#include "server/catalog/catalog.h"

#include <fmt/format.h>

#include <algorithm>

namespace skinframe::server {
namespace {

template <class Profiles>
void sort_by_id(Profiles& profiles) {
  std::sort(profiles.begin(), profiles.end(), [](const auto& a, const auto& b) { return a.id() < b.id(); });
}

template <class Profiles>
auto find_by_id(const Profiles& profiles, std::string_view id) {
  const auto at = std::find_if(profiles.begin(), profiles.end(), [&](const auto& p) { return p.id() == id; });
  return at == profiles.end() ? nullptr : &*at;
}

std::string joined(const std::vector<std::string>& words) {
  return fmt::format("{}", fmt::join(words, ", "));
}

template <class Profiles>
std::string joined_ids(const Profiles& profiles) {
  std::vector<std::string> ids;
  for (const auto& profile : profiles) ids.push_back(profile.id());
  return joined(ids);
}

}  // namespace

Catalog::Catalog(std::vector<v1::PrinterProfile> printers, std::vector<v1::MaterialProfile> materials)
    : printers_(std::move(printers)), materials_(std::move(materials)) {
  sort_by_id(printers_);
  sort_by_id(materials_);
}

const v1::PrinterProfile* Catalog::find_printer(std::string_view id) const {
  return find_by_id(printers_, id);
}
const v1::MaterialProfile* Catalog::find_material(std::string_view id) const {
  return find_by_id(materials_, id);
}
std::string Catalog::printer_ids() const { return joined_ids(printers_); }
std::string Catalog::material_ids() const { return joined_ids(materials_); }

std::string missing_for_a_job(const v1::PrinterProfile& printer) {
  std::vector<std::string> missing;
  if (!printer.has_min_radius_mm()) missing.push_back("min_radius_mm");
  if (!printer.has_max_internal_radius_mm()) missing.push_back("max_internal_radius_mm");
  if (!printer.has_tray_x_mm()) missing.push_back("tray_x_mm");
  if (!printer.has_tray_y_mm()) missing.push_back("tray_y_mm");
  if (!printer.has_tray_z_mm()) missing.push_back("tray_z_mm");
  if (printer.process() == v1::PRINT_PROCESS_EXTRUSION && !printer.has_printable_length())
    missing.push_back("printable_length");
  return joined(missing);
}

std::string missing_for_a_job(const v1::MaterialProfile& material) {
  std::vector<std::string> missing;
  if (!material.has_tensile_modulus_mpa()) missing.push_back("tensile_modulus_mpa");
  if (!material.has_shear_modulus_mpa()) missing.push_back("shear_modulus_mpa");
  if (!material.has_density_g_cm3()) missing.push_back("density_g_cm3");
  return joined(missing);
}

}  // namespace skinframe::server
