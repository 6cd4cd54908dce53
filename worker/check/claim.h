// SPDX-License-Identifier: GPL-3.0-or-later
// One claim that a result makes, and what the check measured of it. A check that cannot say no proves
// nothing: every claim has a limit, and tests/worker/check spoils a result for each of them.
#pragma once

#include <string>
#include <vector>

namespace skinframe::check {

struct Claim {
  std::string name;  // for example "watertight"
  bool holds = false;
  std::string measured;  // what was found, with units, and the limit
};

// Everything said about one printer's folder. Notes are measured, but nobody claims anything about them.
struct Verdict {
  std::string printer;
  std::vector<Claim> claims;
  std::vector<std::string> notes;
  bool holds() const {
    for (const Claim& claim : claims)
      if (!claim.holds) return false;
    return !claims.empty();
  }
};

}  // namespace skinframe::check
