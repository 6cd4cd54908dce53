// SPDX-License-Identifier: Apache-2.0
// How a handler answers: its work runs on the executor, and what it returns is the call's status.
#pragma once

#include <grpcpp/grpcpp.h>

#include <functional>
#include <string_view>

#include "absl/status/status.h"
#include "server/executor/executor.h"

namespace skinframe::server {

// The codes of both are the same numbers. A message of more than 1024 bytes is cut to that. What is a defect
// of ours (INTERNAL, UNKNOWN) is logged here, with the job that the call was about; empty: about none.
// UNAVAILABLE and RESOURCE_EXHAUSTED carry RetryInfo (skinframe/v1/status.proto), but for those marked below.
grpc::Status to_grpc(const absl::Status& status, std::string_view job_id = {});

// The caller has to do something before it may try again; waiting changes nothing.
absl::Status waiting_does_not_help(absl::Status status);

// context, and the request and response that work and job_id refer to, live until the call is done.
grpc::ServerUnaryReactor* answer_on(Executor& executor, grpc::CallbackServerContext* context,
                                    std::function<absl::Status()> work, std::string_view job_id = {});

}  // namespace skinframe::server
