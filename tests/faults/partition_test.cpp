// SPDX-License-Identifier: Apache-2.0
// Nobody dies, but nobody hears: workers that are frozen for longer than their lease, connections that are
// cut, slow or silent. A late worker's result is refused.
#include <signal.h>

#include "tests/faults/fault_test.h"
#include "tests/faults/tcp_proxy.h"

namespace skinframe::faults {
namespace {

using std::chrono::seconds;

class Partition : public FaultTest {};

TEST_F(Partition, AWorkerFrozenForLongerThanItsLeaseLosesTheJobAndItsResultIsDropped) {
  begin({Store::kSqlite, 1, 1});
  if (HasFatalFailure()) return;
  const int rounds = extended() ? 20 : 3;
  for (int round = 0; round < rounds; ++round) {
    const std::string job = witness_->submit(frame_job());
    ASSERT_TRUE(witness_->wait(seconds(30), [&] { return witness_->attempt_of(job) == 1; }));
    pause(0, 100);
    ASSERT_TRUE(farm_->freeze_worker(0));
    if (witness_->state_of(job) == v1::JOB_STATE_SUCCEEDED) {  // it was quicker
      farm_->thaw_worker(0);
      continue;
    }
    // The job's process goes on and makes its result; nobody heartbeats, so the server takes the job back.
    witness_->wait(seconds(30), [&] { return witness_->state_of(job) != v1::JOB_STATE_RUNNING; });
    farm_->thaw_worker(0);
    ASSERT_TRUE(witness_->wait_for_all(seconds(60)));
  }
  EXPECT_TRUE(farm_->workers_said("the lease is lost") || farm_->workers_said("was not accepted"))
      << "no round struck a running job";
  expect_all_well(seconds(60));
}

// A worker of our own, so that the late call comes when we want it to.
TEST_F(Partition, ALateResultIsRefusedWhileItsRescuerRunsAndAfterItsEnd) {
  begin({Store::kSqlite, 1, 0});
  if (HasFatalFailure()) return;
  const std::string job = witness_->submit(frame_job());
  v1::LeaseRequest ask;
  ask.set_worker_id("late");
  ask.set_instance_id("late");
  ask.mutable_wait()->set_seconds(10);
  v1::LeaseResponse lease;
  grpc::ClientContext lease_context;
  ASSERT_TRUE(witness_->workers(0).Lease(&lease_context, ask, &lease).ok());
  ASSERT_EQ(lease.assignment().job_id(), job);
  const auto late_calls = [&] {
    v1::HeartbeatRequest beat;
    beat.set_job_id(job);
    beat.set_fencing_token(lease.assignment().fencing_token());
    beat.add_progress()->set_stage("geometry");
    v1::HeartbeatResponse beaten;
    grpc::ClientContext beat_context;
    EXPECT_EQ(witness_->workers(0).Heartbeat(&beat_context, beat, &beaten).error_code(),
              grpc::StatusCode::ABORTED);
    v1::CompleteRequest complete;
    complete.set_job_id(job);
    complete.set_fencing_token(lease.assignment().fencing_token());
    complete.set_state(v1::JOB_STATE_SUCCEEDED);
    v1::CompleteResponse completed;
    grpc::ClientContext complete_context;
    EXPECT_EQ(witness_->workers(0).Complete(&complete_context, complete, &completed).error_code(),
              grpc::StatusCode::ABORTED);
  };
  // Queued again, not still: the watch may be behind the lease.
  ASSERT_TRUE(witness_->wait(seconds(30), [&] { return witness_->attempt_of(job) == 1; }));
  ASSERT_TRUE(witness_->wait(seconds(30), [&] { return witness_->state_of(job) == v1::JOB_STATE_QUEUED; }));
  late_calls();
  farm_->add_worker();
  ASSERT_TRUE(witness_->wait(seconds(30), [&] { return witness_->attempt_of(job) == 2; }));
  late_calls();
  ASSERT_TRUE(witness_->wait_for_all(seconds(60)));
  late_calls();
  expect_all_well(seconds(60));
}

TEST_F(Partition, CutSlowAndSilentConnectionsLoseNothing) {
  begin({Store::kSqlite, 1, 3});
  if (HasFatalFailure()) return;
  TcpProxy network(farm_->addresses()[0]);
  for (int worker = 0; worker < farm_->workers(); ++worker) {
    farm_->send_worker_to(worker, network.address());
    farm_->kill_worker(worker);
    farm_->start_worker(worker);
  }
  // The client's own connection is bad too.
  witness_ = std::make_unique<Witness>(std::vector<std::string>{network.address()});
  int cuts = 0;
  const auto end = std::chrono::steady_clock::now() + seconds(extended() ? 300 : 20);
  Submitter submitter(
      *witness_, [this] { return frame_job(); }, 8, 1'000'000);
  while (std::chrono::steady_clock::now() < end) {
    const int lot = draw(0, 9);
    if (lot < 6) {
      pause(20, 400);
      cuts += network.cut();
    } else if (lot < 9) {
      network.delay(std::chrono::milliseconds(draw(5, 200)));
      pause(300, 900);
      network.delay(std::chrono::milliseconds(0));
    } else {
      network.silence(true);
      pause(500, 2500);  // shorter and longer than the lease of 1 s
      network.silence(false);
    }
  }
  submitter.finish();
  expect_all_well(seconds(120));
  std::printf("%d connections cut\n", cuts);
  EXPECT_GT(cuts, 10);
}

}  // namespace
}  // namespace skinframe::faults
