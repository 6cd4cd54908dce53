// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/optimize/iteration_log.h"

#include <fmt/format.h>

#include <cmath>

namespace skinframe {

std::string iteration_log_header() {
  return fmt::format("{:>4} {:>15} {:>9} {:>9} {:>9} {:>7} {:>8} {:>8} {:>8} {:>9} {:>8}", "iter",
                     "objective", "primal", "dual", "compl", "lg(mu)", "lg(reg)", "step p", "step d",
                     "halvings", "factors");
}

std::string iteration_log_line(const IterationRecord& r) {
  return fmt::format(
      "{:>4} {:>15.8e} {:>9.1e} {:>9.1e} {:>9.1e} {:>7.1f} {:>8} {:>8.4f} {:>8.4f} {:>9} {:>8}", r.iteration,
      r.objective, r.error.primal, r.error.dual, r.error.complementarity, std::log10(r.barrier),
      r.regularisation > 0 ? fmt::format("{:.1f}", std::log10(r.regularisation)) : "-", r.primal_length,
      r.dual_length, r.halvings, r.factorisations);
}

}  // namespace skinframe
