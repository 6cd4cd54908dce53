// SPDX-License-Identifier: Apache-2.0
// By what two requests are told to be the same.
#pragma once

#include <string>

#include "server/jobs/job_record.h"
#include "skinframe/v1/job.pb.h"

namespace skinframe::server {

// SHA-256 of the spec's canonical bytes: maps in the order of their keys.
std::string digest_of(const v1::JobSpec& spec);

// The same for two jobs that must come to the same result: SHA-256 of the spec without name, labels, priority
// and deadline, of the profiles and the files to start from, and of this program's version.
std::string reuse_key_of(const JobRecord& record);

}  // namespace skinframe::server
