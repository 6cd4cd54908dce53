// SPDX-License-Identifier: Apache-2.0
// The printers and materials that the server knows. Immutable once made; live_catalog.h exchanges one for
// another.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"
#include "skinframe/v1/catalog.pb.h"

namespace skinframe::server {

class Catalog {
 public:
  // Both are kept in the order of their ids. Ids must be unique, and each printer's default material present.
  Catalog(std::vector<v1::PrinterProfile> printers, std::vector<v1::MaterialProfile> materials);

  const std::vector<v1::PrinterProfile>& printers() const { return printers_; }
  const std::vector<v1::MaterialProfile>& materials() const { return materials_; }

  // Null when there is none of that id.
  const v1::PrinterProfile* find_printer(std::string_view id) const;
  const v1::MaterialProfile* find_material(std::string_view id) const;

  std::string printer_ids() const;   // "makerbot-replicator-2, sinterstation-hiq"
  std::string material_ids() const;  // "pa, pla"

 private:
  std::vector<v1::PrinterProfile> printers_;
  std::vector<v1::MaterialProfile> materials_;
};

// The fields that a job needs and that are absent, by name: "min_radius_mm, tray_z_mm"; empty when a job can
// run. An extrusion printer needs its printable_length.
std::string missing_for_a_job(const v1::PrinterProfile& printer);
std::string missing_for_a_job(const v1::MaterialProfile& material);

// The files of profiles/, which are part of the program.
Catalog built_in_catalog();

// The built-in profiles and those of the folder's *.json files; a file's profile takes the place of a
// built-in one of the same id. INVALID_ARGUMENT names file, line and field; also when two files give one id,
// or a printer's default material is nowhere. NOT_FOUND: no such folder.
absl::StatusOr<Catalog> load_catalog(const std::filesystem::path& folder);

}  // namespace skinframe::server
