// SPDX-License-Identifier: GPL-3.0-or-later
// Measures methods on frames under loads and prints one table; README.md one folder up tells how to read it.
// Each row is a process of its own: this program again with --row, or the oracle.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>

#include "tests/bench/frames/loads.h"
#include "tests/bench/optimise/ask_ipopt.h"
#include "tests/bench/optimise/cases.h"
#include "tests/bench/optimise/child.h"
#include "tests/bench/optimise/methods.h"
#include "tests/bench/optimise/table.h"
#include "tests/fixture/temporary_folder.h"
#include "worker/problem/problem_file.h"

namespace skinframe::bench {
namespace {

constexpr int kOk = 0, kNotEqual = 1, kUsage = 2, kFailed = 5;
constexpr double kTolerance = 1e-7;  // OptimizeOptions::kkt_tolerance, and Ipopt's

struct Arguments {
  FrameChoice frames{{"ellipsoid", "hanging-ball"}, {}, ""};
  std::vector<std::string> sizes{"150/700", "500/3000"};
  std::vector<std::string> loads{"self", "side", "three"};
  std::vector<std::string> methods{"ipopt", "size", "tight", "paper", "greedy", "uniform", "mma"};
  MethodLimits limits{300, 1};
  std::vector<std::string> files;  // problem files, measured with their own loads instead of made frames
  std::string json_file;
  std::string keep;              // folder for the problem files
  std::optional<double> equal;   // SizeOpt's volume over Ipopt's, at most this far from one
  std::vector<std::string> row;  // method and problem file, in the child
};

// The child's part: one method on one problem file, the row on stdout.
int run_row(const std::string& method, const std::string& file, const MethodLimits& limits) {
  const auto problem = read_problem(file);
  if (!problem) {
    std::cerr << "bench: " << problem.error().message << '\n';
    return kFailed;
  }
  auto row = run_method(method, problem->problem, limits);
  if (!row) {
    std::cerr << "bench: " << method << ": " << row.error().message << '\n';
    return kFailed;
  }
  row.value().peak_mb = peak_memory_mb();
  std::cout << to_json(*row).dump() << '\n';
  return kOk;
}

class Bench {
 public:
  explicit Bench(const Arguments& arguments) : arguments_(arguments), oracle_(find_oracle()) {}

  int run() {
    if (wanted("ipopt") && !oracle_)
      std::cerr << "bench: Ipopt's program is not there (coinor-libipopt-dev when this was built): no rows "
                   "of it, no "
                   "ratios\n";
    if (wanted("mma") && !has_nlopt())
      std::cerr << "bench: NLopt was not there when this was built (libnlopt-dev): no rows of nested MMA\n";
    std::cout << table_head() << std::flush;
    const bool any = arguments_.files.empty() ? measure_made_frames() : measure_files();
    if (!arguments_.json_file.empty()) std::ofstream(arguments_.json_file) << rows_.dump(1) << '\n';
    if (!any) return kFailed;
    if (failed_) return kFailed;
    return unequal_ ? kNotEqual : kOk;
  }

 private:
  bool wanted(const std::string& method) const {
    return std::find(arguments_.methods.begin(), arguments_.methods.end(), method) !=
           arguments_.methods.end();
  }

  bool measure_made_frames() {
    return for_each_frame(arguments_.frames, [this](const NamedProblem& named) {
      for (const std::string& load : arguments_.loads)
        measure(named.name, load, with_loads(named.problem, *load_kind(load), !named.fixed_load));
    });
  }

  bool measure_files() {
    for (const std::string& path : arguments_.files) {
      auto file = read_problem(path);
      if (!file) {
        std::cerr << fmt::format("bench: {}: {}\n", path, file.error().message);
        return false;
      }
      measure(std::filesystem::path(path).stem(), "own", {std::move(file.value().problem), 0});
    }
    return true;
  }

  void measure(const std::string& name, const std::string& load, const LoadedProblem& loaded) {
    const auto file = scratch_.path() / "problem.json";
    std::ofstream(file) << to_json(loaded.problem, {}, {});
    if (!arguments_.keep.empty()) {
      const auto kept = fmt::format("{}-{}-{}.json", name, loaded.problem.frame.nodes_mm.size(), load);
      std::filesystem::create_directories(arguments_.keep);
      std::filesystem::copy_file(file, std::filesystem::path(arguments_.keep) / kept,
                                 std::filesystem::copy_options::overwrite_existing);
    }
    std::optional<Row> ipopt;
    std::string stages;
    for (const std::string& method : arguments_.methods) {
      if ((method == "ipopt" && !oracle_) || (method == "mma" && !has_nlopt())) continue;
      Row row = method == "ipopt"
                    ? ask_ipopt(*oracle_, file, loaded.problem, kTolerance, arguments_.limits.max_seconds)
                    : run_in_child(method, file);
      row.frame = name;
      row.load = load;
      row.method = method;
      row.force_n = loaded.force_n;
      row.nodes = static_cast<int>(loaded.problem.frame.nodes_mm.size());
      row.struts = static_cast<int>(loaded.problem.frame.struts.size());
      if (method == "ipopt") ipopt = row;
      std::cout << table_line(row, ipopt ? &*ipopt : nullptr) << std::flush;
      if (method == "tight" || method == "paper") stages += stage_lines(row);
      if (method == "size") compare(row, ipopt);
      rows_.push_back(to_json(row));
    }
    std::cout << stages;
    if (!stages.empty() && load == "top5") std::cout << paper_lines();
    std::cout << std::flush;
  }

  Row run_in_child(const std::string& method, const std::filesystem::path& file) {
    const ChildEnd end = run_child({"/proc/self/exe", "--row", method, file.string(), "--max-seconds",
                                    fmt::format("{:g}", arguments_.limits.max_seconds), "--threads",
                                    fmt::format("{}", arguments_.limits.threads)},
                                   arguments_.limits.max_seconds + 30);
    Row row;
    if (end.timed_out) {
      row.status = "time limit";
    } else if (end.exit_code != kOk) {
      row.status = fmt::format("exit code {}", end.exit_code);
      failed_ = true;
    } else {
      row = row_from_json(nlohmann::json::parse(end.out));
    }
    return row;
  }

  void compare(const Row& size, const std::optional<Row>& ipopt) {
    if (!arguments_.equal) return;
    const bool comparable = ipopt && ipopt->status == "optimal" && ipopt->volume_mm3 && size.volume_mm3;
    if (comparable && std::abs(*size.volume_mm3 / *ipopt->volume_mm3 - 1) <= *arguments_.equal) return;
    std::cerr << fmt::format("bench: {} {}: SizeOpt and Ipopt do not agree to {:g}\n", size.frame, size.load,
                             *arguments_.equal);
    unequal_ = true;
  }

  const Arguments& arguments_;
  test::TemporaryFolder scratch_;
  std::optional<std::filesystem::path> oracle_;
  nlohmann::json rows_ = nlohmann::json::array();
  bool failed_ = false, unequal_ = false;
};

// "500/3000"
std::optional<FrameSize> parse_size(const std::string& text) {
  FrameSize size;
  int used = 0;
  if (std::sscanf(text.c_str(), "%d/%d%n", &size.nodes, &size.struts, &used) != 2) return std::nullopt;
  if (used != static_cast<int>(text.size()) || !is_possible(size)) return std::nullopt;
  return size;
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  const char* models = std::getenv("SKINFRAME_MODELS");
  arguments.frames.models = models != nullptr ? models : SKINFRAME_DEFAULT_MODELS;
  std::vector<std::string> methods = method_names();
  methods.push_back("ipopt");

  CLI::App app{"Measures the optimiser beside Ipopt, nested MMA, greedy cleaning and a uniform radius."};
  app.footer(
      "Examples:\n"
      "  skinframe_bench_optimise                                          two sizes, all loads, all "
      "methods: minutes\n"
      "  skinframe_bench_optimise --sizes 2000/12000 --loads side --methods ipopt,size,tight\n"
      "  skinframe_bench_optimise --frames corpus --loads side --methods ipopt,size,tight\n"
      "  skinframe_bench_optimise --frames paper --loads top5 --methods size,tight,paper");
  app.add_option("--frames", arguments.frames.bodies, "ellipsoid, hanging-ball (at each size); paper, corpus")
      ->delimiter(',')
      ->check(CLI::IsMember(body_names()))
      ->capture_default_str();
  app.add_option("PROBLEM", arguments.files,
                 "Problem files to measure on, with their own loads, instead of --frames");
  app.add_option("--sizes", arguments.sizes, "NODES/STRUTS of generated frames")
      ->delimiter(',')
      ->capture_default_str();
  app.add_option("--loads", arguments.loads, "self, side, three, top5")
      ->delimiter(',')
      ->check(CLI::IsMember(load_names()))
      ->capture_default_str();
  app.add_option("--methods", arguments.methods, "ipopt first, so that the others have it to compare with")
      ->delimiter(',')
      ->check(CLI::IsMember(methods))
      ->capture_default_str();
  app.add_option("--max-seconds", arguments.limits.max_seconds, "Of one row; it is killed a little later")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--threads", arguments.limits.threads, "Of our optimiser; Ipopt with MUMPS has one")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  app.add_option("--models", arguments.frames.models, "Folder of the corpus (default: SKINFRAME_MODELS)");
  app.add_option("--json", arguments.json_file, "All rows as JSON into this file");
  app.add_option("--keep", arguments.keep,
                 "Leave the problem files in this folder, for skinframe solve-frame");
  app.add_option("--expect-equal", arguments.equal,
                 "Exit code 1 unless SizeOpt's volume is Ipopt's to this, relative");
  app.add_option("--row", arguments.row, "METHOD FILE: one row as JSON; for this program's own use")
      ->expected(2);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kOk : kUsage;
  }
  if (!arguments.row.empty()) return run_row(arguments.row[0], arguments.row[1], arguments.limits);
  for (const std::string& text : arguments.sizes) {
    const auto size = parse_size(text);
    if (!size) {
      std::cerr << "bench: --sizes " << text
                << ": NODES/STRUTS, at least 60 nodes and four to twelve struts a node\n";
      return kUsage;
    }
    arguments.frames.sizes.push_back(*size);
  }
  return Bench(arguments).run();
}

}  // namespace skinframe::bench

int main(int argc, char** argv) { return skinframe::bench::main(argc, argv); }
