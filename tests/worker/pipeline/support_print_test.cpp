// SPDX-License-Identifier: GPL-3.0-or-later
// Supports of whole bodies: no layer starts in the air, and hardly any skin hangs too far from what holds it.
// The frame is the sampled one, skin struts alone: what self weight leaves of it, and the hardest case for
// supports.
#include "worker/pipeline/support_print.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "tests/worker/pipeline/small_job.h"
#include "worker/frame/sample_frame.h"
#include "worker/pipeline/pose_problem.h"
#include "worker/pipeline/prepare_solid.h"
#include "worker/pipeline/sample_by_stress.h"
#include "worker/support/layers.h"

namespace skinframe {
namespace {

constexpr double kMaxStrutMm = 100;

class SupportedBodies : public testing::TestWithParam<const char*> {};

TEST_P(SupportedBodies, PrintWithoutIslandsAndWithHardlyAnyFreeOverhang) {
  test::TemporaryFolder folder;
  JobRequest job = test::sample_job(GetParam(), 60, 80, folder.path());
  job.printers = {test::makerbot_pla()};
  const PrinterProfile& printer = job.printers.front().printer;
  RunContext context;
  const auto prepared = prepare_solid(job, context);
  ASSERT_TRUE(prepared.ok()) << prepared.error().message;
  const auto skin =
      build_skin(prepared->solid, SkinOptions{.thickness_mm = printer.skin_thickness_mm()}, context);
  ASSERT_TRUE(skin.ok()) << skin.error().message;
  job.options.internal_nodes = 0;
  const auto sampled = sample_frame(*skin, frame_options(job.printers.front(), job), context);
  ASSERT_TRUE(sampled.ok()) << sampled.error().message;
  FrameProblem problem;
  problem.material = job.printers.front().material;
  problem.frame = sampled->frame;
  problem.fixed = hold_contact(problem.frame, sampled->contact_nodes, Supports::kPinned);
  problem.displacement_limit_mm = 0.05;
  const std::vector<double> radii_mm(problem.frame.struts.size(), printer.min_radius_mm);

  const auto supports = plan_print(problem, radii_mm, prepared->solid.mesh(), *skin, printer, context);
  ASSERT_TRUE(supports.ok() && supports->has_value());
  const PlannedSupports& planned = **supports;
  EXPECT_TRUE(planned.state.holds());
  // No support had to grow for that: least radii are SizeOpt's own answer.
  double thinnest_mm = kMaxStrutMm;
  for (const SupportStrut& strut : planned.plan.struts) thinnest_mm = std::min(thinnest_mm, strut.radius_mm);
  if (!planned.plan.struts.empty()) {
    EXPECT_EQ(thinnest_mm, printer.min_radius_mm);
  }
  EXPECT_LE(planned.overhang.roof_beyond_mm2 + planned.overhang.underside_beyond_mm2,
            0.02 * planned.cavity_surface_mm2);
  // On a coarser lattice the thinnest struts would fall between its cells.
  const Layers layers = find_islands(body_of(*skin), skin->body_box_mm, problem.frame, radii_mm, planned.plan,
                                     *printer.printable_length, LayerOptions{0.4, 0.4});
  EXPECT_GT(layers.count, 10);
  // A spot smaller than the thinnest strut is of the lattice, and nothing that the printer makes.
  const double least_mm2 = std::numbers::pi * printer.min_radius_mm * printer.min_radius_mm;
  for (const Island& island : layers.islands)
    if (island.area_mm2 > least_mm2)
      ADD_FAILURE() << island.area_mm2 << " mm2 start in the air at " << island.at_mm.transpose();
}

INSTANTIATE_TEST_SUITE_P(Samples, SupportedBodies,
                         testing::Values("hanging-ball", "ring", "egg", "relief", "bracket", "stool"),
                         [](const auto& body) {
                           std::string name = body.param;
                           for (char& c : name)
                             if (c == '-') c = '_';
                           return name;
                         });

}  // namespace
}  // namespace skinframe
