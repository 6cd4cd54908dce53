// SPDX-License-Identifier: GPL-3.0-or-later
// The parts of report.json that tell of geometry: how a body was oriented, sampled, smoothed, where it is
// thin, and the holes that drain it. Lengths in mm, volumes in mm3, as their names say.
#pragma once

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "worker/report/report.h"

namespace skinframe {

nlohmann::json vector_json(const Eigen::Vector3d& v);
nlohmann::json orientation_json(const OrientationFacts& facts);
nlohmann::json sampling_json(const SamplingFacts& facts);
nlohmann::json smoothing_json(const SmoothingFacts& smoothing);
nlohmann::json thin_json(const ThinParts& thin);
// thickness_mm: of the caps.
nlohmann::json drain_json(const DrainFacts& drain, double thickness_mm);

}  // namespace skinframe
