// SPDX-License-Identifier: Apache-2.0
// skinframe: the client's command line.
#include <cstdio>
#include <exception>

#include "client/cli/command_line.h"
#include "client/cli/exit_code.h"

int main(int argc, char** argv) {
  try {
    return skinframe::client::skinframe_main(argc, argv);
  } catch (const std::exception& error) {  // out of memory, or a defect of ours
    std::fprintf(stderr, "skinframe: internal error: %s\n", error.what());
    return skinframe::client::kExitFailed;
  }
}
