// SPDX-License-Identifier: Apache-2.0
#include "client/present/event_line.h"

#include <fmt/format.h>

#include "client/present/words.h"

namespace skinframe::client {
namespace {

std::string end_text(v1::JobState state, v1::Reason reason, const std::string& detail) {
  std::string out = state_word(state);
  // CANCELLED, CANCELLED says nothing twice.
  if (reason != v1::REASON_UNSPECIFIED && reason_word(reason) != out) out += ", " + reason_word(reason);
  if (!detail.empty()) out += ": " + one_line(detail);
  return out;
}

std::string state_text(const v1::StateChange& change) {
  if (change.state() != v1::JOB_STATE_RUNNING)
    return end_text(change.state(), change.reason(), change.detail());
  return fmt::format("RUNNING (attempt {})", change.attempt());
}

std::string printer_text(const v1::PrinterResult& printer) {
  std::string out =
      one_line(printer.printer_id()) + ": " + end_text(printer.state(), printer.reason(), printer.detail());
  if (printer.has_best_reachable_displacement_mm()) {
    out += fmt::format("  best reachable displacement {:.3f} mm (paper model)",
                       printer.best_reachable_displacement_mm());
  }
  if (printer.has_statistics()) {
    const auto& s = printer.statistics();
    out += fmt::format("  total {:.0f} mm3  ratio {:.1f} %  {:.1f} g", s.total_volume_mm3(), 100 * s.ratio(),
                       s.weight_g());
    if (s.struts() > 0) {
      out += fmt::format("  displacement {:.4f} mm (paper model)", s.max_displacement_mm());
      out += s.has_verified() ? fmt::format(", {:.4f} mm (verified)", s.verified().max_displacement_mm())
                              : ", not verified";
    }
  }
  return out;
}

}  // namespace

std::string progress_text(const v1::JobProgress& p) {
  std::string out;
  if (!p.printer_id().empty()) out = one_line(p.printer_id()) + "  ";
  out += one_line(p.stage());
  if (p.iteration() > 0) out += fmt::format("  iteration {}", p.iteration());
  if (p.has_total_volume_mm3()) {
    out += fmt::format("  total {:.0f} mm3", p.total_volume_mm3());
  } else if (p.has_frame_volume_mm3()) {
    out += fmt::format("  frame {:.0f} mm3", p.frame_volume_mm3());
  }
  if (p.has_ratio()) out += fmt::format("  ratio {:.1f} %", 100 * p.ratio());
  if (p.has_struts_left()) out += fmt::format("  {} struts", p.struts_left());
  if (p.has_violation()) out += fmt::format("  violation {:.1e}", p.violation());
  if (p.has_seconds_left()) out += fmt::format("  {:.0f} s left", p.seconds_left());
  if (!p.note().empty()) out += "  " + one_line(p.note());
  return out;
}

std::string event_text(const v1::JobEvent& event) {
  switch (event.event_case()) {
    case v1::JobEvent::kState:
      return state_text(event.state());
    case v1::JobEvent::kProgress:
      return progress_text(event.progress());
    case v1::JobEvent::kPrinter:
      return printer_text(event.printer());
    case v1::JobEvent::EVENT_NOT_SET:
      break;
  }
  return "an event that this client does not know";
}

std::string event_line(const v1::JobEvent& event) {
  return fmt::format("{:6}  {}  {}", event.sequence(), time_text(event.time()), event_text(event));
}

}  // namespace skinframe::client
