// SPDX-License-Identifier: Apache-2.0
// Printers and materials as people read them, and as profile files (server/catalog/README.md). What a profile
// does not know is "-" for people and null in JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "skinframe/v1/catalog.pb.h"

namespace skinframe::client {

std::string printer_list(const v1::ListPrintersResponse& printers);
std::string material_list(const v1::ListMaterialsResponse& materials);

// One profile whole: a field a line, each number with the number of its source, the sources below.
std::string profile_sheet(const v1::PrinterProfile& printer);
std::string profile_sheet(const v1::MaterialProfile& material);

// {"printer": {...}} and {"material": {...}}: a profile file.
nlohmann::ordered_json profile_file(const v1::PrinterProfile& printer);
nlohmann::ordered_json profile_file(const v1::MaterialProfile& material);

}  // namespace skinframe::client
