// SPDX-License-Identifier: GPL-3.0-or-later
// A tripod loaded at its tip, as a problem file.
#pragma once

#include <nlohmann/json.hpp>

namespace skinframe::testing {

inline nlohmann::json sample_problem() {
  return nlohmann::json::parse(R"({
    "mechanics": "axial",
    "material": {"tensile_modulus_mpa": 1586, "shear_modulus_mpa": 1387, "tensile_strength_mpa": 43,
                 "shear_strength_mpa": null, "slenderness": 60, "density_g_cm3": 1.15},
    "nodes": [[0,0,0], [60,0,0], [0,60,0], [20,20,50]],
    "struts": [{"a":0,"b":1,"skin":true,"min_radius_mm":0.5,"max_radius_mm":1},
               {"a":1,"b":2,"skin":true,"min_radius_mm":0.5,"max_radius_mm":1},
               {"a":0,"b":3,"min_radius_mm":0.5,"max_radius_mm":5},
               {"a":1,"b":3,"skin":false,"min_radius_mm":0.5,"max_radius_mm":5},
               {"a":2,"b":3,"skin":false,"min_radius_mm":0.5,"max_radius_mm":5},
               {"a":2,"b":0,"skin":true,"min_radius_mm":0.5,"max_radius_mm":1}],
    "fixed": [{"node":0,"axes":"xyz"}, {"node":1,"axes":"xz"}, {"node":1,"axes":"z"}, {"node":2,"axes":"xyz"}],
    "load_cases": [{"name":"down","gravity":false,"forces":[{"node":3,"force_n":[0,0,-20]}]}],
    "displacement_limit_mm": 0.05,
    "stages": ["size", "relaxed", "topology"]
  })");
}

}  // namespace skinframe::testing
