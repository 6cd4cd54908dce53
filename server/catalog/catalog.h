// SPDX-License-Identifier: Apache-2.0
// The printers and materials that the server knows. Immutable once made: profiles from the operator's files
// will be further entries of the same vectors.
#pragma once

#include <string>
#include <string_view>
#include <vector>

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

// The two printers and two materials of Wang et al. 2013, Table 1.
Catalog built_in_catalog();

}  // namespace skinframe::server
