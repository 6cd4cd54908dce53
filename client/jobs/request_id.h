// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace skinframe::client {

// 32 random hexadecimal digits: the same submission sent twice makes one job.
std::string new_request_id();

}  // namespace skinframe::client
