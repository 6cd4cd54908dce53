// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/check/exported.h"

#include <fmt/format.h>

#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "worker/check/exported_figures.h"
#include "worker/check/exported_frame.h"
#include "worker/check/exported_orientation.h"
#include "worker/check/exported_stages.h"
#include "worker/check/exported_supports.h"
#include "worker/mesh/read_mesh.h"

namespace skinframe::check {
namespace {

using nlohmann::json;

constexpr std::uintmax_t kMaxJsonBytes = std::uintmax_t{1} << 30;

Result<json> read_json(const std::filesystem::path& path) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error) return io_error(fmt::format("{}: {}", path.string(), error.message()));
  if (size > kMaxJsonBytes)
    return invalid_input(fmt::format("{}: {} bytes are too many", path.string(), size));
  std::ifstream in(path);
  json document = json::parse(in, nullptr, false);
  if (document.is_discarded()) return invalid_input(fmt::format("{}: not JSON", path.string()));
  return document;
}

// The frame that was optimised, and what proves the bounds on its volume.
void read_given(const json& given, const json& proofs, ExportedPrinter* out) {
  out->given = parse_frame(given, Radii::kNone);
  out->bound_proof = parse_proof(proofs, "lower_bound_proof", *out->given);
  out->relaxed_bound_proof = parse_proof(proofs, "relaxed_lower_bound_proof", *out->given);
}

// One of the printer's further files; files that make no claim of their own are passed over.
Status read_listed(const std::filesystem::path& path, const json& item, ExportedPrinter* printer,
                   RunContext& context) {
  const std::string name = path.filename().string();
  if (name == "skin-frame-compact.stl") {
    auto file = read_mesh(path, ReadLimits{}, context);
    if (!file) return file.error();
    printer->compact = weld_equal(file->mesh);
    const json& compact = item.at("compact");
    printer->compact_crossings = compact.value("crossings", std::size_t{0});
    printer->compact_triangles = compact.at("triangles").get<std::size_t>();
    printer->compact_volume_mm3 = compact.at("volume_mm3").get<double>();
    printer->compact_deviation_mm = compact.at("deviation_mm").get<double>();
  } else if (name == "skin-frame.3mf" || name == "frame-beams.3mf") {
    auto package = read_package(path);
    if (!package) return package.error();
    (name == "skin-frame.3mf" ? printer->package : printer->beams) = std::move(package).value();
  } else if (name == "initial-frame.json") {
    auto initial = read_json(path);
    if (!initial) return initial.error();
    if (!printer->lower_bound_mm3 && !printer->relaxed_lower_bound_mm3) return ok_status();
    read_given(*initial, *initial, printer);
  } else if (name.starts_with("deformation-") && printer->verification) {
    auto deformation = read_deformation(path);
    if (!deformation) return deformation.error();
    printer->verification->deformations.push_back(std::move(deformation).value());
  } else if (name.starts_with("hole-") && printer->drain) {
    auto file = read_mesh(path, ReadLimits{}, context);
    if (!file) return file.error();
    (name == "hole-lids.stl" ? printer->drain->lids_mesh : printer->drain->caps_mesh) =
        weld_equal(file->mesh);
  } else if (name == "pinch.ply" && printer->verification) {
    auto pinch = read_pinch(path);
    if (!pinch) return pinch.error();
    printer->verification->pinch = std::move(pinch).value();
  } else if (name.starts_with("support-struts") && printer->supports) {
    auto file = read_mesh(path, ReadLimits{}, context);
    if (!file) return file.error();
    ExportedSupports& supports = *printer->supports;
    (name == "support-struts-internal.stl"   ? supports.internal_mesh
     : name == "support-struts-external.stl" ? supports.external_mesh
                                             : supports.all_mesh) = weld_equal(file->mesh);
  }
  return ok_status();
}

}  // namespace

TriangleMesh weld_equal(const TriangleMesh& soup) {
  TriangleMesh welded;
  std::map<std::array<double, 3>, int> index_of;
  std::vector<int> renamed(soup.vertices.size());
  for (std::size_t i = 0; i < soup.vertices.size(); ++i) {
    const Eigen::Vector3d& v = soup.vertices[i];
    const auto [it, fresh] =
        index_of.try_emplace({v.x(), v.y(), v.z()}, static_cast<int>(welded.vertices.size()));
    if (fresh) welded.vertices.push_back(v);
    renamed[i] = it->second;
  }
  welded.triangles.reserve(soup.triangles.size());
  for (const auto& t : soup.triangles)
    welded.triangles.push_back({renamed[t[0]], renamed[t[1]], renamed[t[2]]});
  return welded;
}

Result<Exported> read_exported(const std::filesystem::path& directory, RunContext& context) {
  const auto report_path = directory / "report.json";
  auto report = read_json(report_path);
  if (!report) return report.error();
  std::vector<ExportedPrinter> printers;
  std::optional<ExportedOrientation> orientation;
  std::filesystem::path reading = report_path;
  try {
    if (report->contains("frame")) {
      ExportedPrinter solution = parse_solution(report->at("frame"));
      reading = directory / "result.json";
      auto frame = read_json(reading);
      if (!frame) return frame.error();
      solution.frame = parse_frame(*frame);
      solution.certificate = parse_proof(*frame, "certificate", solution.frame);
      solution.stages = parse_stages(*frame, report->at("frame").at("counts"));
      report_volumes(&solution, report->at("frame").at("volumes_mm3").at("initial").get<double>());
      if (frame->contains("given")) read_given(frame->at("given"), *frame, &solution);
      return Exported{{}, std::nullopt, std::move(solution)};
    }
    orientation = parse_orientation(report->at("mesh"));
    for (const json& item : report->at("printers")) {
      reading = report_path;
      // A printer that was refused before it had a frame (does not fit, for example) claims nothing.
      if (!item.contains("termination")) continue;
      ExportedPrinter printer = parse_printer(item);
      printer.solid_triangles = report->at("mesh").at("triangles").get<std::size_t>();
      if (item.contains("drain_holes")) {
        printer.drain = parse_drain(item.at("drain_holes"));
        printer.solid_triangles = printer.drain->outer_triangles;
      }
      printer.crossings = item.value("crossings", std::size_t{0});
      const auto folder = directory / printer.printer;
      if (!printer.solid()) {
        reading = folder / "frame.json";
        auto frame = read_json(reading);
        if (!frame) return frame.error();
        printer.frame = parse_frame(*frame);
        printer.certificate = parse_proof(*frame, "certificate", printer.frame);
        printer.stages = parse_stages(*frame, item.at("counts"));
        report_volumes(&printer, std::nullopt);
        if (item.contains("supports") && frame->contains("supports"))
          printer.supports = parse_supports(frame->at("supports"), item.at("supports"),
                                            printer.frame.nodes_mm.size(), printer.frame.struts.size());
      }
      if (!printer.infeasible()) {
        auto merged = read_mesh(folder / "skin-frame.stl", ReadLimits{}, context);
        if (!merged) return merged.error();
        printer.merged = weld_equal(merged->mesh);
      }
      for (const json& file : item.value("files", json::array())) {
        reading = folder / file.get<std::string>();
        if (auto read = read_listed(reading, item, &printer, context); !read) return read.error();
      }
      printers.push_back(std::move(printer));
    }
  } catch (const std::exception& error) {
    return invalid_input(fmt::format("{}: {}", reading.string(), error.what()));
  }
  if (printers.empty())
    return invalid_input(fmt::format("{}: no printer in it has a result to check", report_path.string()));
  return Exported{std::move(printers), std::move(orientation), std::nullopt};
}

}  // namespace skinframe::check
