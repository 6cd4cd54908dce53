// SPDX-License-Identifier: Apache-2.0
// How long calls take, by method and code, from their arrival to their status: an interceptor on every call.
// A waiting Lease and a watch take as long as they wait; they have their own methods.
#pragma once

#include <grpcpp/support/server_interceptor.h>
#include <prometheus/histogram.h>
#include <prometheus/registry.h>

#include <string>

namespace skinframe::server {

class RpcTimes final : public grpc::experimental::ServerInterceptorFactoryInterface {
 public:
  explicit RpcTimes(prometheus::Registry& registry);  // outlives this
  grpc::experimental::Interceptor* CreateServerInterceptor(grpc::experimental::ServerRpcInfo* info) override;

  void took(const std::string& method, grpc::StatusCode code, double seconds);

 private:
  prometheus::Family<prometheus::Histogram>& seconds_;
};

}  // namespace skinframe::server
