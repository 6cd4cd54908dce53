// SPDX-License-Identifier: Apache-2.0
// The tenant that a client certificate proves, over real TLS.
#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "server/app/server.h"
#include "skinframe/v1/job.grpc.pb.h"
#include "skinframe/v1/worker.grpc.pb.h"
#include "tests/server/fixture/manual_clock.h"
#include "tests/server/fixture/temporary_folder.h"

namespace skinframe::server {
namespace {

class Identity : public testing::Test {
 protected:
  void SetUp() override {
    make("ca", "", "");
    make("server", "localhost", "ca");
    make("north", "north.example", "ca");
    make("worker", "worker.example", "ca");
    make("rogue", "", "");
    make("forged", "worker.example", "rogue");
    folder_.write("tenants.json", R"({"workers": {"identities": ["worker.example"]}, "tenants": []})");
    options_.listen = "localhost:0";
    options_.data = folder_.path() / "data";
    options_.tls_cert = folder_.path() / "server.crt";
    options_.tls_key = folder_.path() / "server.key";
    options_.client_ca = folder_.path() / "ca.crt";
    options_.tenants = folder_.path() / "tenants.json";
    auto server = Server::start(options_, clock_, ids_);
    ASSERT_TRUE(server.ok()) << server.status();
    server_ = *std::move(server);
  }

  // NAME.key and NAME.crt: an authority when issuer is empty, else signed by it for the host name.
  void make(const std::string& name, const std::string& host, const std::string& issuer) {
    const std::string at = folder_.path() / name;
    std::string command =
        "openssl req -x509 -newkey ec -pkeyopt ec_paramgen_curve:P-256 -nodes -days 2 -subj /CN=" + name +
        " -keyout " + at + ".key -out " + at + ".crt";
    if (!issuer.empty()) {
      const std::string by = folder_.path() / issuer;
      folder_.write(name + ".ext", "subjectAltName=DNS:" + host + "\nbasicConstraints=CA:FALSE\n");
      command = "openssl req -newkey ec -pkeyopt ec_paramgen_curve:P-256 -nodes -subj /CN=" + name +
                " -keyout " + at + ".key -out " + at + ".csr && openssl x509 -req -days 2 -in " + at +
                ".csr -CA " + by + ".crt -CAkey " + by + ".key -CAcreateserial -extfile " + at +
                ".ext -out " + at + ".crt";
    }
    ASSERT_EQ(std::system(("(" + command + ") >" + at + ".log 2>&1").c_str()), 0)
        << folder_.read(name + ".log");
  }

  std::shared_ptr<grpc::Channel> as(const std::string& name) {
    grpc::SslCredentialsOptions tls;
    tls.pem_root_certs = folder_.read("ca.crt");
    if (!name.empty()) {
      tls.pem_private_key = folder_.read(name + ".key");
      tls.pem_cert_chain = folder_.read(name + ".crt");
    }
    return grpc::CreateChannel(server_->address(), grpc::SslCredentials(tls));
  }

  grpc::StatusCode list(const std::string& name) {
    grpc::ClientContext context;
    context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(10));
    v1::ListJobsResponse response;
    return v1::JobService::NewStub(as(name))->ListJobs(&context, {}, &response).error_code();
  }
  grpc::StatusCode lease(const std::string& name) {
    grpc::ClientContext context;
    context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(10));
    v1::LeaseRequest request;
    request.set_worker_id("w");
    request.set_instance_id("i");
    v1::LeaseResponse response;
    return v1::WorkerService::NewStub(as(name))->Lease(&context, request, &response).error_code();
  }

  TemporaryFolder folder_;
  ManualClock clock_;
  RandomIds ids_;
  ServerOptions options_;
  std::unique_ptr<Server> server_;
};

TEST_F(Identity, ACertificateOfTheAuthorityProvesWhoCallsAndNoOtherDoes) {
  EXPECT_EQ(list("north"), grpc::StatusCode::OK);
  EXPECT_EQ(list(""), grpc::StatusCode::UNAUTHENTICATED);
  EXPECT_EQ(list("forged"), grpc::StatusCode::UNAVAILABLE);
  EXPECT_EQ(lease("worker"), grpc::StatusCode::OK);
  EXPECT_EQ(lease("north"), grpc::StatusCode::PERMISSION_DENIED);
  EXPECT_EQ(lease("forged"), grpc::StatusCode::UNAVAILABLE);
}

}  // namespace
}  // namespace skinframe::server
