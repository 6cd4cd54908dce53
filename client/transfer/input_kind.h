// SPDX-License-Identifier: Apache-2.0
// What a file asks for, told by its content: a frame problem file is a JSON object, and no format of a mesh
// begins as one.
#pragma once

#include <filesystem>

namespace skinframe::client {

enum class InputKind { kMesh, kFrameProblem };

// kMesh for a file that cannot be read: what is wrong with it is told by digest_input_file.
InputKind input_kind(const std::filesystem::path& path);

}  // namespace skinframe::client
