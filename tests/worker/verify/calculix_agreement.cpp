// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/worker/verify/calculix_agreement.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

#include "tests/bench/frames/body_frame.h"
#include "tests/worker/verify/ask_calculix.h"
#include "worker/structure/solve_structure.h"
#include "worker/verify/shell_models.h"

namespace skinframe::test {
namespace {

using Eigen::Vector3d;

constexpr double kRadiusMm = 1.0, kAgreeFrame = 0.002, kAgreeSkin = 0.02;
constexpr double kThinRadiusMm = 0.5;  // the printer's least
constexpr double kAgreeIsotropic = 0.005;
constexpr int kDivisions = 3;       // by four, of CalculiX's shells; ours once more
constexpr double kFootShare = 0.2;  // of the body's height

using Edge = std::pair<int, int>;

Edge edge_of(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

struct Prepared {
  bench::PreparedBody prepared;
  SampledFrame sampled;
};

const Prepared& prepared(const CalculixBody& body) {
  static std::map<std::string, Prepared> known;  // each takes most of the test's time
  const auto it = known.find(body.name);
  if (it != known.end()) return it->second;
  auto prepared = body.mesh.empty() ? bench::prepare_sample(body.name) : bench::prepare_mesh_file(body.mesh);
  SKINFRAME_CHECK(prepared.ok());
  auto sampled = bench::sample_body(*prepared, bench::BodySize{{80, 320}, 0.8});
  SKINFRAME_CHECK(sampled.ok());
  return known.emplace(body.name, Prepared{std::move(prepared).value(), std::move(sampled).value()})
      .first->second;
}

// Sideways and down at its highest node.
NodalColumns pushes(const Structure& s) {
  const auto top = std::max_element(s.nodes_mm.begin(), s.nodes_mm.end(),
                                    [](const Vector3d& p, const Vector3d& q) { return p.z() < q.z(); });
  NodalColumns loads = NodalColumns::Zero(6 * static_cast<Eigen::Index>(s.nodes_mm.size()), 2);
  loads.block<3, 1>(6 * (top - s.nodes_mm.begin()), 0) = Vector3d(20, 0, 0);
  loads.block<3, 1>(6 * (top - s.nodes_mm.begin()), 1) = Vector3d(0, 0, -5);
  return loads;
}

// All of the foot is held, not the few nodes that the paper's model stands on.
void hold_foot(const HeldFreedoms& held, Structure* s) {
  const auto [low, high] =
      std::minmax_element(s->nodes_mm.begin(), s->nodes_mm.end(),
                          [](const Vector3d& p, const Vector3d& q) { return p.z() < q.z(); });
  const double top = low->z() + kFootShare * (high->z() - low->z());
  s->held.assign(s->nodes_mm.size(), kFree);
  for (std::size_t i = 0; i < s->nodes_mm.size(); ++i)
    if (s->nodes_mm[i].z() <= top) s->held[i] = held;
}

Structure frame_of(const Prepared& body, double radius_mm) {
  Structure s;
  s.material = {1586, 0.35};
  s.nodes_mm = body.sampled.frame.nodes_mm;
  hold_foot(kClamped, &s);
  for (const Strut& strut : body.sampled.frame.struts) {
    StructureStrut part;
    part.nodes = {strut.a, strut.b};
    part.radius_mm = radius_mm;
    s.struts.push_back(part);
  }
  return s;
}

Structure skin_frame_of(const Prepared& body) {
  const auto posed = bench::pose_body(body.prepared, body.sampled, false);
  SKINFRAME_CHECK(posed.ok());
  const FineSkin undivided = refine_skin(posed->frame, body.prepared.skin, 0);
  Structure s = skin_frame_structure(*posed, std::vector<double>(posed->frame.struts.size(), kRadiusMm),
                                     body.prepared.skin, undivided);
  s.material.poisson_ratio = 0;
  for (StructureStrut& strut : s.struts) {
    strut.shape = StrutShape::kFullDisc;
    strut.arm = {Vector3d::Zero(), Vector3d::Zero()};
  }
  hold_foot({true, true, true, false, false, false}, &s);
  return s;
}

// Each shell in four, in its plane, and struts along a side of one in two.
Structure divided(const Structure& s) {
  Structure out = s;
  out.shells.clear();
  out.struts.clear();
  std::map<Edge, int> middles;
  const auto middle = [&](int a, int b) {
    const auto [it, fresh] = middles.try_emplace(edge_of(a, b), static_cast<int>(out.nodes_mm.size()));
    if (!fresh) return it->second;
    out.nodes_mm.push_back((s.nodes_mm[a] + s.nodes_mm[b]) / 2);
    HeldFreedoms both;
    for (int k = 0; k < 6; ++k) both[k] = s.held[a][k] && s.held[b][k];
    out.held.push_back(both);
    return it->second;
  };
  for (const StructureShell& shell : s.shells) {
    const auto& [a, b, c] = shell.nodes;
    const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    for (const auto& nodes : {std::array{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}})
      out.shells.push_back({nodes, shell.thickness_mm});
  }
  for (StructureStrut part : s.struts) {
    const auto [a, b] = part.nodes;
    const auto side = middles.find(edge_of(a, b));
    if (side == middles.end()) {
      out.struts.push_back(part);
      continue;
    }
    part.nodes = {a, side->second};
    out.struts.push_back(part);
    part.nodes = {side->second, b};
    out.struts.push_back(part);
  }
  return out;
}

Structure divided(Structure s, int times) {
  for (int i = 0; i < times; ++i) s = divided(s);
  return s;
}

// Nodes that a division added are not loaded.
NodalColumns loads_on(const Structure& s, const NodalColumns& loads) {
  NodalColumns out = NodalColumns::Zero(6 * static_cast<Eigen::Index>(s.nodes_mm.size()), loads.cols());
  out.topRows(loads.rows()) = loads;
  return out;
}

NodalColumns solve(const Structure& s, const NodalColumns& loads) {
  RunContext context;
  const auto solver = StructureSolver::factorise(s, context);
  SKINFRAME_CHECK(solver.ok());
  return solver->solve(loads);
}

// Of the nodes that both have, the first ones: displacements; and the work of the loads.
void expect_agreement(const NodalColumns& loads, const NodalColumns& ours, const Eigen::MatrixXd& theirs,
                      double tolerance) {
  ASSERT_EQ(theirs.cols(), loads.cols());  // ccx has an answer
  for (Eigen::Index c = 0; c < loads.cols(); ++c) {
    double off = 0, size = 0, work_ours = 0, work_theirs = 0;
    for (Eigen::Index i = 0; i < loads.rows() / 6; ++i) {
      const Vector3d o = ours.col(c).segment<3>(6 * i), t = theirs.col(c).segment<3>(3 * i),
                     f = loads.col(c).segment<3>(6 * i);
      off += (o - t).squaredNorm();
      size += t.squaredNorm();
      work_ours += f.dot(o);
      work_theirs += f.dot(t);
    }
    testing::Test::RecordProperty(fmt::format("field_{}", c), std::to_string(std::sqrt(off / size)));
    testing::Test::RecordProperty(fmt::format("work_{}", c), std::to_string(work_ours / work_theirs));
    EXPECT_LT(std::sqrt(off / size), tolerance);
    EXPECT_NEAR(work_ours / work_theirs, 1, tolerance);
  }
}

}  // namespace

TEST_P(CalculixAgreement, OfTheFrameAloneIsWithinTwoThousandths) {
  const Structure s = frame_of(prepared(GetParam()), kRadiusMm);
  const NodalColumns loads = pushes(s);
  expect_agreement(loads, solve(s, loads), ask_calculix(s, loads), kAgreeFrame);
}

TEST_P(CalculixAgreement, OfTheFrameAloneWithAnIsotropicMaterialIsWithinFiveThousandths) {
  const Structure s = frame_of(prepared(GetParam()), kThinRadiusMm);
  const NodalColumns loads = pushes(s);
  expect_agreement(loads, solve(s, loads), ask_calculix(s, loads, Contraction::kIsotropic), kAgreeIsotropic);
}

TEST_P(CalculixAgreement, OfFrameAndSkinIsWithinTwoHundredths) {
  const Structure s = skin_frame_of(prepared(GetParam()));
  const NodalColumns loads = pushes(s);
  const Structure theirs = divided(s, kDivisions), ours = divided(theirs);
  expect_agreement(loads, solve(ours, loads_on(ours, loads)), ask_calculix(theirs, loads_on(theirs, loads)),
                   kAgreeSkin);
}

}  // namespace skinframe::test
