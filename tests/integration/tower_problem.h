// SPDX-License-Identifier: Apache-2.0
// A frame problem of any size.
#pragma once

#include <nlohmann/json.hpp>

namespace skinframe::integration {

// A tower of cells of 12 mm, clamped at its foot and pushed at its top: n = nx ny nz nodes, some 8 n struts.
inline nlohmann::json tower(int nx, int ny, int nz, double force_n) {
  using nlohmann::json;
  json nodes = json::array(), struts = json::array(), fixed = json::array(), forces = json::array();
  const auto index = [&](int i, int j, int k) { return i + nx * (j + ny * k); };
  constexpr int kSteps[][3] = {{1, 0, 0}, {0, 1, 0},  {0, 0, 1},  {1, 1, 0}, {1, 0, 1},
                               {0, 1, 1}, {1, -1, 0}, {1, 0, -1}, {0, 1, -1}};
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) {
        nodes.push_back({12.0 * i, 12.0 * j, 12.0 * k});
        for (const auto& step : kSteps) {
          const int a = i + step[0], b = j + step[1], c = k + step[2];
          if (a >= nx || b < 0 || b >= ny || c < 0 || c >= nz) continue;
          struts.push_back(
              {{"a", index(i, j, k)}, {"b", index(a, b, c)}, {"min_radius_mm", 0.5}, {"max_radius_mm", 5}});
        }
        if (k == 0) fixed.push_back({{"node", index(i, j, k)}, {"axes", "xyz"}});
        if (k == nz - 1)
          forces.push_back({{"node", index(i, j, k)}, {"force_n", {force_n / (nx * ny), 0, 0}}});
      }
  return {{"mechanics", "paper"},
          {"material",
           {{"tensile_modulus_mpa", 1586},
            {"shear_modulus_mpa", 1387},
            {"tensile_strength_mpa", 43},
            {"shear_strength_mpa", nullptr},
            {"slenderness", 60},
            {"density_g_cm3", 1.15}}},
          {"nodes", nodes},
          {"struts", struts},
          {"fixed", fixed},
          {"load_cases", {{{"name", "side"}, {"forces", forces}}}},
          {"displacement_limit_mm", 0.05}};
}

}  // namespace skinframe::integration
