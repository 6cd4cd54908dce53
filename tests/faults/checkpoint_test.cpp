// SPDX-License-Identifier: Apache-2.0
// A job whose process dies after a checkpoint goes on from there, on any worker, to the result of an unbroken
// run.
#include <fstream>

#include "tests/faults/fault_test.h"
#include "tests/integration/tower_problem.h"

namespace skinframe::faults {
namespace {

using std::chrono::seconds;

class Resume : public FaultTest {
 protected:
  v1::Job job(const std::string& id) {
    v1::GetJobRequest request;
    request.set_job_id(id);
    v1::Job found;
    grpc::ClientContext context;
    context.set_deadline(std::chrono::system_clock::now() + seconds(10));
    EXPECT_TRUE(witness_->jobs(0).GetJob(&context, request, &found).ok());
    return found;
  }
  // SIGKILL to the job's process once the server has a checkpoint of it.
  void kill_after_checkpoint(const std::string& id) {
    ASSERT_TRUE(witness_->wait(seconds(120), [&] { return job(id).has_checkpoint(); }));
    stage_ = job(id).checkpoint().stage();
    ASSERT_TRUE(farm_->kill_job_of(0) || farm_->kill_job_of(1)) << "the job ended too soon";
  }
  void expect_resumed(const std::string& id) {
    EXPECT_EQ(witness_->attempt_of(id), 2);
    EXPECT_TRUE(witness_->noted(id, stage_ + " is done")) << "no event says from where it went on";
    EXPECT_FALSE(job(id).has_checkpoint()) << "checkpoints go when the job ends";
  }

  std::string stage_;
};

TEST_F(Resume, AKilledFrameJobGoesOnFromItsCheckpointToTheResultOfSolveFrame) {
  set_problem(integration::tower(12, 12, 14, 600));
  begin({Store::kSqlite, 1, 2});
  if (HasFatalFailure()) return;
  const std::string id = witness_->submit(frame_job());
  kill_after_checkpoint(id);
  if (HasFatalFailure()) return;
  expect_all_well(seconds(180));  // among it: the result is that of solve-frame on this machine
  expect_resumed(id);
}

TEST_F(Resume, AKilledMeshJobWritesTheFilesOfTheUnbrokenOneByteForByte) {
  begin({Store::kSqlite, 1, 2});
  if (HasFatalFailure()) return;
  const v1::JobSpec spec = mesh_job();
  const std::string unbroken = witness_->submit(spec);
  ASSERT_TRUE(witness_->wait_for_all(seconds(180)));
  const std::string broken = witness_->submit(spec);
  kill_after_checkpoint(broken);
  if (HasFatalFailure()) return;
  expect_all_well(seconds(180));
  expect_resumed(broken);
  const v1::Job one = job(unbroken), other = job(broken);
  ASSERT_EQ(one.files_size(), other.files_size());
  for (int i = 0; i < one.files_size(); ++i) {
    EXPECT_EQ(one.files(i).path(), other.files(i).path());
    if (one.files(i).path() == "report.json") continue;  // it tells how long the stages took
    EXPECT_EQ(one.files(i).sha256(), other.files(i).sha256()) << one.files(i).path();
  }
}

}  // namespace
}  // namespace skinframe::faults
