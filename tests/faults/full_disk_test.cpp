// SPDX-License-Identifier: Apache-2.0
// The disk of the server, or of its database, is full: it says so, loses nothing, and goes on once there is
// room.
#include <sys/mount.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <optional>

#include "tests/faults/fault_test.h"

namespace skinframe::faults {
namespace {

using std::chrono::seconds;

// A small disk of the test's own; unmounted at the end.
class SmallDisk {
 public:
  SmallDisk(const std::filesystem::path& place, const char* size) : place_(place) {
    std::filesystem::create_directories(place);
    mounted_ = ::mount("tmpfs", place.c_str(), "tmpfs", 0, (std::string("size=") + size).c_str()) == 0;
  }
  ~SmallDisk() {
    if (mounted_) ::umount2(place_.c_str(), MNT_DETACH);
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;

  bool mounted() const { return mounted_; }
  const std::filesystem::path& path() const { return place_; }
  void fill() {
    std::ofstream out(ballast(), std::ios::binary | std::ios::app);
    const std::string page(4096, 'x');
    while (out.write(page.data(), static_cast<std::streamsize>(page.size())).flush()) {
    }
  }
  void make_room() { std::filesystem::remove(ballast()); }

 private:
  std::filesystem::path ballast() const { return place_ / "ballast"; }
  std::filesystem::path place_;
  bool mounted_ = false;
};

class FullDisk : public FaultTest {
 protected:
  // One call, without the witness's patience.
  grpc::Status submit_once(const v1::JobSpec& spec, const std::string& request_id) {
    v1::SubmitJobRequest request;
    *request.mutable_spec() = spec;
    request.set_no_reuse(true);  // each is to be run
    request.set_request_id(request_id);
    grpc::ClientContext context;
    context.set_deadline(std::chrono::system_clock::now() + seconds(10));
    v1::SubmitJobResponse response;
    const auto status = witness_->jobs(0).SubmitJob(&context, request, &response);
    if (status.ok()) witness_->watch_also(response.job().job_id());
    return status;
  }
  // The store's disk is full, twice; words: of the refusal.
  void expect_told_and_nothing_lost(Store store, const char* size, const std::string& words);

 private:
  std::optional<SmallDisk> disk_;  // goes before the scratch folder
};

void FullDisk::expect_told_and_nothing_lost(Store store, const char* size, const std::string& words) {
  std::filesystem::permissions(scratch_.path(), std::filesystem::perms::all);  // also for user postgres
  disk_.emplace(scratch_ / "disk", size);
  if (!disk_->mounted()) {
    GTEST_SKIP() << "THE FULL DISK IS NOT TESTED: a tmpfs cannot be mounted here: " << std::strerror(errno);
  }
  begin({store, 1, 0}, disk_->path());
  if (HasFatalFailure()) return;
  for (int i = 0; i < 5; ++i) witness_->submit(frame_job());

  disk_->fill();
  grpc::Status refused;
  int taken = 0;  // there may be room within the store's own files
  for (; taken < 2000; ++taken) {
    refused = submit_once(frame_job(), "full-" + std::to_string(taken));
    if (!refused.ok()) break;
  }
  EXPECT_EQ(refused.error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED) << refused.error_message();
  EXPECT_NE(refused.error_message().find(words), std::string::npos) << refused.error_message();
  // Reading goes on.
  grpc::ClientContext list_context;
  v1::ListJobsResponse page;
  EXPECT_TRUE(witness_->jobs(0).ListJobs(&list_context, v1::ListJobsRequest(), &page).ok());
  // Workers that come now find no room for their leases or results, and wait; one of them dies of it.
  for (int i = 0; i < 3; ++i) farm_->add_worker();
  pause(500, 1500);
  farm_->kill_worker(0);
  farm_->start_worker(0);
  EXPECT_TRUE(farm_->server(0)->running());

  disk_->make_room();
  EXPECT_TRUE(witness_->wait(seconds(30), [&] { return submit_once(frame_job(), "after").ok(); }));
  EXPECT_TRUE(witness_->wait_for_all(seconds(120)));

  // Once more, and the server dies while the disk is full.
  disk_->fill();
  for (int i = 0; i < 2000 && submit_once(frame_job(), "again-" + std::to_string(i)).ok(); ++i) {
  }
  farm_->kill_server(0);
  disk_->make_room();
  farm_->start_server(0);
  std::printf("%d jobs were taken on the full disk before the first was refused\n", taken);
  expect_all_well(seconds(120));
}

TEST_F(FullDisk, IsToldLosesNothingAndIsLeftBehindWhenThereIsRoom) {
  expect_told_and_nothing_lost(Store::kSqlite, "8m", "no room on the server's disk");
}

TEST_F(FullDisk, OfTheDatabaseIsToldLosesNothingAndIsLeftBehindWhenThereIsRoom) {
  expect_told_and_nothing_lost(Store::kPostgres, "24m", "no room on the database's disk");
}

}  // namespace
}  // namespace skinframe::faults
