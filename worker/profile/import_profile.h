// SPDX-License-Identifier: GPL-3.0-or-later
// Other programs' files as drafts of profiles. All input is hostile: sizes are bounded, inheritance that runs
// in a circle is an error, and a name in a file never leads out of the file's folder.
#pragma once

#include <filesystem>
#include <string>

#include "worker/profile/draft.h"
#include "worker/run/result.h"

namespace skinframe {

// A printer, by the file's name: *.def.json is Cura's, anything else PrusaSlicer's .ini.
// preset: of a PrusaSlicer bundle with several printers, the one. Errors name file, line and field; of a
// bundle without preset the printers it has.
Result<ProfileDraft> import_printer(const std::filesystem::path& file, const std::string& preset);

// PrusaSlicer: a config bundle ([printer:NAME] sections, `inherits = A; B`, the right one stronger) or one
// exported preset (bare lines; a parent is NAME.ini beside it). Reads bed_shape (its box), max_print_height,
// nozzle_diameter, printer_technology.
Result<ProfileDraft> import_prusa_slicer(const std::filesystem::path& file, const std::string& preset);

// Cura: NAME.def.json; "inherits": "OTHER" is OTHER.def.json beside it. Reads machine_width, machine_depth,
// machine_height, machine_nozzle_size where they are numbers; formulas are not evaluated.
Result<ProfileDraft> import_cura(const std::filesystem::path& file);

// Spoolman: a filament as its API gives it, or a list of them (preset: id or name of the one). Reads name,
// vendor, density; price per kg = price of the spool / net weight of the spool.
Result<ProfileDraft> import_spoolman(const std::filesystem::path& file, const std::string& preset);

// At most that many bytes of a regular file. kIo: it cannot be read; kInvalidInput: it is larger.
Result<std::string> read_text_file(const std::filesystem::path& file, std::size_t most_bytes);
// The same as JSON. kInvalidInput also: FILE:LINE, not JSON.
Result<nlohmann::json> read_json_file(const std::filesystem::path& file, std::size_t most_bytes);

}  // namespace skinframe
