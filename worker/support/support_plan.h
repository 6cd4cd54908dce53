// SPDX-License-Identifier: GPL-3.0-or-later
// What Algorithm 2 adds to a frame. Units: mm.
//
// Node indices: those of the frame first, then `nodes`. The frame itself stays as it is; its struts are
// thought to be divided at the nodes that stand on them, radius kept.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace skinframe {

enum class SupportKind {
  kInternal,  // stays: part of the printed mesh, within M
  kExternal,  // outside of M, broken off by hand
};
inline const char* to_string(SupportKind kind) {
  return kind == SupportKind::kInternal ? "internal" : "external";
}

struct SupportNode {
  enum class On {
    kStrut,    // divides a strut of the frame
    kRoof,     // holds the skin from below
    kSupport,  // divides a support strut: another one ends here, or it was too long
    kSkin,     // foot on the skin
    kPlate,    // foot on the base plane
  };
  Eigen::Vector3d at_mm = Eigen::Vector3d::Zero();
  On on = On::kStrut;
  int strut = -1;  // of the frame, for kStrut
};
inline const char* to_string(SupportNode::On on) {
  switch (on) {
    case SupportNode::On::kStrut:
      return "strut";
    case SupportNode::On::kRoof:
      return "roof";
    case SupportNode::On::kSupport:
      return "support";
    case SupportNode::On::kSkin:
      return "skin";
    case SupportNode::On::kPlate:
      return "plate";
  }
  return "";
}

struct SupportStrut {
  int upper = 0, lower = 0;
  SupportKind kind = SupportKind::kInternal;
  double radius_mm = 0;
};

struct SupportPlan {
  std::vector<SupportNode> nodes;
  std::vector<SupportStrut> struts;
  int held_by_wall = 0;   // inserted nodes that the skin below holds
  int held_by_plate = 0;  // and that the base plane does
};

}  // namespace skinframe
