// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/agent/artifact_transfer.h"

#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/client/fake/fake_artifacts.h"
#include "tests/fixture/temporary_folder.h"

namespace skinframe::agent {
namespace {

std::string sha256(const std::string& content) {
  transport::Sha256 hash;
  hash.add(content);
  return hash.hex();
}

class ArtifactTransfer : public testing::Test {
 protected:
  void SetUp() override {
    int port = 0;
    grpc::ServerBuilder builder;
    builder.AddListeningPort("127.0.0.1:0", grpc::InsecureServerCredentials(), &port);
    builder.RegisterService(&artifacts_);
    server_ = builder.BuildAndStart();
    ASSERT_NE(server_, nullptr);
    stub_ = v1::ArtifactService::NewStub(
        grpc::CreateChannel("127.0.0.1:" + std::to_string(port), grpc::InsecureChannelCredentials()));
  }

  test::TemporaryFolder folder_;
  fake::FakeArtifacts artifacts_;
  std::unique_ptr<grpc::Server> server_;
  std::unique_ptr<v1::ArtifactService::Stub> stub_;
};

TEST_F(ArtifactTransfer, InterruptedTransfersGoOnWhereTheyStopped) {
  const std::string big(600'000, 'x');
  const std::filesystem::path file = folder_.path() / "big";
  std::ofstream(file) << big;
  const auto digest = digest_file(file);
  ASSERT_TRUE(digest.ok());
  artifacts_.break_upload_after = 300'000;
  artifacts_.break_download_after = 300'000;
  ASSERT_TRUE(upload_artifact(*stub_, file, *digest, {}).ok());
  ASSERT_EQ(artifacts_.upload_offsets.size(), 2u);
  EXPECT_GT(artifacts_.upload_offsets[1], 0);
  EXPECT_EQ(artifacts_.complete[digest->sha256], big);
  ASSERT_TRUE(download_artifact(*stub_, digest->sha256, folder_.path() / "back", {}).ok());
  EXPECT_EQ(artifacts_.download_offsets, (std::vector<std::int64_t>{0, 300'000}));
  EXPECT_EQ(std::filesystem::file_size(folder_.path() / "back"), big.size());
}

TEST_F(ArtifactTransfer, AKeptPartOfAnotherContentIsSentOnceMoreFromTheBeginning) {
  const std::string result(1'000, 'r');
  artifacts_.partial[sha256(result)] = std::string(300, 'x');
  const std::filesystem::path file = folder_.path() / "result";
  std::ofstream(file) << result;
  const auto digest = digest_file(file);
  artifacts_.hash = sha256;
  ASSERT_TRUE(upload_artifact(*stub_, file, *digest, {}).ok());
  EXPECT_EQ(artifacts_.upload_offsets, (std::vector<std::int64_t>{300, 0}));
  EXPECT_EQ(artifacts_.complete[digest->sha256], result);
  artifacts_.complete.clear();
  artifacts_.upload_offsets.clear();
  artifacts_.partial[digest->sha256] = "x";
  artifacts_.hash = [](const std::string&) { return std::string("another"); };
  EXPECT_EQ(upload_artifact(*stub_, file, *digest, {}).error_code(), grpc::StatusCode::DATA_LOSS);
  EXPECT_EQ(artifacts_.upload_offsets, (std::vector<std::int64_t>{1, 0}));
}

TEST_F(ArtifactTransfer, AMeshWithAnotherContentIsRefused) {
  const std::string name = sha256("mesh");
  artifacts_.complete[name] = "no mesh";
  EXPECT_EQ(download_artifact(*stub_, name, folder_.path() / "back", {}).error_code(),
            grpc::StatusCode::DATA_LOSS);
}

}  // namespace
}  // namespace skinframe::agent
