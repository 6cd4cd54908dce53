// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/picture/result_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <system_error>

#include "worker/profile/import_profile.h"

namespace skinframe::picture {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::size_t kMostReportBytes = std::size_t{64} << 20;

// The report is anybody's file: a printer's name becomes a folder's only when it can be nothing else.
bool is_name(const std::string& text) {
  const auto allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
           c == '_' || c == '.';
  };
  return !text.empty() && text.size() <= 100 && text[0] != '.' &&
         std::all_of(text.begin(), text.end(), allowed);
}

std::optional<fs::path> if_there(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error) ? std::optional(path) : std::nullopt;
}

std::vector<Deformation> deformations_in(const fs::path& folder) {
  constexpr std::string_view kBegin = "deformation-", kEnd = ".ply";
  std::vector<Deformation> found;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const std::string name = it->path().filename().string();
    if (!name.starts_with(kBegin) || !name.ends_with(kEnd) || name.size() <= kBegin.size() + kEnd.size())
      continue;
    const std::string load_case = name.substr(kBegin.size(), name.size() - kBegin.size() - kEnd.size());
    std::error_code ignored;  // a folder of that name, say: not a file of ours
    if (is_name(load_case) && it->is_regular_file(ignored)) found.push_back({load_case, it->path()});
  }
  std::sort(found.begin(), found.end(),
            [](const Deformation& a, const Deformation& b) { return a.load_case < b.load_case; });
  if (found.size() > kMostDeformations) found.resize(kMostDeformations);
  return found;
}

std::vector<PrinterFiles> files_by(const json& report, const fs::path& directory) {
  std::vector<PrinterFiles> out;
  if (report.contains("frame")) {
    if (const auto frame = if_there(directory / "result.json"))
      out.push_back({"", "frame", frame, {}, {}, {}});
    return out;
  }
  const std::string mesh = report.at("mesh").at("name").get<std::string>();
  for (const json& item : report.at("printers")) {
    const auto name = item.at("printer").get<std::string>();
    if (!is_name(name)) throw std::out_of_range(fmt::format("\"{}\" is no name of a printer's folder", name));
    const fs::path folder = directory / name;
    PrinterFiles files{name,
                       fmt::format("{}, {}", mesh, name),
                       if_there(folder / "frame.json"),
                       if_there(folder / "skin-frame.stl"),
                       deformations_in(folder),
                       if_there(folder / "pinch.ply")};
    if (files.frame || files.mesh || !files.deformations.empty() || files.pinch)
      out.push_back(std::move(files));
  }
  return out;
}

}  // namespace

Result<std::vector<PrinterFiles>> find_printers(const fs::path& directory, const std::string& printer) {
  std::error_code error;
  if (!fs::is_directory(directory, error))
    return io_error(fmt::format("{}: there is no such folder", directory.string()));
  const fs::path path = directory / "report.json";
  const auto report = read_json_file(path, kMostReportBytes);
  if (!report) return report.error();
  std::vector<PrinterFiles> found;
  try {
    found = files_by(*report, directory);
  } catch (const std::exception& failure) {
    return invalid_input(fmt::format("{}: not a report of a job: {}", path.string(), failure.what()));
  }
  if (printer.empty()) {
    if (!found.empty()) return found;
    return invalid_input(fmt::format("{}: no printer in it has files to draw", directory.string()));
  }
  for (PrinterFiles& files : found)
    if (files.name == printer) return std::vector<PrinterFiles>{std::move(files)};
  std::string known;
  for (const PrinterFiles& files : found) known += (known.empty() ? "" : ", ") + files.name;
  return invalid_input(fmt::format("{}: no printer \"{}\" with files to draw; there are: {}",
                                   directory.string(), printer, known.empty() ? "none" : known));
}

}  // namespace skinframe::picture
