// SPDX-License-Identifier: Apache-2.0
// What a printer's G-code lays down, layer by layer, and the parts of it that start in the air.
#pragma once

#include <istream>
#include <vector>

namespace skinframe::integration {

struct Stroke {  // extruded on the way, mm
  double from_x, from_y, to_x, to_y;
};

struct PrintedLayer {
  double z_mm = 0;
  std::vector<Stroke> strokes;
};

// From below upwards. Understands G0, G1, G92, absolute and relative extrusion (M82, M83): what PrusaSlicer
// writes. A move that feeds filament without going anywhere is no stroke.
std::vector<PrintedLayer> read_layers(std::istream& gcode);

struct FloatingPart {
  double x_mm = 0, y_mm = 0, z_mm = 0, area_mm2 = 0;
};

struct LayerRule {
  double width_mm = 0.45;  // of a stroke
  double reach_mm = 0.2;   // sideways from what the layer below holds: layer height x tan(angle)
  double least_mm2 = 0.5;  // smaller parts are no strut: pi (0.4 mm)^2
  double pitch_mm = 0.15;  // of the lattice that strokes are drawn on
};

// Connected parts of a layer, above the first, no place of which is within reach of the layer below.
std::vector<FloatingPart> parts_in_the_air(const std::vector<PrintedLayer>& layers, const LayerRule& rule);

}  // namespace skinframe::integration
