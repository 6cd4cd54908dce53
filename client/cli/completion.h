// SPDX-License-Identifier: Apache-2.0
// Shell completion, made from the command line's own tree so that it cannot fall behind it.
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace skinframe::client {

// A bash script that completes verbs, their options, and file names where neither fits.
std::string bash_completion(const CLI::App& app);

}  // namespace skinframe::client
