// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/problem/result_summary.h"

#include "worker/problem/strut_sizes.h"

namespace skinframe {

nlohmann::json result_summary(const nlohmann::json& result) {
  nlohmann::json summary = result;
  for (const char* one_each : {"nodes", "struts", "fixed", "load_cases", "free_nodes", "skin_weight_n",
                               "skin_mass", "balance_half_planes", "skin_triangles", "node_origin",
                               "strut_origin", "lower_bound_proof", "relaxed_lower_bound_proof", "given", kStrutSizes})
    summary.erase(one_each);
  if (const auto certificate = summary.find("certificate"); certificate != summary.end())
    for (const char* one_each : {"fields", "balance_multipliers"})
      if (certificate->is_object()) certificate->erase(one_each);
  return summary;
}

}  // namespace skinframe
