// SPDX-License-Identifier: Apache-2.0
// The calls of the API as functions that keep its promises: idempotent submission, retries where the API
// allows them, one sentence when it does not work. See client/README.md for the whole in ten lines.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "client/call/connect.h"
#include "skinframe/v1/catalog.pb.h"
#include "skinframe/v1/job.pb.h"
#include "skinframe/v1/server.pb.h"

namespace skinframe::client {

// request_id empty: a new one, so that a retry never makes a second job. Waits while the queue is full, as
// long as the server asks for, a few times. kUsage, kUnreachable, kInterrupted.
Result<v1::SubmitJobResponse> submit_job(const Connection& connection, v1::SubmitJobRequest request);

Result<v1::Job> get_job(const Connection& connection, const std::string& job_id);
Result<v1::Job> cancel_job(const Connection& connection, const std::string& job_id);
Done delete_job(const Connection& connection, const std::string& job_id);

struct ListFilter {
  std::vector<v1::JobState> states;           // empty: all
  std::map<std::string, std::string> labels;  // all must match
  int limit = 50;                             // newest first; > 0
};
Result<std::vector<v1::Job>> list_jobs(const Connection& connection, const ListFilter& filter);

Result<v1::ListPrintersResponse> list_printers(const Connection& connection);
// What the server says of itself.
Result<v1::ServerInfo> server_info(const Connection& connection);
Result<v1::ListMaterialsResponse> list_materials(const Connection& connection);

}  // namespace skinframe::client
