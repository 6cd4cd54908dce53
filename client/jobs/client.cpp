// SPDX-License-Identifier: Apache-2.0
#include "client/jobs/client.h"

#include <algorithm>

#include "client/call/retry.h"
#include "client/jobs/request_id.h"
#include "skinframe/v1/catalog.grpc.pb.h"
#include "skinframe/v1/job.grpc.pb.h"
#include "skinframe/v1/server.grpc.pb.h"

namespace skinframe::client {
namespace {

constexpr int kPageSize = 500;

// One unary call: Service::NewStub(channel)->*method, with retries on UNAVAILABLE.
template <class Response, class Stub, class Request>
Result<Response> unary(const Connection& connection, Stub& stub,
                       grpc::Status (Stub::*method)(grpc::ClientContext*, const Request&, Response*),
                       const Request& request, const RetryPolicy& policy = {}) {
  Response response;
  const grpc::Status status = call_with_retries(connection, policy, [&](grpc::ClientContext& context) {
    return (stub.*method)(&context, request, &response);
  });
  if (!status.ok()) return to_failure(status, connection);
  return response;
}

}  // namespace

Result<v1::SubmitJobResponse> submit_job(const Connection& connection, v1::SubmitJobRequest request) {
  if (request.request_id().empty()) request.set_request_id(new_request_id());
  RetryPolicy policy;
  policy.attempts = 6;
  policy.queue_full = true;
  const auto stub = v1::JobService::NewStub(connection.channel);
  return unary(connection, *stub, &v1::JobService::Stub::SubmitJob, request, policy);
}

Result<v1::Job> get_job(const Connection& connection, const std::string& job_id) {
  v1::GetJobRequest request;
  request.set_job_id(job_id);
  const auto stub = v1::JobService::NewStub(connection.channel);
  return unary(connection, *stub, &v1::JobService::Stub::GetJob, request);
}

Result<v1::Job> cancel_job(const Connection& connection, const std::string& job_id) {
  v1::CancelJobRequest request;
  request.set_job_id(job_id);
  const auto stub = v1::JobService::NewStub(connection.channel);
  return unary(connection, *stub, &v1::JobService::Stub::CancelJob, request);
}

Done delete_job(const Connection& connection, const std::string& job_id) {
  v1::DeleteJobRequest request;
  request.set_job_id(job_id);
  const auto stub = v1::JobService::NewStub(connection.channel);
  const auto response = unary(connection, *stub, &v1::JobService::Stub::DeleteJob, request);
  if (!response) return response.failure();
  return done();
}

Result<std::vector<v1::Job>> list_jobs(const Connection& connection, const ListFilter& filter) {
  const auto stub = v1::JobService::NewStub(connection.channel);
  v1::ListJobsRequest request;
  for (const v1::JobState state : filter.states) request.add_states(state);
  request.mutable_labels()->insert(filter.labels.begin(), filter.labels.end());
  std::vector<v1::Job> jobs;
  while (static_cast<int>(jobs.size()) < filter.limit) {
    request.set_page_size(std::min(kPageSize, filter.limit - static_cast<int>(jobs.size())));
    auto page = unary(connection, *stub, &v1::JobService::Stub::ListJobs, request);
    if (!page) return page.failure();
    jobs.insert(jobs.end(), page->jobs().begin(), page->jobs().end());
    if (page->next_page_token().empty() || page->next_page_token() == request.page_token()) break;
    request.set_page_token(page->next_page_token());
  }
  return jobs;
}

Result<v1::ListPrintersResponse> list_printers(const Connection& connection) {
  const auto stub = v1::CatalogService::NewStub(connection.channel);
  return unary(connection, *stub, &v1::CatalogService::Stub::ListPrinters, v1::ListPrintersRequest());
}

Result<v1::ServerInfo> server_info(const Connection& connection) {
  const auto stub = v1::ServerService::NewStub(connection.channel);
  return unary(connection, *stub, &v1::ServerService::Stub::GetServerInfo, v1::GetServerInfoRequest());
}

Result<v1::ListMaterialsResponse> list_materials(const Connection& connection) {
  const auto stub = v1::CatalogService::NewStub(connection.channel);
  return unary(connection, *stub, &v1::CatalogService::Stub::ListMaterials, v1::ListMaterialsRequest());
}

}  // namespace skinframe::client
