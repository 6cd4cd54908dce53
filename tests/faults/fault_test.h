// SPDX-License-Identifier: Apache-2.0
// What the tests of this folder share: a farm, a witness, a problem that takes a part of a second, a seed.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <random>
#include <string>

#include "tests/faults/fault_farm.h"
#include "tests/faults/witness.h"
#include "tests/integration/process.h"

namespace skinframe::faults {

// SKINFRAME_FAULTS=extended: many more kills, from seeds of the day.
bool extended();

class FaultTest : public testing::Test {
 protected:
  FaultTest();

  void set_problem(const nlohmann::json& problem) { problem_ = problem.dump(); }  // before begin()
  // Starts the farm, its witness, and puts the problem where the jobs find it.
  void begin(const FarmShape& shape, const std::filesystem::path& data = {});
  v1::JobSpec frame_job();
  v1::JobSpec mesh_job();
  // Waits for all jobs, and expects that nothing was lost, doubled or stale. Prints what was seen.
  void expect_all_well(std::chrono::seconds at_most);

  int draw(int from, int to) { return std::uniform_int_distribution<int>(from, to)(random_); }
  // Until a moment that nothing tells of: kills strike at random instants.
  void pause(int from_ms, int to_ms);

  integration::Scratch scratch_;
  unsigned seed_;
  std::mt19937 random_;
  std::unique_ptr<FaultFarm> farm_;
  std::unique_ptr<Witness> witness_;

 private:
  std::string problem_, problem_sha256_, expected_;
};

// Keeps so many jobs of a witness alive until it is told to stop.
class Submitter {
 public:
  Submitter(Witness& witness, std::function<v1::JobSpec()> next, int at_once, int at_most);
  void finish();                       // no further ones; a failure of a submission is thrown here
  bool done() const { return done_; }  // at_most were submitted

 private:
  std::atomic<bool> done_ = false;
  std::exception_ptr failure_;
  std::jthread thread_;
};

}  // namespace skinframe::faults
