// SPDX-License-Identifier: Apache-2.0
#include <thread>

#include "skinframe/v1/server.grpc.pb.h"
#include "tests/server/api/api_fixture.h"

namespace skinframe::server {
namespace {

class ServerInfo : public ApiTest {
 protected:
  v1::ServerInfo ask() {
    grpc::ClientContext context;
    prepare(context);
    v1::ServerInfo info;
    const auto channel = grpc::CreateChannel(server_->address(), grpc::InsecureChannelCredentials());
    const grpc::Status status = v1::ServerService::NewStub(channel)->GetServerInfo(&context, {}, &info);
    EXPECT_TRUE(status.ok()) << status.error_message();
    return info;
  }
};

TEST_F(ServerInfo, SaysVersionTimeTenantRoomAndWhoWaits) {
  const v1::ServerInfo info = ask();
  EXPECT_EQ(info.version(), SKINFRAME_VERSION);
  EXPECT_EQ(from_timestamp(info.time()), clock_.now());
  EXPECT_EQ(info.tenant(), "default");
  EXPECT_EQ(info.store(), "sqlite");
  EXPECT_GT(info.artifact_bytes_free(), 0);
  EXPECT_FALSE(info.has_artifact_bytes_left());
  EXPECT_EQ(info.workers_waiting(), 0);
  std::thread worker([&] {
    grpc::ClientContext context;
    prepare(context);
    v1::LeaseRequest request;
    request.set_worker_id("w");
    request.set_instance_id("i");
    request.mutable_wait()->set_seconds(20);
    v1::LeaseResponse response;
    workers_->Lease(&context, request, &response);
  });
  while (ask().workers_waiting() == 0) std::this_thread::yield();
  EXPECT_EQ(ask().workers_waiting(), 1);
  submit();
  worker.join();
  EXPECT_EQ(ask().workers_waiting(), 0);
}

}  // namespace
}  // namespace skinframe::server
