// SPDX-License-Identifier: Apache-2.0
#include "server/artifacts/artifact_store.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cerrno>
#include <csignal>
#include <fstream>

#include "server/artifacts/upload.h"
#include "server/jobs/job_id.h"
#include "tests/server/fixture/temporary_folder.h"

namespace skinframe::server {
namespace {

class Artifacts : public testing::Test {
 protected:
  void SetUp() override { reopen(); }
  void reopen() {
    store_ = *ArtifactStore::open(folder_.path(), {.largest_bytes = 1000, .largest_chunk_bytes = 100});
  }

  absl::Status put(const std::string& content) {
    auto upload = store_->upload(sha256_hex(content), static_cast<std::int64_t>(content.size()), 0);
    if (!upload.ok()) return upload.status();
    if (*upload == nullptr) return absl::OkStatus();
    if (auto status = (*upload)->append(content); !status.ok()) return status;
    return (*upload)->finish();
  }
  std::string content_of(const std::string& sha256) {
    auto file = store_->read(sha256);
    return file.ok() ? *file->read_at(0, 1000) : std::string(file.status().message());
  }

  TemporaryFolder folder_;
  std::unique_ptr<ArtifactStore> store_;
};

TEST_F(Artifacts, WhatWasUploadedIsReadBackAlsoAfterReopening) {
  ASSERT_TRUE(put("skin and frame").ok());
  reopen();
  const auto facts = store_->stat(sha256_hex("skin and frame"));
  EXPECT_TRUE(facts->complete);
  EXPECT_EQ(facts->size_bytes, 14);
  EXPECT_EQ(content_of(sha256_hex("skin and frame")), "skin and frame");
}

TEST_F(Artifacts, AnUnknownOneIsNotCompleteAndResumesAtZero) {
  const auto facts = store_->stat(std::string(64, '0'));
  ASSERT_TRUE(facts.ok());
  EXPECT_FALSE(facts->complete);
  EXPECT_EQ(facts->resume_offset, 0);
  EXPECT_TRUE(absl::IsNotFound(store_->read(std::string(64, '0')).status()));
}

TEST_F(Artifacts, ServersThatShareAFolderWriteAContentOneAtATime) {
  const auto other =
      *ArtifactStore::open(folder_.path(), {.largest_bytes = 1000, .largest_chunk_bytes = 100});
  const std::string name = sha256_hex("mesh");
  {
    const auto ours = store_->upload(name, 4, 0);
    ASSERT_TRUE(ours.ok());
    ASSERT_TRUE((*ours)->append("me").ok());
    EXPECT_TRUE(absl::IsAborted(other->upload(name, 4, 0).status()));
    ASSERT_TRUE((*ours)->append("sh").ok());
    ASSERT_TRUE((*ours)->finish().ok());
  }
  const auto theirs = other->upload(name, 4, 0);
  ASSERT_TRUE(theirs.ok());
  EXPECT_EQ(*theirs, nullptr);  // it is there
  EXPECT_EQ(content_of(name), "mesh");
}

TEST_F(Artifacts, NamesThatAreNoSha256NeverReachTheDisk) {
  for (const char* name :
       {"", "abc", "../../../../../../../../../../../../../../../../../../../../etc/passwd",
        "ABCDEF0000000000000000000000000000000000000000000000000000000000"}) {
    EXPECT_TRUE(absl::IsInvalidArgument(store_->stat(name).status())) << name;
    EXPECT_TRUE(absl::IsInvalidArgument(store_->upload(name, 1, 0).status())) << name;
    EXPECT_TRUE(absl::IsNotFound(store_->read(name).status())) << name;
  }
}

TEST_F(Artifacts, UploadingWhatIsThereCostsNothing) {
  ASSERT_TRUE(put("mesh").ok());
  const auto again = store_->upload(sha256_hex("mesh"), 4, 0);
  ASSERT_TRUE(again.ok());
  EXPECT_EQ(*again, nullptr);
}

TEST_F(Artifacts, AnInterruptedUploadContinuesWhereItEndedAlsoAfterReopening) {
  const std::string content = "0123456789";
  const std::string name = sha256_hex(content);
  {
    auto upload = store_->upload(name, 10, 0);
    ASSERT_TRUE((*upload)->append(content.substr(0, 6)).ok());
    EXPECT_TRUE(absl::IsInvalidArgument((*upload)->finish()));  // truncated
  }
  reopen();
  EXPECT_FALSE(store_->stat(name)->complete);
  EXPECT_EQ(store_->stat(name)->resume_offset, 6);
  EXPECT_TRUE(absl::IsFailedPrecondition(store_->upload(name, 10, 5).status()));
  auto rest = store_->upload(name, 10, 6);
  ASSERT_TRUE(rest.ok()) << rest.status();
  ASSERT_TRUE((*rest)->append(content.substr(6)).ok());
  ASSERT_TRUE((*rest)->finish().ok());
  EXPECT_EQ(content_of(name), content);
}

TEST_F(Artifacts, StartingAtZeroForgetsTheKeptPart) {
  const std::string content = "0123456789";
  const std::string name = sha256_hex(content);
  { ASSERT_TRUE((*store_->upload(name, 10, 0))->append("wrong").ok()); }
  ASSERT_TRUE(put(content).ok());
  EXPECT_EQ(content_of(name), content);
}

TEST_F(Artifacts, WrongContentIsDataLossAndNothingIsKept) {
  const std::string name = sha256_hex("right");
  {
    auto upload = store_->upload(name, 5, 0);
    ASSERT_TRUE((*upload)->append("wrong").ok());
    EXPECT_TRUE(absl::IsDataLoss((*upload)->finish()));
  }
  EXPECT_FALSE(store_->stat(name)->complete);
  EXPECT_EQ(store_->stat(name)->resume_offset, 0);
}

TEST_F(Artifacts, AKeptPartThatTheDiskDamagedIsFoundOut) {
  const std::string content = "0123456789";
  const std::string name = sha256_hex(content);
  { ASSERT_TRUE((*store_->upload(name, 10, 0))->append("01234").ok()); }
  std::ofstream(folder_.path() / "partial" / name, std::ios::binary) << "0x234";
  {
    auto rest = store_->upload(name, 10, 5);
    ASSERT_TRUE((*rest)->append("56789").ok());
    EXPECT_TRUE(absl::IsDataLoss((*rest)->finish()));
  }
  EXPECT_TRUE(put(content).ok());
}

TEST_F(Artifacts, ASecondUploadOfTheSameContentIsAbortedUntilTheFirstEnds) {
  const std::string name = sha256_hex("mesh");
  auto first = store_->upload(name, 4, 0);
  ASSERT_TRUE(first.ok());
  EXPECT_TRUE(absl::IsAborted(store_->upload(name, 4, 0).status()));
  EXPECT_TRUE(store_->upload(sha256_hex("other"), 5, 0).ok());
  first->reset();
  EXPECT_TRUE(store_->upload(name, 4, 0).ok());
}

TEST_F(Artifacts, SizesAndChunksAreBounded) {
  const std::string name(64, '0');
  EXPECT_TRUE(absl::IsInvalidArgument(store_->upload(name, 0, 0).status()));
  EXPECT_TRUE(absl::IsInvalidArgument(store_->upload(name, -1, 0).status()));
  EXPECT_TRUE(absl::IsInvalidArgument(store_->upload(name, 1001, 0).status()));
  auto upload = store_->upload(name, 50, 0);
  EXPECT_TRUE(absl::IsInvalidArgument((*upload)->append(std::string(101, 'x'))));
  EXPECT_TRUE(absl::IsInvalidArgument((*upload)->append(std::string(51, 'x'))));
}

// The file size limit of the process stands for a full disk: the same path from write() to the status.
TEST_F(Artifacts, NoRoomIsResourceExhaustedAndTheUploadResumesOnceThereIsSome) {
  const std::string content(80, 'x');
  const std::string name = sha256_hex(content);
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  {
    auto upload = store_->upload(name, 80, 0);
    ASSERT_TRUE((*upload)->append(content.substr(0, 40)).ok());
    const rlimit small{50, before.rlim_max};
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
    const absl::Status full = (*upload)->append(content.substr(40));
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
    EXPECT_TRUE(absl::IsResourceExhausted(full)) << full;
  }
  std::signal(SIGXFSZ, old_handler);
  const std::int64_t kept = store_->stat(name)->resume_offset;
  auto rest = store_->upload(name, 80, kept);
  ASSERT_TRUE((*rest)->append(content.substr(static_cast<std::size_t>(kept))).ok());
  EXPECT_TRUE((*rest)->finish().ok());
}

TEST(ErrnoStatus, AFullDiskIsResourceExhausted) {
  EXPECT_TRUE(absl::IsResourceExhausted(errno_status(ENOSPC, "f", "write")));
  EXPECT_TRUE(absl::IsResourceExhausted(errno_status(EDQUOT, "f", "write")));
  EXPECT_TRUE(absl::IsInternal(errno_status(EIO, "f", "write")));
}

}  // namespace
}  // namespace skinframe::server
