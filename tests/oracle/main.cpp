// SPDX-License-Identifier: Apache-2.0
// skinframe_oracle PROBLEM.json [--tolerance T] [--max-seconds S] [--every-strain]
//
// Solves SizeOpt of a frame problem file with Ipopt and MUMPS, and prints one JSON object:
//   "status": "optimal|acceptable|infeasible|iteration_limit|time_limit|failed", "ipopt_status": its own
//   number, "volume_mm3", "areas_mm2": one a strut, "iterations", "factorisations" (0: not known),
//   "kkt_error": Ipopt's, scaled, "peak_mb": resident memory, "seconds": {"start", "solve"}, "cpu_seconds":
//   {"start", "solve"}.
// Exit code 0 whatever the status, 2 wrong usage, 3 a problem that cannot be read.
#include <chrono>
#include <coin/IpIpoptApplication.hpp>
#include <coin/IpSolveStatistics.hpp>
#include <cstring>
#include <ctime>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "tests/oracle/count_factorisations.h"
#include "tests/oracle/size_program.h"
#include "tests/oracle/uniform_start.h"

namespace {

struct Arguments {
  std::string problem;
  double tolerance = 1e-8;  // of Ipopt's scaled optimality error
  double max_seconds = 600;
  bool every_strain = false;
};

bool parse(int argc, char** argv, Arguments& arguments) {
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--every-strain") {
      arguments.every_strain = true;
    } else if ((word == "--tolerance" || word == "--max-seconds") && i + 1 < argc) {
      (word == "--tolerance" ? arguments.tolerance : arguments.max_seconds) = std::atof(argv[++i]);
    } else if (arguments.problem.empty() && word.rfind("--", 0) != 0) {
      arguments.problem = word;
    } else {
      return false;
    }
  }
  return !arguments.problem.empty() && arguments.tolerance > 0 && arguments.max_seconds > 0;
}

const char* status_name(Ipopt::ApplicationReturnStatus status) {
  switch (status) {
    case Ipopt::Solve_Succeeded:
      return "optimal";
    case Ipopt::Solved_To_Acceptable_Level:
      return "acceptable";
    case Ipopt::Infeasible_Problem_Detected:
      return "infeasible";
    case Ipopt::Maximum_Iterations_Exceeded:
      return "iteration_limit";
    case Ipopt::Maximum_CpuTime_Exceeded:
      return "time_limit";
    default:
      return "failed";
  }
}

struct Clock {
  std::chrono::steady_clock::time_point wall = std::chrono::steady_clock::now();
  std::clock_t cpu = std::clock();
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - wall).count();
  }
  double cpu_seconds() const { return static_cast<double>(std::clock() - cpu) / CLOCKS_PER_SEC; }
};

double peak_memory_mb() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.rfind("VmHWM:", 0) == 0) return std::stod(line.substr(6)) / 1024;
  return 0;
}

nlohmann::json solve(const oracle::FrameFile& frame, const Arguments& arguments) {
  const Clock start_clock;
  const oracle::Start start = oracle::uniform_start(frame);
  const double start_seconds = start_clock.seconds(), start_cpu = start_clock.cpu_seconds();

  const Clock solve_clock;
  Ipopt::SmartPtr<oracle::SizeProgram> program =
      new oracle::SizeProgram(frame, start, arguments.every_strain);
  Ipopt::SmartPtr<Ipopt::IpoptApplication> ipopt = IpoptApplicationFactory();
  ipopt->Options()->SetStringValue("linear_solver", "mumps");
  ipopt->Options()->SetNumericValue("tol", arguments.tolerance);
  ipopt->Options()->SetNumericValue("max_cpu_time", arguments.max_seconds);
  ipopt->Options()->SetIntegerValue("max_iter", 1000);
  ipopt->Options()->SetIntegerValue("print_level", 0);
  ipopt->Options()->SetStringValue("sb", "yes");
  Ipopt::ApplicationReturnStatus status = ipopt->Initialize();
  if (status == Ipopt::Solve_Succeeded) status = ipopt->OptimizeTNLP(Ipopt::GetRawPtr(program));

  nlohmann::json result{{"status", status_name(status)},
                        {"ipopt_status", static_cast<int>(status)},
                        {"volume_mm3", program->volume()},
                        {"areas_mm2", program->areas()},
                        {"factorisations", oracle::factorisations()}};
  if (const auto statistics = ipopt->Statistics(); Ipopt::IsValid(statistics)) {
    Ipopt::Number dual = 0, primal = 0, complementarity = 0, worst = 0;
    statistics->ScaledInfeasibilities(dual, primal, complementarity, worst);
    result["iterations"] = statistics->IterationCount();
    result["kkt_error"] = worst;
  }
  result["peak_mb"] = peak_memory_mb();
  result["seconds"] = {{"start", start_seconds}, {"solve", solve_clock.seconds()}};
  result["cpu_seconds"] = {{"start", start_cpu}, {"solve", solve_clock.cpu_seconds()}};
  return result;
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  if (!parse(argc, argv, arguments)) {
    std::cerr << "usage: skinframe_oracle PROBLEM.json [--tolerance T] [--max-seconds S] [--every-strain]\n";
    return 2;
  }
  try {
    const oracle::FrameFile frame = oracle::read_frame_file(arguments.problem);
    std::cout << solve(frame, arguments).dump() << '\n';
  } catch (const std::exception& e) {
    std::cerr << "skinframe_oracle: " << e.what() << '\n';
    return 3;
  }
  return 0;
}
