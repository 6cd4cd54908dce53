// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/bench/frames/body_frame.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "tests/fixture/temporary_folder.h"
#include "worker/mesh/write_stl.h"
#include "worker/pipeline/pose_problem.h"
#include "worker/sample/make_sample.h"

namespace skinframe::bench {
namespace {

constexpr double kSizeMm = 200;
constexpr int kMostNeighbours = 64;
constexpr double kStrutsOfNeighbours =
    0.72;  // internal struts a neighbour tried: many are tried from both ends
constexpr int kMostAttempts = 3;
constexpr double kNearEnough = 0.02;  // of the struts wanted

PrinterRequest powder_printer() {
  PrinterRequest request;
  request.printer.id = "sinterstation-hiq";
  request.printer.process = PrintProcess::kPowder;
  request.printer.min_radius_mm = 0.5;
  request.printer.tray_mm = {457, 380, 330};
  request.material = {"pa", 1586, 1387, 43, 48, 60, 1.15};
  return request;
}

Result<SampledFrame> sample_with(const PreparedBody& body, const FrameOptions& options) {
  RunContext context;
  return sample_frame(body.skin, options, context);
}

}  // namespace

Result<PreparedBody> prepare_mesh_file(const std::filesystem::path& path) {
  RunContext context;
  JobRequest request;
  request.mesh_path = path;
  request.mesh_name = path.filename();
  request.options.size_mm = kSizeMm;
  auto prepared = prepare_solid(request, context);
  if (!prepared) return prepared.error();
  SkinOptions options;
  options.thickness_mm = powder_printer().printer.skin_thickness_mm();
  auto skin = build_skin(prepared->solid, options, context);
  if (!skin) return skin.error();
  return PreparedBody{std::move(prepared).value(), std::move(skin).value()};
}

Result<PreparedBody> prepare_sample(const std::string& name) {
  RunContext context;
  auto mesh = make_sample(name, context);
  if (!mesh) return mesh.error();
  const test::TemporaryFolder folder;
  const auto path = folder.path() / (name + ".stl");
  const Status written = write_stl(*mesh, path);
  return written ? prepare_mesh_file(path) : Result<PreparedBody>(written.error());
}

Result<SampledFrame> sample_body(const PreparedBody& body, const std::optional<BodySize>& size) {
  FrameOptions options;
  options.strut_radius_mm = powder_printer().printer.min_radius_mm;
  options.plate.tensile_modulus_mpa = powder_printer().material.tensile_modulus_mpa;
  if (!size) return sample_with(body, options);

  options.skin_nodes = static_cast<int>(std::lround(size->skin_share * size->size.nodes));
  options.internal_nodes = size->size.nodes - *options.skin_nodes;
  const double skin_struts = 3.0 * *options.skin_nodes - 6;
  const double wanted = size->size.struts - skin_struts;  // of internal ones
  double neighbours = wanted / (kStrutsOfNeighbours * *options.internal_nodes);
  std::optional<SampledFrame> best;
  double nearest = 0;
  for (int attempt = 0; attempt < kMostAttempts; ++attempt) {
    options.neighbours = std::clamp(static_cast<int>(std::lround(neighbours)), 1, kMostNeighbours);
    auto sampled = sample_with(body, options);
    if (!sampled) return sampled;
    const double made = std::max(1.0, static_cast<double>(sampled->frame.struts.size()) - skin_struts);
    const double off = std::abs(made - wanted) / size->size.struts;
    if (!best || off < nearest) {
      nearest = off;
      best = std::move(sampled).value();
    }
    if (nearest <= kNearEnough) break;
    neighbours = options.neighbours * wanted / made;  // struts are about in proportion
  }
  return std::move(*best);
}

Result<FrameProblem> pose_body(const PreparedBody& body, const SampledFrame& sampled, bool balance) {
  JobOptions options;
  options.balance = balance ? BalanceMode::kAuto : BalanceMode::kOff;
  auto posed = pose_problem(body.prepared.solid, body.prepared.contact, body.skin, sampled, powder_printer(),
                            {}, options);
  if (!posed) return posed.error();
  return std::move(posed.value().problem);
}

}  // namespace skinframe::bench
