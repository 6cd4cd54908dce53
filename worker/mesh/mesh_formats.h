// SPDX-License-Identifier: GPL-3.0-or-later
// One function a format; read_mesh() chooses. Each trusts nothing but the length of the bytes.
#pragma once

#include <optional>
#include <string_view>

#include "worker/mesh/polygon_soup.h"

namespace skinframe {

// What the header of a binary STL says, if the bytes are long enough to have one.
std::optional<std::uint32_t> announced_stl_triangles(std::string_view bytes);
// The count agrees with the length: binary STL beyond doubt, whatever the header's text is.
bool is_exact_binary_stl(std::string_view bytes);

Result<MeshFile> read_binary_stl(const ReadRequest& request);
Result<MeshFile> read_ascii_stl(const ReadRequest& request);
Result<MeshFile> read_obj(const ReadRequest& request);
Result<MeshFile> read_ply(const ReadRequest& request);
Result<MeshFile> read_off(const ReadRequest& request);
Result<MeshFile> read_3mf(const ReadRequest& request);

}  // namespace skinframe
