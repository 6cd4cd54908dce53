// SPDX-License-Identifier: Apache-2.0
// The words of the command line: which verb, with which arguments.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace skinframe::client {

// What the worker's program does on this machine, and the words it is to be called with.
struct LocalVerb {
  std::vector<std::string> words;  // the verb first; a --json from before it is appended
};
// Of the words after the program's name; nothing when the verb is none of them, or when its help is asked
// for.
std::optional<LocalVerb> local_verb(const std::vector<std::string>& words);

// The whole program; returns its exit code.
int skinframe_main(int argc, char** argv);

}  // namespace skinframe::client
