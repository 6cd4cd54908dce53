// SPDX-License-Identifier: Apache-2.0
// What a person reads of jobs on stdout.
#pragma once

#include <string>
#include <vector>

#include "skinframe/v1/job.pb.h"

namespace skinframe::client {

// The figures of the paper's Table 2, a row a printer; printers without statistics are told below it. Of a
// frame problem: a row a stage. Ends with a line end, or empty when there is neither.
std::string result_table(const v1::Job& job);

// Why the job ended as it did, for stderr: a line for the job and one for each printer with a reason of its
// own.
std::string end_report(const v1::Job& job);

std::string job_description(const v1::Job& job);         // `get`
std::string job_list(const std::vector<v1::Job>& jobs);  // `list`

}  // namespace skinframe::client
