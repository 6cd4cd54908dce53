// SPDX-License-Identifier: Apache-2.0
// Whether a job can be accepted as it is written. Messages name the field as the client wrote it, its value
// and the valid range, and list the known ids.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "absl/status/status.h"
#include "server/catalog/catalog.h"
#include "skinframe/v1/job.pb.h"

namespace skinframe::server {

// INVALID_ARGUMENT. Meshes and frame
// problems are not opened: what is wrong inside one is the worker's to say.
absl::Status validate_spec(const v1::JobSpec& spec, const Catalog& catalog);

// The artifact that the job works on, and what it is called: "mesh" or "frame problem". Of a valid spec.
const std::string& input_sha256(const v1::JobSpec& spec);
const char* input_word(const v1::JobSpec& spec);

// What SubmitJob has found good, a sentence each.
std::vector<std::string> checks_that_hold(const v1::JobSpec& spec);

// 1 .. 64 of [A-Za-z0-9._-], or empty.
absl::Status validate_request_id(std::string_view request_id);

}  // namespace skinframe::server
