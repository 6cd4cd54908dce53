// SPDX-License-Identifier: Apache-2.0
#include "client/jobs/request_id.h"

#include <fmt/format.h>

#include <random>

namespace skinframe::client {

std::string new_request_id() {
  std::random_device device;
  return fmt::format("{:08x}{:08x}{:08x}{:08x}", device(), device(), device(), device());
}

}  // namespace skinframe::client
