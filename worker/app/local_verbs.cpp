// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/app/local_verbs.h"

#include <iostream>
#include <nlohmann/json.hpp>

#include "worker/check/check.h"
#include "worker/mesh/write_stl.h"
#include "worker/picture/bodies.h"
#include "worker/problem/solve_frame.h"
#include "worker/sample/make_sample.h"

namespace skinframe {
namespace {

constexpr auto kReplace = nlohmann::json::error_handler_t::replace;  // of names that are no UTF-8
// Exit codes of the command line (README of client/).
constexpr int kOk = 0, kClaimFails = 1, kUsage = 2, kBadInput = 3, kInternal = 5;

int fail(const Error& error, int code) {
  std::cerr << "skinframe: " << error.message << '\n';
  return code;
}

}  // namespace

LocalVerbs::LocalVerbs(CLI::App& app) {
  sample_ = app.add_subcommand("sample", "Write one of the bodies that ship with the program as STL");
  sample_->add_option("NAME", sample_name_, "Which; see --list");
  sample_->add_option("--out", out_, "File to write");
  sample_->add_flag("--list", list_samples_, "List the names");
  sample_->add_flag("--json", json_, "List as JSON");
  check_ = app.add_subcommand("check", "Re-read a result folder and judge every claim it makes");
  check_->add_option("DIR", directory_, "Folder with report.json")->required();
  check_->add_flag("--json", json_, "Verdict as JSON");
  render_ = app.add_subcommand("render", "Pictures of a result as PNG files, without a display");
  render_->add_option("DIR", pictures_.directory, "Folder with report.json")->required();
  render_->add_option("--out", pictures_.out,
                      "Folder to write to, one folder a printer in it (default: DIR)");
  render_->add_option("--printer", pictures_.printer, "Only that printer's (default: all)");
  render_->add_option("--size", pictures_.side_px, "Width in pixels")
      ->check(CLI::Range(picture::kLeastSidePx, picture::kMostSidePx))
      ->capture_default_str();
  render_->add_flag("--json", json_, "Files written, as JSON");
  solve_frame_ = app.add_subcommand("solve-frame", "Optimise a given frame");
  solve_frame_->add_option("PROBLEM", problem_, "Problem file (JSON)")->required();
  solve_frame_->add_option("--out", out_, "Result file (JSON)")->required();
  solve_frame_->add_flag("--json", json_, "Summary as JSON");
  solve_frame_->add_flag("--verbose", verbose_, "A line for each iteration of the interior point");
}

std::optional<int> LocalVerbs::run() {
  if (sample_->parsed()) return run_sample();
  if (check_->parsed()) return run_check();
  if (solve_frame_->parsed()) return run_solve_frame();
  if (render_->parsed()) return run_render();
  return std::nullopt;
}

int LocalVerbs::run_sample() const {
  if (list_samples_) {
    nlohmann::json list = nlohmann::json::array();
    for (const SampleInfo& info : samples()) {
      list.push_back({{"name", info.name}, {"description", info.description}});
      if (!json_)
        std::cout << info.name << std::string(28 - std::min<std::size_t>(27, info.name.size()), ' ')
                  << info.description << '\n';
    }
    if (json_) std::cout << list.dump(2) << '\n';
    return kOk;
  }
  if (sample_name_.empty() || out_.empty()) {
    std::cerr << "skinframe: sample needs NAME and --out FILE; `skinframe sample --list` shows the names\n";
    return kUsage;
  }
  RunContext context;
  auto mesh = make_sample(sample_name_, context);
  if (!mesh) return fail(mesh.error(), kUsage);
  if (auto written = write_stl(*mesh, out_); !written) return fail(written.error(), kInternal);
  if (json_)
    std::cout << nlohmann::json{{"file", out_}, {"triangles", mesh->triangles.size()}}.dump() << '\n';
  return kOk;
}

int LocalVerbs::run_check() const {
  RunContext context;
  auto verdicts = check::check_directory(directory_, context);
  if (!verdicts) return fail(verdicts.error(), kBadInput);
  std::cout << (json_ ? check::to_json_text(*verdicts) : check::to_text(*verdicts));
  for (const check::Verdict& verdict : *verdicts)
    if (!verdict.holds()) return kClaimFails;
  return kOk;
}

int LocalVerbs::run_render() const {
  RunContext context;
  const auto written = picture::render(pictures_, context);
  if (!written)
    return fail(written.error(), written.error().kind == ErrorKind::kInternal ? kInternal : kBadInput);
  nlohmann::json files = nlohmann::json::array();
  for (const std::filesystem::path& file : *written) {
    files.push_back(file.string());
    if (!json_) std::cout << file.string() << '\n';
  }
  if (json_) std::cout << nlohmann::json{{"files", files}}.dump(2, ' ', false, kReplace) << '\n';
  return kOk;
}

int LocalVerbs::run_solve_frame() const { return solve_frame_main(problem_, out_, {json_, verbose_}); }

}  // namespace skinframe
