// SPDX-License-Identifier: Apache-2.0
#include "server/api/caller.h"

#include <fmt/format.h>

#include <optional>
#include <string_view>

#include "server/api/answer.h"

namespace skinframe::server {
namespace {

constexpr std::string_view kBearer = "Bearer ";

std::optional<std::string> metadata(const grpc::CallbackServerContext& context, const char* key) {
  const auto& all = context.client_metadata();
  const auto found = all.find(key);
  if (found == all.end()) return std::nullopt;
  return std::string(found->second.data(), found->second.size());
}

absl::StatusOr<Shelf> shelf(const Parts& parts, std::string tenant, bool for_a_job) {
  const auto store = parts.artifacts.of(tenant);
  if (!store.ok()) return store.status();
  return Shelf{*store, std::move(tenant), for_a_job};
}

absl::StatusOr<std::string> tenant_of_running_job(const Parts& parts, const std::string& job_id,
                                                  const std::string& token) {
  const auto record = parts.store.get(job_id);
  if (!record.ok() && !absl::IsNotFound(record.status())) return record.status();
  const bool holds = record.ok() && record->job.state() == v1::JOB_STATE_RUNNING &&
                     token == std::to_string(record->lease.fencing_token);
  if (holds) return record->job.tenant();
  return absl::AbortedError(
      fmt::format("token {} is no longer the lease of job {}; drop its results", token, job_id));
}

}  // namespace

Caller caller_of(const grpc::CallbackServerContext& context) {
  Caller caller;
  caller.peer = context.peer();
  const auto proof = context.auth_context();
  if (proof != nullptr && proof->IsPeerAuthenticated()) {
    const auto names = proof->GetPeerIdentity();
    if (!names.empty()) caller.identity.assign(names.front().data(), names.front().size());
  }
  const std::string authorization = metadata(context, "authorization").value_or("");
  if (authorization.starts_with(kBearer)) caller.token = authorization.substr(kBearer.size());
  return caller;
}

absl::StatusOr<std::string> tenant_of(const Parts& parts, const grpc::CallbackServerContext& context) {
  return parts.tenants.tenant_of(caller_of(context));
}

absl::Status permit_work(const Parts& parts, const grpc::CallbackServerContext& context) {
  return parts.tenants.permit_work(caller_of(context));
}

absl::Status check_owner(const JobRecord& record, const std::string& tenant) {
  if (record.job.tenant() == tenant) return absl::OkStatus();
  return absl::NotFoundError(fmt::format("no job \"{}\"", record.job.job_id()));
}

absl::Status Shelf::permit_upload(const Parts& parts, const std::string& sha256,
                                  std::int64_t size_bytes) const {
  const std::int64_t quota = parts.tenants.rule_of(tenant).most_artifact_bytes;
  if (for_a_job || quota == TenantRule::kNoLimit) return absl::OkStatus();
  const auto facts = store->stat(sha256);
  if (facts.ok() && facts->complete) return absl::OkStatus();
  const auto used = store->bytes_used();
  if (!used.ok()) return used.status();
  if (size_bytes <= quota - *used) return absl::OkStatus();
  return waiting_does_not_help(absl::ResourceExhaustedError(fmt::format(
      "tenant \"{}\" has {} bytes of artifacts and may have {}, its quota of artifact bytes; delete "
      "jobs that are not needed any more: their files go a day later",
      tenant, *used, quota)));
}

absl::StatusOr<Shelf> shelf_of(const Parts& parts, const grpc::CallbackServerContext& context) {
  const auto job_id = metadata(context, "skinframe-job-id");
  if (!job_id) {
    auto tenant = tenant_of(parts, context);
    if (!tenant.ok()) return tenant.status();
    return shelf(parts, *std::move(tenant), false);
  }
  if (absl::Status status = permit_work(parts, context); !status.ok()) return status;
  auto tenant =
      tenant_of_running_job(parts, *job_id, metadata(context, "skinframe-fencing-token").value_or(""));
  if (!tenant.ok()) return tenant.status();
  return shelf(parts, *std::move(tenant), true);
}

}  // namespace skinframe::server
