// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/verify/verify.h"

#include <time.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "worker/run/one_blas_thread.h"
#include "worker/skin/triangle_tree.h"
#include "worker/verify/assess.h"
#include "worker/verify/hollow.h"
#include "worker/verify/shell_models.h"
#include "worker/verify/solid_reference.h"

namespace skinframe {
namespace {

struct FineModel {
  FineSkin skin;
  std::vector<LoadCase> cases;
  std::unique_ptr<const Structure> structure;  // of the skin-frame
  std::optional<StructureSolver> solver;       // refers to it
};

Result<FineModel> model_at(const VerifyInput& in, int levels, const RunContext& context) {
  FineModel model;
  model.skin = refine_skin(in.problem.frame, in.skin, levels, contact_height_mm(in.problem));
  auto cases = in.place_loads(model.skin.frame);
  if (!cases) return cases.error();
  model.cases = std::move(cases).value();
  model.structure =
      std::make_unique<const Structure>(skin_frame_structure(in.problem, in.radii_mm, in.skin, model.skin));
  auto solver = StructureSolver::factorise(*model.structure, context);
  if (!solver) return solver.error();
  model.solver.emplace(std::move(solver).value());
  return model;
}

// CPU seconds of this thread since the last lap.
class CpuLaps {
 public:
  explicit CpuLaps(std::map<std::string, double>* seconds) : seconds_(seconds), last_(now()) {}
  void lap(const std::string& stage) {
    const double at = now();
    (*seconds_)[stage] += at - last_;
    last_ = at;
  }

 private:
  static double now() {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  }
  std::map<std::string, double>* seconds_;
  double last_;
};

double vertical_n(const Eigen::VectorXd& column) {
  double sum = 0;
  for (Eigen::Index i = 2; i < column.size(); i += 6) sum += std::abs(column[i]);
  return sum;
}

// Of each load if all it acts on moved by the displacement limit.
std::vector<double> works_at_limit(const FineModel& model, double limit_mm) {
  std::vector<double> works;
  for (const LoadCase& load_case : model.cases) {
    double size = 0;
    for (const Eigen::Vector3d& f : load_case.force_n) size += f.norm();
    if (!(size > 0)) size = vertical_n(load_column(*model.structure, load_case));
    works.push_back(size * limit_mm);
  }
  return works;
}

// The mesh that is fine enough, and how well.
Result<FineModel> refine(const VerifyInput& in, Verification* out, const RunContext& context) {
  std::vector<std::vector<double>> works;
  for (int level = 0;; ++level) {
    auto model = model_at(in, level, context);
    if (!model) return model.error();
    works.push_back(load_works(*model->solver, model->cases));
    out->levels = level;
    if (level == 0) continue;
    const bool last = fine_node_count(in.problem.frame, level + 1) > kMostFineNodes;
    out->mesh_error =
        mesh_error_of(works, works_at_limit(*model, in.problem.displacement_limit_mm.value_or(0)));
    if (last || out->mesh_error < kMeshTolerance) return model;
  }
}

void assess_hollow(const VerifyInput& in, const FineModel& model, const TriangleTree& body,
                   const std::vector<PinchSite>& pinches, Verification* out, const RunContext& context) {
  out->hollow_wall_mm = equal_volume_wall_mm(in.skin, in.solid_volume_mm3, in.printed_volume_mm3);
  const auto walls = local_walls_mm(model.skin, in.skin, body, out->hollow_wall_mm);
  const Structure structure = hollow_structure(in.problem, in.skin, model.skin, walls);
  auto assessed = assess(structure, model.skin, model.cases, pinches, context);
  if (!assessed) {
    out->hollow_missing = assessed.error().message;
    return;
  }
  out->hollow = std::move(assessed->figures);
}

}  // namespace

Result<Verification> verify(const VerifyInput& in, const RunContext& context) {
  use_one_blas_thread();
  Verification out;
  CpuLaps laps(&out.cpu_seconds);
  auto model = refine(in, &out, context);
  if (!model) return model.error();
  laps.lap("mesh");
  const TriangleTree body(in.body);
  const auto pinches = spread_pinches(model->skin, in.skin, body);
  laps.lap("pinch sites");
  auto ours = assess(*model->solver, model->skin, model->cases, pinches, context);
  if (!ours) return ours.error();
  const double density_g_mm3 = in.problem.material.density_g_cm3 * 1e-3;
  out.ours = ours->figures;
  out.ours.weight_g = in.printed_volume_mm3 * density_g_mm3;
  out.euler_factor = ours->euler_factor;
  out.euler_strut = ours->euler_strut;
  out.balance_force = ours->balance.force;
  out.balance_moment = ours->balance.moment;
  out.nodes = model->structure->nodes_mm.size();
  out.triangles = model->structure->shells.size();
  out.strength_mpa = in.problem.material.tensile_strength_mpa;
  if (out.strength_mpa && out.ours.max_stress_mpa() > 0)
    out.safety_factor = *out.strength_mpa / out.ours.max_stress_mpa();

  const std::size_t skin_nodes = model->skin.frame.nodes_mm.size();
  out.skin_mm.assign(model->structure->nodes_mm.begin(), model->structure->nodes_mm.begin() + skin_nodes);
  out.skin_triangles = model->skin.frame.skin_triangles;
  for (std::size_t c = 0; c < model->cases.size(); ++c) {
    Deformation deformation{model->cases[c].name, {}};
    for (std::size_t i = 0; i < skin_nodes; ++i)
      deformation.displacement_mm.push_back(
          ours->displacements.col(c).segment<3>(6 * static_cast<Eigen::Index>(i)));
    out.deformations.push_back(std::move(deformation));
  }

  model.value().solver.reset();  // its factor is as large as each of those to come
  laps.lap("skin-frame");
  auto alone = assess(skin_alone_structure(in.problem, in.skin, model->skin), model->skin, model->cases,
                      pinches, context);
  if (alone) out.skin_alone = std::move(alone->figures);
  laps.lap("skin alone");
  if (context.cancelled()) return cancelled_error();
  assess_hollow(in, *model, body, pinches, &out, context);
  laps.lap("hollow");
  if (out.hollow) out.hollow->weight_g = out.ours.weight_g;
  if (context.cancelled()) return cancelled_error();
  if (in.compare_solid) {
    auto solid = assess_solid(in, model->skin, pinches, context);
    if (solid)
      out.solid = std::move(solid).value();
    else
      out.solid_missing = solid.error().message;
    laps.lap("solid");
    if (context.cancelled()) return cancelled_error();
  }
  out.verdict = verdict_of(out);
  return out;
}

}  // namespace skinframe
