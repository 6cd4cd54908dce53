// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/job/run_frame_job.h"

#include "worker/pipeline/write_json.h"
#include "worker/problem/problem_file.h"
#include "worker/problem/result_file.h"
#include "worker/problem/result_summary.h"

namespace skinframe {
namespace {

using nlohmann::json;

// FrameResult in job.proto, same field names.
json frame_json(const OptimizeResult& result) {
  json stages = json::array();
  const std::pair<const char*, const StageRecord*> records[] = {{"initial", &result.initial},
                                                                {"size", &result.size},
                                                                {"topology", &result.topology},
                                                                {"geometry", &result.geometry}};
  for (const auto& [name, record] : records)
    stages.push_back({{"stage", name},
                      {"frame_volume_mm3", record->volume_mm3},
                      {"nodes", record->nodes},
                      {"struts", record->struts}});
  json out = {{"mechanics", to_string(result.problem.element)},
              {"stages", stages},
              {"max_displacement_mm", result.evaluation.max_displacement_mm},
              {"max_axial_ratio", result.evaluation.max_axial_ratio},
              {"max_shear_ratio", result.evaluation.max_shear_ratio},
              {"violated_constraint", result.violated_constraint},
              {"iterations", result.interior_point_iterations}};
  if (result.lower_bound_mm3) out["lower_bound_mm3"] = *result.lower_bound_mm3;
  if (result.best_reachable_displacement_mm)
    out["best_reachable_displacement_mm"] = *result.best_reachable_displacement_mm;
  return out;
}

}  // namespace

json failed_outcome(Reason reason, const std::string& detail) {
  return {{"state", reason == Reason::kCancelled ? "CANCELLED" : "FAILED"},
          {"reason", to_string(reason)},
          {"detail", detail},
          {"printers", json::array()}};
}

json run_frame_job(const JobFile& file, const std::filesystem::path& out_dir, EventStream& events,
                   Checkpoints* checkpoints, const RunContext& shared) {
  const auto failed = [](const Error& error) { return failed_outcome(reason_of(error.kind), error.message); };
  RunContext context = shared;
  context.report = [&](const Progress& progress) { events.progress({"", progress, {}, {}}); };

  context.report({.stage = Stage::kRead});
  const std::string& name = file.request.mesh_name;
  const auto problem = read_problem(*file.frame_problem, name.empty() ? "the problem file" : name);
  if (!problem) return failed(problem.error());
  context.report(
      {.stage = Stage::kSize, .struts_left = static_cast<int>(problem->problem.frame.struts.size())});
  OptimizeOptions options = problem->options;
  options.checkpoints = checkpoints;
  const auto optimised = optimize_frame(problem->problem, options, context);
  if (!optimised) return failed(optimised.error());

  const OptimizeResult& result = *optimised;
  const Reason reason = result.reason == Termination::kInfeasible ? Reason::kInfeasible : Reason::kNone;
  const std::string detail = reason == Reason::kNone ? "" : result.detail;
  const json document = result_json(result, problem->problem);
  json summary = result_summary(document);
  summary["problem"] = file.request.mesh_name;
  summary["file"] = "result.json";
  summary["reason"] = to_string(reason);
  summary["detail"] = detail;
  const json report = {
      {"job_id", file.request.job_id}, {"version", SKINFRAME_VERSION}, {"frame", std::move(summary)}};
  if (auto written = write_json(out_dir / "report.json", report); !written) return failed(written.error());
  if (auto written = write_result(document, out_dir / "result.json"); !written)
    return failed(written.error());
  return {{"state", reason == Reason::kNone ? "SUCCEEDED" : "FAILED"},
          {"reason", to_string(reason)},
          {"detail", detail},
          {"printers", json::array()},
          {"frame", frame_json(result)}};
}

}  // namespace skinframe
