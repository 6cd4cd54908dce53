// SPDX-License-Identifier: GPL-3.0-or-later
// One attempt of one job from assignment to completion:
// fetch the mesh, write job.json, run the process, upload what it made, complete.
#pragma once

#include <stop_token>

#include "skinframe/v1/artifact.grpc.pb.h"
#include "skinframe/v1/worker.grpc.pb.h"
#include "worker/agent/agent.h"

namespace skinframe::agent {

struct ServerStubs {
  v1::WorkerService::StubInterface& worker;
  v1::ArtifactService::StubInterface& artifacts;
};

// Returns once the server knows the end, or once nobody wants to know it. Never fails: what goes wrong is how
// the attempt ended, or (a completion that does not get through) the lease's expiry on the server's side.
void run_assignment(const AgentOptions& options, const std::filesystem::path& agent_folder, ServerStubs stubs,
                    const v1::Assignment& assignment, std::stop_token worker_stop);

}  // namespace skinframe::agent
