// SPDX-License-Identifier: GPL-3.0-or-later
// The last call of an attempt: tells the server how it ended.
#pragma once

#include <stop_token>
#include <string>

#include "skinframe/v1/worker.grpc.pb.h"
#include "worker/agent/heartbeater.h"

namespace skinframe::agent {

// Until the server takes it or refuses it. Meanwhile heartbeats keep the lease, though not for ever and not
// past the agent's own end: then the lease's expiry is the bound. attempt: for the log.
void send_completion(v1::WorkerService::StubInterface& stub, const v1::CompleteRequest& completion,
                     int attempt, Heartbeater& heartbeater, const std::stop_token& worker_stop);

// "SUCCEEDED" of JOB_STATE_SUCCEEDED, "NONE" of REASON_UNSPECIFIED.
std::string word_of(const std::string& enum_name);

}  // namespace skinframe::agent
