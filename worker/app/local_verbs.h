// SPDX-License-Identifier: GPL-3.0-or-later
// The verbs that need no server: sample, check, solve-frame, render.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "worker/picture/render.h"

namespace skinframe {

class LocalVerbs {
 public:
  // Adds the verbs to the program's command line. The app must outlive this.
  explicit LocalVerbs(CLI::App& app);

  // Runs the verb that the command line named; its exit code, or nothing when it named none.
  std::optional<int> run();

 private:
  int run_sample() const;
  int run_check() const;
  int run_solve_frame() const;
  int run_render() const;

  CLI::App* sample_ = nullptr;
  CLI::App* check_ = nullptr;
  CLI::App* solve_frame_ = nullptr;
  CLI::App* render_ = nullptr;
  bool list_samples_ = false;
  bool json_ = false;
  bool verbose_ = false;
  picture::RenderRequest pictures_;
  std::string sample_name_, directory_, problem_, out_;
};

}  // namespace skinframe
