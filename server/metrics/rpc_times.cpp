// SPDX-License-Identifier: Apache-2.0
#include "server/metrics/rpc_times.h"

#include <array>
#include <chrono>
#include <utility>

namespace skinframe::server {
namespace {

using grpc::experimental::InterceptionHookPoints;
using grpc::experimental::InterceptorBatchMethods;
using std::chrono::steady_clock;

constexpr std::array<const char*, 17> kCodes = {
    "OK",        "CANCELLED",      "UNKNOWN",           "INVALID_ARGUMENT",   "DEADLINE_EXCEEDED",
    "NOT_FOUND", "ALREADY_EXISTS", "PERMISSION_DENIED", "RESOURCE_EXHAUSTED", "FAILED_PRECONDITION",
    "ABORTED",   "OUT_OF_RANGE",   "UNIMPLEMENTED",     "INTERNAL",           "UNAVAILABLE",
    "DATA_LOSS", "UNAUTHENTICATED"};

std::string code_name(grpc::StatusCode code) {
  const auto number = static_cast<std::size_t>(code);
  return number < kCodes.size() ? kCodes[number] : "UNKNOWN";
}

prometheus::Histogram::BucketBoundaries boundaries() {
  return {0.001, 0.003, 0.01, 0.03, 0.1, 0.3, 1, 3, 10, 30};
}

class Timer final : public grpc::experimental::Interceptor {
 public:
  Timer(RpcTimes& times, std::string method) : times_(times), method_(std::move(method)) {}
  // A call that its client left before it had a status.
  ~Timer() override {
    if (!told_) tell(grpc::StatusCode::CANCELLED);
  }

  void Intercept(InterceptorBatchMethods* methods) override {
    if (!told_ && methods->QueryInterceptionHookPoint(InterceptionHookPoints::PRE_SEND_STATUS))
      tell(methods->GetSendStatus().error_code());
    methods->Proceed();
  }

 private:
  void tell(grpc::StatusCode code) {
    told_ = true;
    times_.took(method_, code, std::chrono::duration<double>(steady_clock::now() - began_).count());
  }

  RpcTimes& times_;
  const std::string method_;
  const steady_clock::time_point began_ = steady_clock::now();
  bool told_ = false;
};

}  // namespace

RpcTimes::RpcTimes(prometheus::Registry& registry)
    : seconds_(prometheus::BuildHistogram()
                   .Name("skinframe_rpc_seconds")
                   .Help("Calls by method and code, from arrival to status")
                   .Register(registry)) {}

grpc::experimental::Interceptor* RpcTimes::CreateServerInterceptor(grpc::experimental::ServerRpcInfo* info) {
  return new Timer(*this, info->method());  // gRPC deletes it with the call
}

void RpcTimes::took(const std::string& method, grpc::StatusCode code, double seconds) {
  seconds_
      .Add({{"method", method.substr(method.find_first_not_of('/'))}, {"code", code_name(code)}},
           boundaries())
      .Observe(seconds);
}

}  // namespace skinframe::server
