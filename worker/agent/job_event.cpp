// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/agent/job_event.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

namespace skinframe::agent {
namespace {

using nlohmann::json;

constexpr std::size_t kMaxNameBytes = 128;
constexpr std::size_t kMaxPrinters = 16;
constexpr std::size_t kMaxFrameStages = 16;

// The first mistake found in one JSON object; readers after it do nothing.
class ObjectReader {
 public:
  ObjectReader(const json& object, const char* what) : object_(object), what_(what) {
    if (!object.is_object()) error_ = fmt::format("{} is not an object", what);
  }

  std::optional<double> number(const char* key) {
    const json* value = find(key);
    if (value == nullptr) return std::nullopt;
    if (!value->is_number() || !std::isfinite(value->get<double>())) {
      fail(key, "is not a finite number");
      return std::nullopt;
    }
    return value->get<double>();
  }

  std::optional<int> count(const char* key) {
    const auto value = number(key);
    if (!value) return std::nullopt;
    if (*value < 0 || *value > std::numeric_limits<int>::max() || *value != std::floor(*value)) {
      fail(key, "is not a count");
      return std::nullopt;
    }
    return static_cast<int>(*value);
  }

  std::string text(const char* key, std::size_t max_bytes) {
    const json* value = find(key);
    if (value == nullptr) return {};
    if (!value->is_string()) {
      fail(key, "is not a text");
      return {};
    }
    std::string out = value->get<std::string>();  // UTF-8: the parser has checked it
    if (out.size() > max_bytes) {
      std::size_t end = max_bytes;  // not in the middle of a character
      while (end > 0 && (static_cast<unsigned char>(out[end]) & 0xC0) == 0x80) --end;
      out.resize(end);
    }
    return out;
  }

  // An enum value by its wire name without prefix: JOB_STATE_ + "FAILED". Absent counts as `none`, where
  // there is one.
  template <class Enum, class Parse>
  Enum word(const char* key, const char* prefix, Parse parse, const char* none) {
    Enum value{};
    const std::string name = text(key, kMaxNameBytes);
    if (!error_.empty() || (none != nullptr && (name.empty() || name == none))) return value;
    if (!parse(prefix + name, &value) || value == Enum{}) fail(key, "has an unknown value");
    return value;
  }

  const json* find(const char* key) {
    if (!error_.empty()) return nullptr;
    const auto it = object_.find(key);
    return it == object_.end() || it->is_null() ? nullptr : &*it;
  }

  void fail(const char* key, const char* wrong) {
    if (error_.empty()) error_ = fmt::format("{}: \"{}\" {}", what_, key, wrong);
  }
  const std::string& error() const { return error_; }

 private:
  const json& object_;
  const char* what_;
  std::string error_;
};

v1::JobState read_state(ObjectReader& reader) {
  return reader.word<v1::JobState>(
      "state", "JOB_STATE_", [](const std::string& n, v1::JobState* v) { return v1::JobState_Parse(n, v); },
      nullptr);
}

v1::Reason read_reason(ObjectReader& reader) {
  return reader.word<v1::Reason>(
      "reason", "REASON_", [](const std::string& n, v1::Reason* v) { return v1::Reason_Parse(n, v); },
      "NONE");
}

Result<v1::JobProgress> read_progress(const json& object) {
  ObjectReader in(object, "progress");
  v1::JobProgress out;
  out.set_printer_id(in.text("printer", kMaxNameBytes));
  out.set_stage(in.text("stage", kMaxNameBytes));
  out.set_note(in.text("note", kMaxNoteBytes));
  out.set_iteration(in.count("iteration").value_or(0));
  if (const auto v = in.number("frame_volume_mm3")) out.set_frame_volume_mm3(*v);
  if (const auto v = in.number("skin_volume_mm3")) out.set_skin_volume_mm3(*v);
  if (const auto v = in.number("total_volume_mm3")) out.set_total_volume_mm3(*v);
  if (const auto v = in.number("ratio")) out.set_ratio(*v);
  if (const auto v = in.count("struts_left")) out.set_struts_left(*v);
  if (const auto v = in.number("violation")) out.set_violation(*v);
  if (const auto v = in.number("seconds_left")) out.set_seconds_left(*v);
  if (out.stage().empty()) in.fail("stage", "is missing");
  if (!in.error().empty()) return invalid_input(in.error());
  return out;
}

Result<v1::VerifiedFigures> read_verified(const json& object) {
  ObjectReader in(object, "verified");
  v1::VerifiedFigures out;
  out.set_max_displacement_mm(in.number("max_displacement_mm").value_or(0));
  out.set_max_stress_mpa(in.number("max_stress_mpa").value_or(0));
  if (const auto v = in.number("safety_factor")) out.set_safety_factor(*v);
  if (const auto v = in.number("buckling_factor")) out.set_buckling_factor(*v);
  if (const auto v = in.number("pinch_max_mm")) out.set_pinch_max_mm(*v);
  if (const auto v = in.number("solid_max_displacement_mm")) out.set_solid_max_displacement_mm(*v);
  if (const auto v = in.number("hollow_max_displacement_mm")) out.set_hollow_max_displacement_mm(*v);
  if (const auto v = in.number("hollow_thickness_mm")) out.set_hollow_thickness_mm(*v);
  if (const auto v = in.number("hollow_pinch_max_mm")) out.set_hollow_pinch_max_mm(*v);
  out.set_verdict(in.text("verdict", kMaxDetailBytes));
  if (!in.error().empty()) return invalid_input(in.error());
  return out;
}

Result<v1::PrinterStatistics> read_statistics(const json& object) {
  ObjectReader in(object, "statistics");
  v1::PrinterStatistics out;
  out.set_solid_volume_mm3(in.number("solid_volume_mm3").value_or(0));
  out.set_skin_volume_mm3(in.number("skin_volume_mm3").value_or(0));
  out.set_frame_volume_mm3(in.number("frame_volume_mm3").value_or(0));
  out.set_total_volume_mm3(in.number("total_volume_mm3").value_or(0));
  out.set_ratio(in.number("ratio").value_or(0));
  out.set_printed_volume_mm3(in.number("printed_volume_mm3").value_or(0));
  out.set_printed_ratio(in.number("printed_ratio").value_or(0));
  out.set_weight_g(in.number("weight_g").value_or(0));
  out.set_skin_nodes(in.count("skin_nodes").value_or(0));
  out.set_nodes(in.count("nodes").value_or(0));
  out.set_struts(in.count("struts").value_or(0));
  out.set_max_displacement_mm(in.number("max_displacement_mm").value_or(0));
  out.set_balance(in.text("balance", kMaxNameBytes));
  if (const json* verified = in.find("verified")) {
    auto read = read_verified(*verified);
    if (!read) return read.error();
    *out.mutable_verified() = std::move(read).value();
  }
  out.set_not_verified(in.text("not_verified", kMaxDetailBytes));
  if (!in.error().empty()) return invalid_input(in.error());
  return out;
}

Result<v1::PrinterResult> read_printer(const json& object) {
  ObjectReader in(object, "printer");
  v1::PrinterResult out;
  out.set_printer_id(in.text("printer", kMaxNameBytes));
  out.set_material_id(in.text("material", kMaxNameBytes));
  out.set_state(read_state(in));
  out.set_reason(read_reason(in));
  out.set_detail(in.text("detail", kMaxDetailBytes));
  if (const auto v = in.number("best_reachable_displacement_mm")) out.set_best_reachable_displacement_mm(*v);
  if (const json* statistics = in.find("statistics")) {
    auto read = read_statistics(*statistics);
    if (!read) return read.error();
    *out.mutable_statistics() = std::move(read).value();
  }
  if (out.printer_id().empty()) in.fail("printer", "is missing");
  if (!in.error().empty()) return invalid_input(in.error());
  return out;
}

Result<v1::FrameStage> read_frame_stage(const json& object) {
  ObjectReader in(object, "frame.stages");
  v1::FrameStage out;
  out.set_stage(in.text("stage", kMaxNameBytes));
  out.set_frame_volume_mm3(in.number("frame_volume_mm3").value_or(0));
  out.set_nodes(in.count("nodes").value_or(0));
  out.set_struts(in.count("struts").value_or(0));
  if (!in.error().empty()) return invalid_input(in.error());
  return out;
}

Result<v1::FrameResult> read_frame(const json& object) {
  ObjectReader in(object, "frame");
  v1::FrameResult out;
  out.set_mechanics(in.text("mechanics", kMaxNameBytes));
  if (const auto v = in.number("max_displacement_mm")) out.set_max_displacement_mm(*v);
  out.set_max_axial_ratio(in.number("max_axial_ratio").value_or(0));
  out.set_max_shear_ratio(in.number("max_shear_ratio").value_or(0));
  if (const auto v = in.number("lower_bound_mm3")) out.set_lower_bound_mm3(*v);
  out.set_violated_constraint(in.text("violated_constraint", kMaxNameBytes));
  if (const auto v = in.number("best_reachable_displacement_mm")) out.set_best_reachable_displacement_mm(*v);
  out.set_iterations(in.count("iterations").value_or(0));
  const json* stages = in.find("stages");
  if (stages != nullptr && (!stages->is_array() || stages->size() > kMaxFrameStages))
    in.fail("stages", "is not a list of at most 16");
  if (!in.error().empty()) return invalid_input(in.error());
  if (stages == nullptr) return out;
  for (const json& each : *stages) {
    auto stage = read_frame_stage(each);
    if (!stage) return stage.error();
    *out.add_stages() = std::move(stage).value();
  }
  return out;
}

template <class T>
Result<JobLine> as_line(Result<T> read) {
  if (!read) return read.error();
  return JobLine(std::move(read).value());
}

}  // namespace

Result<JobLine> parse_event_line(std::string_view line) {
  const json event = json::parse(line, nullptr, false);
  if (!event.is_object()) return invalid_input("an event line is not a JSON object");
  if (const auto it = event.find("progress"); it != event.end()) return as_line(read_progress(*it));
  if (const auto it = event.find("printer"); it != event.end()) return as_line(read_printer(*it));
  if (const auto it = event.find("checkpoint"); it != event.end()) {
    ObjectReader in(*it, "checkpoint");
    CheckpointReady ready{in.text("stage", kMaxNameBytes)};
    if (!in.error().empty()) return invalid_input(in.error());
    return JobLine(std::move(ready));
  }
  return invalid_input("an event line tells neither progress nor a printer nor a checkpoint");
}

Result<Outcome> parse_outcome(std::string_view text) {
  const json object = json::parse(text, nullptr, false);
  if (object.is_discarded()) return invalid_input("outcome.json is not JSON");
  ObjectReader in(object, "outcome");
  Outcome out;
  out.state = read_state(in);
  out.reason = read_reason(in);
  out.detail = in.text("detail", kMaxDetailBytes);
  if (out.state == v1::JOB_STATE_QUEUED || out.state == v1::JOB_STATE_RUNNING) in.fail("state", "is no end");
  const json* printers = in.find("printers");
  if (printers != nullptr && (!printers->is_array() || printers->size() > kMaxPrinters)) {
    in.fail("printers", "is not a list of at most 16");
  }
  if (!in.error().empty()) return invalid_input(in.error());
  if (const json* frame = in.find("frame")) {
    auto read = read_frame(*frame);
    if (!read) return read.error();
    out.frame = std::move(read).value();
  }
  if (printers == nullptr) return out;
  for (const json& each : *printers) {
    auto printer = read_printer(each);
    if (!printer) return printer.error();
    out.printers.push_back(std::move(printer).value());
  }
  return out;
}

}  // namespace skinframe::agent
