// SPDX-License-Identifier: Apache-2.0
// How a handler answers: its work runs on the executor, and what it returns is the call's status.
#pragma once

#include <grpcpp/grpcpp.h>

#include <functional>

#include "absl/status/status.h"
#include "server/executor/executor.h"

namespace skinframe::server {

// The codes of both are the same numbers. What is a defect of ours (INTERNAL, UNKNOWN) is logged here.
grpc::Status to_grpc(const absl::Status& status);

// context, and the request and response that work refers to, live until the call is done.
grpc::ServerUnaryReactor* answer_on(Executor& executor, grpc::CallbackServerContext* context,
                                    std::function<absl::Status()> work);

}  // namespace skinframe::server
