// SPDX-License-Identifier: Apache-2.0
#include "server/catalog/catalog.h"

#include <algorithm>

namespace skinframe::server {
namespace {

constexpr char kSource[] = "Wang et al. 2013, ACM Trans. Graph. 32(6), Table 1";

template <class Profiles>
void sort_by_id(Profiles& profiles) {
  std::sort(profiles.begin(), profiles.end(), [](const auto& a, const auto& b) { return a.id() < b.id(); });
}

template <class Profiles>
auto find_by_id(const Profiles& profiles, std::string_view id) {
  const auto at = std::find_if(profiles.begin(), profiles.end(), [&](const auto& p) { return p.id() == id; });
  return at == profiles.end() ? nullptr : &*at;
}

template <class Profiles>
std::string joined_ids(const Profiles& profiles) {
  std::string ids;
  for (const auto& profile : profiles) {
    if (!ids.empty()) ids += ", ";
    ids += profile.id();
  }
  return ids;
}

v1::PrinterProfile sinterstation_hiq() {
  v1::PrinterProfile printer;
  printer.set_id("sinterstation-hiq");
  printer.set_display_name("Sinterstation HiQ SLS");
  printer.set_process(v1::PRINT_PROCESS_POWDER);
  printer.set_min_radius_mm(0.5);
  printer.set_tray_x_mm(457);
  printer.set_tray_y_mm(380);
  printer.set_tray_z_mm(330);
  printer.set_default_material_id("pa");
  printer.set_max_internal_radius_mm(5);
  printer.set_source(kSource);
  return printer;
}

v1::PrinterProfile makerbot_replicator_2() {
  v1::PrinterProfile printer;
  printer.set_id("makerbot-replicator-2");
  printer.set_display_name("MakerBot Replicator 2");
  printer.set_process(v1::PRINT_PROCESS_EXTRUSION);
  printer.set_min_radius_mm(0.4);
  printer.set_tray_x_mm(225);
  printer.set_tray_y_mm(145);
  printer.set_tray_z_mm(150);
  printer.set_default_material_id("pla");
  printer.set_max_internal_radius_mm(5);
  printer.set_source(kSource);
  return printer;
}

v1::MaterialProfile pa() {
  v1::MaterialProfile material;
  material.set_id("pa");
  material.set_display_name("PA plastic");
  material.set_tensile_modulus_mpa(1586);
  material.set_shear_modulus_mpa(1387);
  material.set_tensile_strength_mpa(43);
  material.set_shear_strength_mpa(48);
  material.set_slenderness(60);
  material.set_density_g_cm3(1.15);
  material.set_source(kSource);
  return material;
}

v1::MaterialProfile pla() {
  v1::MaterialProfile material;
  material.set_id("pla");
  material.set_display_name("PLA");
  material.set_tensile_modulus_mpa(2673);
  material.set_shear_modulus_mpa(1533);
  material.set_tensile_strength_mpa(92);
  material.set_shear_strength_mpa(52);
  material.set_slenderness(60);
  material.set_density_g_cm3(1.24);
  material.set_source(kSource);
  return material;
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

Catalog built_in_catalog() { return Catalog({sinterstation_hiq(), makerbot_replicator_2()}, {pa(), pla()}); }

}  // namespace skinframe::server
