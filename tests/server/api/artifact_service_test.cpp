// SPDX-License-Identifier: Apache-2.0
// ArtifactService: each status that artifact.proto documents.
#include "tests/server/api/api_fixture.h"

namespace skinframe::server {
namespace {

class ArtifactServiceTest : public ApiTest {
 protected:
  grpc::StatusCode download(const std::string& sha256, std::int64_t offset, std::int64_t length,
                            std::string* content) {
    grpc::ClientContext context;
    set_deadline(context);
    v1::DownloadArtifactRequest request;
    request.set_sha256(sha256);
    request.set_offset(offset);
    request.set_length(length);
    const auto reader = artifacts_->Download(&context, request);
    v1::DownloadArtifactResponse part;
    while (reader->Read(&part)) *content += part.chunk();
    return reader->Finish().error_code();
  }
};

TEST_F(ArtifactServiceTest, ALargeArtifactGoesThereAndBackInChunks) {
  std::string content;
  for (int i = 0; i < 300'000; ++i) content += static_cast<char>(i % 251);
  ASSERT_TRUE(upload(header(content), {content.substr(0, 100'000), content.substr(100'000)}).ok());
  EXPECT_TRUE(stat(sha256_hex(content)).complete());
  std::string back;
  EXPECT_EQ(download(sha256_hex(content), 0, 0, &back), grpc::StatusCode::OK);
  EXPECT_TRUE(back == content);
  std::string part;
  EXPECT_EQ(download(sha256_hex(content), 299'990, 5, &part), grpc::StatusCode::OK);
  EXPECT_EQ(part, content.substr(299'990, 5));
}

TEST_F(ArtifactServiceTest, StatNeedsASha256AndNeverSaysNotFound) {
  EXPECT_FALSE(stat(std::string(64, '0')).complete());
  stat("abc", grpc::StatusCode::INVALID_ARGUMENT);
}

TEST_F(ArtifactServiceTest, AnInterruptedUploadResumes) {
  const std::string content = "0123456789";
  EXPECT_EQ(upload(header(content), {"01234"}).error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  const std::int64_t kept = stat(sha256_hex(content)).resume_offset();
  EXPECT_EQ(kept, 5);
  EXPECT_EQ(upload(header(content, 3), {"3456789"}).error_code(), grpc::StatusCode::FAILED_PRECONDITION);
  EXPECT_TRUE(upload(header(content, kept), {"56789"}).ok());
}

TEST_F(ArtifactServiceTest, WrongContentIsDataLoss) {
  EXPECT_EQ(upload(header("right"), {"wrong"}).error_code(), grpc::StatusCode::DATA_LOSS);
  EXPECT_EQ(stat(sha256_hex("right")).resume_offset(), 0);
}

TEST_F(ArtifactServiceTest, MissingHeadersAndOversizeAreInvalidArguments) {
  grpc::ClientContext context;
  set_deadline(context);
  v1::UploadArtifactResponse response;
  const auto writer = artifacts_->Upload(&context, &response);
  v1::UploadArtifactRequest chunk;
  chunk.set_chunk("x");
  writer->Write(chunk);
  EXPECT_EQ(writer->Finish().error_code(), grpc::StatusCode::INVALID_ARGUMENT);

  auto too_large = header("x");
  too_large.set_size_bytes((std::int64_t{2} << 30) + 1);
  EXPECT_EQ(upload(too_large, {}).error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  const std::string wide((1 << 20) + 1, 'x');
  EXPECT_EQ(upload(header(wide), {wide}).error_code(), grpc::StatusCode::INVALID_ARGUMENT);
}

TEST_F(ArtifactServiceTest, ASecondUploadOfTheSameContentIsAborted) {
  grpc::ClientContext context;
  set_deadline(context);
  v1::UploadArtifactResponse response;
  const auto first = artifacts_->Upload(&context, &response);
  v1::UploadArtifactRequest message;
  *message.mutable_header() = header("0123456789");
  ASSERT_TRUE(first->Write(message));
  message.set_chunk("01234");
  ASSERT_TRUE(first->Write(message));
  while (stat(sha256_hex("0123456789")).resume_offset() < 5) {
  }  // until the server has the chunk: bounded by the deadline of the call
  EXPECT_EQ(upload(header("0123456789"), {"0123456789"}).error_code(), grpc::StatusCode::ABORTED);
  message.set_chunk("56789");
  ASSERT_TRUE(first->Write(message));
  first->WritesDone();
  EXPECT_TRUE(first->Finish().ok());
}

TEST_F(ArtifactServiceTest, UploadingAgainIsOk) {
  put("mesh");
  EXPECT_TRUE(upload(header("mesh"), {"mesh"}).ok());
}

TEST_F(ArtifactServiceTest, DownloadRefusesWhatIsNotThere) {
  std::string content;
  EXPECT_EQ(download(std::string(64, '0'), 0, 0, &content), grpc::StatusCode::NOT_FOUND);
  EXPECT_EQ(download("abc", 0, 0, &content), grpc::StatusCode::NOT_FOUND);
  const std::string name = put("mesh");
  EXPECT_EQ(download(name, 5, 0, &content), grpc::StatusCode::OUT_OF_RANGE);
  EXPECT_EQ(download(name, 4, 0, &content), grpc::StatusCode::OK);
  EXPECT_TRUE(content.empty());
}

}  // namespace
}  // namespace skinframe::server
