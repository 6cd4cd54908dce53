// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "client/transfer/download.h"
#include "client/transfer/upload.h"
#include "proto/transport/sha256.h"
#include "tests/client/fake/fake_server.h"
#include "tests/fixture/temporary_folder.h"

namespace skinframe::client {
namespace {

std::string sha256(const std::string& content) {
  transport::Sha256 hash;
  hash.add(content);
  return hash.hex();
}

class Transfer : public fake::FakeServer {
 protected:
  v1::Job job_with(const std::string& path, const std::string& content) {
    artifacts_.complete[sha256(content)] = content;
    v1::Job job;
    v1::ResultFile* file = job.add_files();
    file->set_path(path);
    file->set_sha256(sha256(content));
    file->set_size_bytes(static_cast<std::int64_t>(content.size()));
    return job;
  }
  test::TemporaryFolder folder_;
};

TEST_F(Transfer, AnInterruptedUploadGoesOnWhereItStopped) {
  const std::string mesh(900'000, 'm');
  artifacts_.break_upload_after = 300'000;
  const auto digest = upload_input(connection_, folder_.write("mesh.stl", mesh));
  ASSERT_TRUE(digest.ok()) << digest.failure().message;
  ASSERT_EQ(artifacts_.upload_offsets.size(), 2u);
  EXPECT_GE(artifacts_.upload_offsets[1], 300'000);
  EXPECT_EQ(artifacts_.complete[sha256(mesh)], mesh);
}

TEST_F(Transfer, AKeptPartOfAnotherContentIsSentOnceMoreFromTheBeginning) {
  const std::string mesh(1'000, 'm');
  artifacts_.hash = sha256;
  artifacts_.partial[sha256(mesh)] = std::string(300, 'x');
  const auto digest = upload_input(connection_, folder_.write("mesh.stl", mesh));
  ASSERT_TRUE(digest.ok()) << digest.failure().message;
  EXPECT_EQ(artifacts_.upload_offsets, (std::vector<std::int64_t>{300, 0}));
  EXPECT_EQ(artifacts_.complete[sha256(mesh)], mesh);
}

TEST_F(Transfer, AContentThatIsLostFromTheBeginningIsNotSentAgain) {
  artifacts_.hash = [](const std::string&) { return std::string("another"); };
  const auto digest = upload_input(connection_, folder_.write("mesh.stl", "mesh"));
  ASSERT_FALSE(digest.ok());
  EXPECT_EQ(digest.failure().kind, FailureKind::kInput);
  EXPECT_EQ(artifacts_.upload_offsets.size(), 1u);
}

TEST_F(Transfer, WhatTheServerHasIsNotSentAgain) {
  artifacts_.complete[sha256("mesh")] = "mesh";
  ASSERT_TRUE(upload_input(connection_, folder_.write("mesh.stl", "mesh")).ok());
  EXPECT_TRUE(artifacts_.upload_offsets.empty());
}

TEST_F(Transfer, AMeshFileThatCannotBeReadIsToldInOneSentence) {
  EXPECT_EQ(upload_input(connection_, folder_.path() / "none.stl").failure().kind, FailureKind::kInput);
  EXPECT_THAT(upload_input(connection_, folder_.path() / "none.stl").failure().message,
              testing::HasSubstr("none.stl"));
  EXPECT_EQ(upload_input(connection_, folder_.path()).failure().kind, FailureKind::kInput);
  EXPECT_THAT(upload_input(connection_, folder_.write("empty.stl", "")).failure().message,
              testing::HasSubstr("is empty"));
}

TEST_F(Transfer, AnInterruptedDownloadGoesOnWhereItStopped) {
  std::string content;
  for (int i = 0; i < 30'000; ++i) content += std::to_string(i);
  artifacts_.break_download_after = 50'000;
  const auto files =
      download_results(connection_, job_with("p/skin-frame.stl", content), folder_.path() / "out");
  ASSERT_TRUE(files.ok()) << files.failure().message;
  EXPECT_EQ(artifacts_.download_offsets, (std::vector<std::int64_t>{0, 50'000}));
  EXPECT_EQ(folder_.read("out/p/skin-frame.stl"), content);
}

TEST_F(Transfer, ADamagedFileNeverAppearsUnderItsName) {
  v1::Job job = job_with("report.json", "report");
  artifacts_.complete[job.files(0).sha256()] = "REPORT";
  const auto files = download_results(connection_, job, folder_.path() / "out");
  ASSERT_FALSE(files.ok());
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path() / "out"));
}

TEST_F(Transfer, AServerThatSendsWithoutEndIsCutOff) {
  v1::Job job = job_with("report.json", std::string(100'000, 'x'));
  job.mutable_files(0)->set_size_bytes(10);
  EXPECT_FALSE(download_results(connection_, job, folder_.path() / "out").ok());
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path() / "out"));
}

TEST_F(Transfer, APathThatLeadsOutWritesNothingAtAll) {
  v1::Job job = job_with("report.json", "report");
  job.add_files()->set_path("../evil");
  const auto files = download_results(connection_, job, folder_.path() / "out");
  ASSERT_FALSE(files.ok());
  EXPECT_EQ(files.failure().kind, FailureKind::kInternal);
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "out"));
}

TEST_F(Transfer, AFolderThatCannotBeMadeIsALocalFailure) {
  folder_.write("file", "x");
  const auto files =
      download_results(connection_, job_with("report.json", "report"), folder_.path() / "file" / "out");
  ASSERT_FALSE(files.ok());
  EXPECT_EQ(files.failure().kind, FailureKind::kLocal);
}

TEST_F(Transfer, AnArtifactThatIsGoneIsNotFound) {
  v1::Job job = job_with("report.json", "report");
  artifacts_.complete.clear();
  EXPECT_EQ(download_results(connection_, job, folder_.path() / "out").failure().kind,
            FailureKind::kNotFound);
}

}  // namespace
}  // namespace skinframe::client
