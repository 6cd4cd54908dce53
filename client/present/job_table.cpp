// SPDX-License-Identifier: Apache-2.0
#include "client/present/job_table.h"

#include <fmt/format.h>

#include <algorithm>

#include "client/present/event_line.h"
#include "client/present/table.h"
#include "client/present/words.h"

namespace skinframe::client {
namespace {

bool is_frame_problem(const v1::Job& job) { return job.spec().has_frame_problem_sha256(); }

std::string printer_names(const v1::Job& job) {
  if (is_frame_problem(job)) return "(frame problem)";
  std::string out;
  for (const auto& printer : job.spec().printers()) {
    if (!out.empty()) out += ',';
    out += one_line(printer.printer_id());
  }
  return out;
}

std::string state_and_reason(const v1::Job& job) {
  std::string out = state_word(job.state());
  if (job.reason() != v1::REASON_UNSPECIFIED && reason_word(job.reason()) != out)
    out += ", " + reason_word(job.reason());
  return out;
}

std::string frame_table(const v1::FrameResult& frame) {
  std::vector<Row> rows = {{"stage", "frame mm3", "nodes", "struts", "of size"}};
  double sized = 0;  // the stage before is at the lower bounds, where no limit need hold
  for (const v1::FrameStage& stage : frame.stages()) {
    if (stage.stage() == "size") sized = stage.frame_volume_mm3();
    rows.push_back({one_line(stage.stage()), fmt::format("{:.6g}", stage.frame_volume_mm3()),
                    fmt::format("{}", stage.nodes()), fmt::format("{}", stage.struts()),
                    or_dash(sized > 0, 100 * stage.frame_volume_mm3() / sized, "{:.1f} %")});
  }
  std::string out = table(rows, 1);
  out += fmt::format("displacement {}, axial ratio {:.4f}, shear ratio {:.4f} ({} model), {} iterations\n",
                     or_dash(frame.has_max_displacement_mm(), frame.max_displacement_mm(), "{:.6g} mm"),
                     frame.max_axial_ratio(), frame.max_shear_ratio(), one_line(frame.mechanics()),
                     frame.iterations());
  if (frame.has_lower_bound_mm3())
    out +=
        fmt::format("no frame of these nodes and struts has less than {:.6g} mm3\n", frame.lower_bound_mm3());
  if (frame.has_best_reachable_displacement_mm())
    out += fmt::format("best reachable displacement {:.6g} mm\n", frame.best_reachable_displacement_mm());
  return out;
}

// The figures of the valid model, beside those of the table above.
std::string verified_table(const v1::Job& job) {
  std::vector<Row> rows = {
      {"verified*", "displacement", "hollow", "solid", "pinch", "hollow", "safety", "buckling"}};
  std::string words;
  for (const v1::PrinterResult& printer : job.printers()) {
    if (!printer.has_statistics()) continue;
    if (!printer.statistics().has_verified()) {
      const std::string& why = printer.statistics().not_verified();
      words += fmt::format("{}: not verified{}\n", one_line(printer.printer_id()),
                           why.empty() ? "; the paper's model alone speaks for it" : ": " + one_line(why));
      continue;
    }
    const v1::VerifiedFigures& v = printer.statistics().verified();
    rows.push_back({one_line(printer.printer_id()), fmt::format("{:.4f} mm", v.max_displacement_mm()),
                    or_dash(v.has_hollow_max_displacement_mm(), v.hollow_max_displacement_mm(), "{:.4f} mm"),
                    or_dash(v.has_solid_max_displacement_mm(), v.solid_max_displacement_mm(), "{:.4f} mm"),
                    or_dash(v.has_pinch_max_mm(), v.pinch_max_mm(), "{:.4f} mm"),
                    or_dash(v.has_hollow_pinch_max_mm(), v.hollow_pinch_max_mm(), "{:.4f} mm"),
                    or_dash(v.has_safety_factor(), v.safety_factor(), "{:.3g}"),
                    or_dash(v.has_buckling_factor(), v.buckling_factor(), "{:.3g}")});
    words += fmt::format("{}: {}\n", one_line(printer.printer_id()), one_line(v.verdict()));
  }
  if (rows.size() == 1) return words;
  return table(rows, 1) + words +
         "* displacements by the valid model, shell and struts with rigid joints; hollow: of equal printed "
         "mass; pinch: 10 N, the worst "
         "site\n";
}

}  // namespace

std::string result_table(const v1::Job& job) {
  if (job.has_frame()) return frame_table(job.frame());
  std::vector<Row> rows = {{"printer", "material", "nodes/struts", "skin mm3", "frame mm3", "total mm3",
                            "solid mm3", "ratio", "printed mm3", "weight", "paper model*"}};
  for (const v1::PrinterResult& printer : job.printers()) {
    if (!printer.has_statistics()) continue;
    const v1::PrinterStatistics& s = printer.statistics();
    rows.push_back({one_line(printer.printer_id()), one_line(printer.material_id()),
                    fmt::format("{}/{}", s.nodes(), s.struts()), fmt::format("{:.0f}", s.skin_volume_mm3()),
                    fmt::format("{:.0f}", s.frame_volume_mm3()), fmt::format("{:.0f}", s.total_volume_mm3()),
                    fmt::format("{:.0f}", s.solid_volume_mm3()), fmt::format("{:.1f} %", 100 * s.ratio()),
                    fmt::format("{:.0f}", s.printed_volume_mm3()), fmt::format("{:.1f} g", s.weight_g()),
                    or_dash(s.struts() > 0, s.max_displacement_mm(), "{:.4f} mm")});
  }
  if (rows.size() == 1) return {};
  const std::string verified = verified_table(job);
  return table(rows, 2) +
         "* largest displacement in the paper's model, which is no promise about the real object\n" +
         (verified.empty() ? "" : "\n" + verified);
}

std::string end_report(const v1::Job& job) {
  std::string out = state_and_reason(job);
  if (!job.detail().empty()) out += ": " + one_line(job.detail());
  out += "\n";
  for (const v1::PrinterResult& printer : job.printers()) {
    if (printer.reason() == v1::REASON_UNSPECIFIED) continue;
    v1::JobEvent event;
    *event.mutable_printer() = printer;
    out += "  " + event_text(event) + "\n";
  }
  return out;
}

std::string job_description(const v1::Job& job) {
  std::vector<Row> rows = {
      {"job", one_line(job.job_id())},
      {"state", state_and_reason(job) + (job.cancel_requested() ? " (cancel requested)" : "")},
      {is_frame_problem(job) ? "problem" : "mesh", one_line(job.spec().mesh_name())},
      {"created", time_text(job.create_time())},
      {"started", time_text(job.start_time())},
      {"ended", time_text(job.end_time())},
      {"attempt", fmt::format("{}", job.attempt())},
      {"events", fmt::format("{}", job.last_sequence())}};
  if (!is_frame_problem(job)) rows.insert(rows.begin() + 3, {"printers", printer_names(job)});
  if (!job.spec().warm_start_job_id().empty())
    rows.push_back({"starts from", one_line(job.spec().warm_start_job_id())});
  if (!job.detail().empty()) rows.push_back({"detail", one_line(job.detail())});
  std::string out = table(rows, 2);
  for (const v1::ResultFile& file : job.files()) {
    out += fmt::format("file      {}  {} bytes\n", one_line(file.path()), file.size_bytes());
  }
  if (const std::string results = result_table(job); !results.empty()) out += "\n" + results;
  for (const v1::PrinterResult& printer : job.printers()) {
    if (printer.reason() == v1::REASON_UNSPECIFIED) continue;
    v1::JobEvent event;
    *event.mutable_printer() = printer;
    out += event_text(event) + "\n";
  }
  return out;
}

std::string job_list(const std::vector<v1::Job>& jobs) {
  std::vector<Row> rows = {{"job", "state", "created", "file", "printers"}};
  for (const v1::Job& job : jobs) {
    rows.push_back({one_line(job.job_id()), state_and_reason(job), time_text(job.create_time()),
                    one_line(job.spec().mesh_name()), printer_names(job)});
  }
  return table(rows, 5);
}

}  // namespace skinframe::client
