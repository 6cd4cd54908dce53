// SPDX-License-Identifier: Apache-2.0
// The fakes behind a port of this machine, and a connection to them with a clock that does not wait.
#pragma once

#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "client/call/connect.h"
#include "tests/client/fake/fake_artifacts.h"
#include "tests/client/fake/fake_clock.h"
#include "tests/client/fake/fake_jobs.h"

namespace skinframe::fake {

class FakeServer : public testing::Test {
 protected:
  void SetUp() override {
    grpc::ServerBuilder builder;
    int port = 0;
    builder.AddListeningPort("127.0.0.1:0", grpc::InsecureServerCredentials(), &port);
    builder.RegisterService(&artifacts_);
    builder.RegisterService(&jobs_);
    server_ = builder.BuildAndStart();
    ASSERT_NE(server_, nullptr);
    address_ = "127.0.0.1:" + std::to_string(port);
    client::ConnectOptions options;
    options.address = address_;
    connection_ = *client::connect(options);
    connection_.clock = &clock_;
  }
  void TearDown() override { server_->Shutdown(); }

  FakeArtifacts artifacts_;
  FakeJobs jobs_;
  FakeClock clock_;
  client::Connection connection_;
  std::string address_;

 private:
  std::unique_ptr<grpc::Server> server_;
};

}  // namespace skinframe::fake
