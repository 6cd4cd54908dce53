// SPDX-License-Identifier: Apache-2.0
// Workers, their job processes, servers and the database die at random instants, again and again, while jobs
// come in: nothing that was acknowledged is lost, nothing is done twice, no watch has a gap.
#include <ostream>

#include "tests/faults/fault_test.h"

namespace skinframe::faults {
namespace {

constexpr int kEndless = 1'000'000;

struct Setting {
  const char* name;
  FarmShape shape;
};
void PrintTo(const Setting& setting, std::ostream* out) { *out << setting.name; }

class Kill : public FaultTest, public testing::WithParamInterface<Setting> {
 protected:
  // One death or freeze, and the return of who died.
  void strike() {
    const int worker = draw(0, farm_->workers() - 1);
    const int server = draw(0, farm_->servers() - 1);
    const int lot = draw(0, 99);
    if (lot < 30) {
      farm_->kill_worker(worker);
      pause(0, 200);
      farm_->start_worker(worker);
    } else if (lot < 75) {
      for (int i = 0; i < farm_->workers(); ++i)  // the first from there on that runs one
        if (farm_->kill_job_of((worker + i) % farm_->workers())) break;
    } else if (lot < 90) {
      farm_->kill_server(server);
      pause(0, 300);
      farm_->start_server(server);
    } else if (lot < 96) {
      farm_->kill_database();
    } else {
      farm_->freeze_worker(worker);
      pause(1000, 1800);  // a lease lasts 1 s
      farm_->thaw_worker(worker);
    }
  }
};

TEST_P(Kill, LosesNothingAndDoublesNothing) {
  begin(GetParam().shape);
  if (HasFatalFailure()) return;
  witness_->submit(mesh_job());  // ends after the storm at the latest
  Submitter submitter(
      *witness_, [this] { return frame_job(); }, 24, kEndless);
  const int wanted = extended() ? 520 : 30;
  while (farm_->kills().total() < wanted && !HasFatalFailure()) {
    pause(20, 300);
    strike();
  }
  submitter.finish();
  expect_all_well(std::chrono::seconds(180));
}

INSTANTIATE_TEST_SUITE_P(Stores, Kill,
                         testing::Values(Setting{"Sqlite", {Store::kSqlite, 1, 4}},
                                         Setting{"Postgres", {Store::kPostgres, 2, 4}}),
                         [](const auto& setting) { return setting.param.name; });

class Replicas : public FaultTest {};

TEST_F(Replicas, TwoServersAndFourWorkersFinishTheirJobsWhileOneServerIsKilledEveryFewSeconds) {
  begin({Store::kPostgres, 2, 4});
  if (HasFatalFailure()) return;
  const int jobs = extended() ? 200 : 80;
  Submitter submitter(
      *witness_, [this] { return frame_job(); }, jobs, jobs);
  while ((!submitter.done() || witness_->running_or_queued() > 0) && !HasFatalFailure()) {
    if (witness_->wait(std::chrono::seconds(draw(2, 4)),
                       [&] { return submitter.done() && witness_->running_or_queued() == 0; }))
      break;
    const int server = draw(0, 1);
    farm_->kill_server(server);
    pause(0, 500);
    farm_->start_server(server);
  }
  submitter.finish();
  expect_all_well(std::chrono::seconds(60));
  EXPECT_EQ(witness_->submitted(), jobs);
  EXPECT_GT(farm_->kills().servers, 0);
}

}  // namespace
}  // namespace skinframe::faults
