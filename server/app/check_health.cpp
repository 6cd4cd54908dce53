// SPDX-License-Identifier: Apache-2.0
#include "server/app/check_health.h"

#include <fmt/format.h>
#include <grpcpp/create_channel.h>
#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/security/credentials.h>
#include <grpcpp/security/tls_credentials_options.h>

#include <chrono>
#include <future>
#include <memory>
#include <vector>

namespace skinframe::server {
namespace {

constexpr std::chrono::seconds kPatience{2};  // of each of the two ways

std::shared_ptr<grpc::ChannelCredentials> believing_credentials() {
  namespace tls = grpc::experimental;
  tls::TlsChannelCredentialsOptions options;
  options.set_verify_server_certs(false);
  options.set_check_call_host(false);
  options.set_certificate_verifier(std::make_shared<tls::NoOpCertificateVerifier>());
  return tls::TlsCredentials(options);
}

// HealthCheckResponse {status: SERVING}: field 1, varint, 1. Its request is empty: the server as a whole.
bool says_serving(grpc::ByteBuffer& response) {
  grpc::Slice slice;
  if (!response.DumpToSingleSlice(&slice).ok()) return false;
  return std::string(slice.begin(), slice.end()) == std::string("\x08\x01");
}

absl::Status ask(const std::string& address, const std::shared_ptr<grpc::ChannelCredentials>& credentials) {
  grpc::GenericStub stub(grpc::CreateChannel(address, credentials));
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + kPatience);
  const grpc::Slice nothing;
  const grpc::ByteBuffer request(&nothing, 1);
  grpc::ByteBuffer response;
  std::promise<grpc::Status> done;
  stub.UnaryCall(&context, "/grpc.health.v1.Health/Check", grpc::StubOptions(), &request, &response,
                 [&](grpc::Status status) { done.set_value(std::move(status)); });
  const grpc::Status status = done.get_future().get();
  if (!status.ok())
    return absl::UnavailableError(fmt::format("{} does not answer: {}", address, status.error_message()));
  if (!says_serving(response)) return absl::UnavailableError(address + " does not serve");
  return absl::OkStatus();
}

}  // namespace

absl::Status check_health(const std::string& address) {
  const absl::Status encrypted = ask(address, believing_credentials());
  return encrypted.ok() ? encrypted : ask(address, grpc::InsecureChannelCredentials());
}

}  // namespace skinframe::server
