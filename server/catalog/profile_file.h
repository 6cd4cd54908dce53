// SPDX-License-Identifier: Apache-2.0
// One profile file: a printer or a material, as README.md of this folder gives the format. Its fields are
// those of PrinterProfile and MaterialProfile in catalog.proto.
#pragma once

#include <string>
#include <string_view>
#include <variant>

#include "absl/status/statusor.h"
#include "skinframe/v1/catalog.pb.h"

namespace skinframe::server {

struct ProfileFile {
  std::string file;
  std::variant<v1::PrinterProfile, v1::MaterialProfile> profile;
  std::string default_material_place;  // "FILE:LINE" of a printer's default_material_id

  const std::string& id() const;
};

constexpr std::size_t kLargestProfileBytes = 256 * 1024;

// Guarantees of what comes back: the id is [a-z0-9-]{1,64}; every number is finite and within its range, and
// has a source; printable_length is a curve as catalog.proto describes it.
// INVALID_ARGUMENT "FILE:LINE: FIELD: what is wrong and what would be right".
absl::StatusOr<ProfileFile> parse_profile(std::string_view text, const std::string& file);

}  // namespace skinframe::server
