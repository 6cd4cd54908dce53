// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "client/call/retry.h"
#include "client/jobs/client.h"
#include "client/jobs/request_id.h"
#include "tests/client/fake/fake_server.h"

namespace skinframe::client {
namespace {

using std::chrono::milliseconds;

class SubmitJob : public fake::FakeServer {
 protected:
  void SetUp() override {
    FakeServer::SetUp();
    jobs_.job.set_job_id("j1");
  }
};

TEST_F(SubmitJob, ARetryCarriesTheSameRequestIdSoThatItMakesNoSecondJob) {
  jobs_.refusals = {{grpc::StatusCode::UNAVAILABLE, "restarting"},
                    {grpc::StatusCode::UNAVAILABLE, "restarting"}};
  const auto submitted = submit_job(connection_, {});
  ASSERT_TRUE(submitted.ok()) << submitted.failure().message;
  EXPECT_EQ(submitted->job().job_id(), "j1");
  ASSERT_EQ(jobs_.submissions.size(), 3u);
  EXPECT_FALSE(jobs_.submissions[0].request_id().empty());
  EXPECT_EQ(jobs_.submissions[0].request_id(), jobs_.submissions[2].request_id());
}

TEST_F(SubmitJob, AFullQueueIsAskedAgainAfterTheDelayThatTheServerNames) {
  jobs_.refusals = {{grpc::StatusCode::RESOURCE_EXHAUSTED, "queue full"}};
  ASSERT_TRUE(submit_job(connection_, {}).ok());
  EXPECT_THAT(clock_.waits, testing::ElementsAre(milliseconds(1234)));
}

TEST_F(SubmitJob, AServerThatIsAwayForAMomentIsGivenTheTimeItAsksFor) {
  jobs_.refusals = {{grpc::StatusCode::UNAVAILABLE, "the server stops"}};
  ASSERT_TRUE(submit_job(connection_, {}).ok());
  EXPECT_THAT(clock_.waits, testing::ElementsAre(milliseconds(1234)));
}

TEST_F(SubmitJob, AQuotaThatWaitingDoesNotMendIsToldAtOnce) {
  jobs_.refusals = {{grpc::StatusCode::RESOURCE_EXHAUSTED, "quota of artifact bytes"}};
  jobs_.name_delay = false;
  EXPECT_EQ(submit_job(connection_, {}).failure().kind, FailureKind::kUnreachable);
  EXPECT_EQ(jobs_.submissions.size(), 1u);
}

TEST_F(SubmitJob, TheTokenGoesWithEachCall) {
  connection_.token = "secret";
  ASSERT_TRUE(submit_job(connection_, {}).ok());
  EXPECT_EQ(jobs_.authorization, "Bearer secret");
}

TEST_F(SubmitJob, AQueueThatStaysFullIsUnreachable) {
  jobs_.refusals.assign(100, {grpc::StatusCode::RESOURCE_EXHAUSTED, "queue full"});
  EXPECT_EQ(submit_job(connection_, {}).failure().kind, FailureKind::kUnreachable);
}

TEST_F(SubmitJob, AWrongRequestIsNotTriedAgain) {
  jobs_.refusals = {{grpc::StatusCode::INVALID_ARGUMENT, "unknown printer teapot"}};
  const auto submitted = submit_job(connection_, {});
  ASSERT_FALSE(submitted.ok());
  EXPECT_EQ(submitted.failure().kind, FailureKind::kUsage);
  EXPECT_EQ(submitted.failure().message, "unknown printer teapot");
  EXPECT_EQ(jobs_.submissions.size(), 1u);
}

TEST_F(SubmitJob, AnUnknownJobIsNotFound) {
  EXPECT_EQ(get_job(connection_, "nobody").failure().kind, FailureKind::kNotFound);
}

TEST(Unreachable, TheSentenceNamesTheAddressAndTheRemedy) {
  ConnectOptions options;
  options.address = "127.0.0.1:1";
  Connection connection = *connect(options);
  fake::FakeClock clock;
  connection.clock = &clock;
  const auto job = get_job(connection, "j1");
  ASSERT_FALSE(job.ok());
  EXPECT_EQ(job.failure().kind, FailureKind::kUnreachable);
  EXPECT_THAT(job.failure().message,
              testing::AllOf(testing::HasSubstr("127.0.0.1:1"), testing::HasSubstr("skinframe-server")));
}

// What a server of another make may send: bounded, and never a reason to fail.
TEST(AskedDelay, IsTakenFromWellFormedDetailsAndBounded) {
  const auto asked = [](std::int64_t seconds, std::int32_t nanos) {
    v1::RetryInfo retry;
    retry.mutable_retry_delay()->set_seconds(seconds);
    retry.mutable_retry_delay()->set_nanos(nanos);
    v1::StatusDetails details;
    details.add_details()->set_type_url("type.googleapis.com/google.rpc.RetryInfo");
    details.mutable_details(0)->set_value(retry.SerializeAsString());
    return asked_delay({grpc::StatusCode::UNAVAILABLE, "", details.SerializeAsString()});
  };
  EXPECT_EQ(asked(2, 500'000'000), milliseconds(2500));
  EXPECT_EQ(asked(INT64_MAX, 999'999'999), milliseconds(30'000));
  EXPECT_EQ(asked(INT64_MIN, -1), milliseconds(0));
  EXPECT_FALSE(asked_delay({grpc::StatusCode::UNAVAILABLE, "no details"}));
  EXPECT_FALSE(asked_delay({grpc::StatusCode::UNAVAILABLE, "", "\xff no message"}));
}

TEST(RequestId, IsWhatTheApiTakesAndNeverTheSame) {
  const std::string id = new_request_id();
  EXPECT_THAT(id, testing::MatchesRegex("[0-9a-f]+"));
  EXPECT_LE(id.size(), 64u);
  EXPECT_NE(id, new_request_id());
}

}  // namespace
}  // namespace skinframe::client
