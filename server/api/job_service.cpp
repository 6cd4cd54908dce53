// SPDX-License-Identifier: Apache-2.0
#include "server/api/job_service.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <utility>

#include "server/api/answer.h"
#include "server/api/caller.h"
#include "server/api/spec_digest.h"
#include "server/api/spec_validation.h"
#include "server/api/watch_call.h"
#include "server/jobs/decisions.h"

namespace skinframe::server {
namespace {

constexpr int kDefaultPage = 50;
constexpr int kLargestPage = 500;
constexpr std::size_t kLargestPageBytes = std::size_t{3}
                                          << 20;  // below gRPC's default limit of 4 MiB a message

// A page token is the ordinal of the page's last job. 0: the first page; -1: not one of ours.
std::int64_t parse_page_token(const std::string& token) {
  if (token.empty()) return 0;
  std::int64_t ordinal = 0;
  const char* end = token.data() + token.size();
  const auto [at, error] = std::from_chars(token.data(), end, ordinal);
  return error == std::errc() && at == end && ordinal > 0 ? ordinal : -1;
}

}  // namespace

grpc::ServerUnaryReactor* JobService::SubmitJob(grpc::CallbackServerContext* context,
                                                const v1::SubmitJobRequest* request,
                                                v1::SubmitJobResponse* response) {
  return answer_on(parts_.executor, context, [=, this] { return submit(*context, *request, *response); });
}

absl::Status JobService::submit(grpc::CallbackServerContext& context, const v1::SubmitJobRequest& request,
                                v1::SubmitJobResponse& response) {
  const auto tenant = tenant_of(parts_, context);
  if (!tenant.ok()) return tenant.status();
  if (auto status = validate_request_id(request.request_id()); !status.ok()) return status;
  const auto catalog = parts_.catalog.current();  // one for the check and the copy
  if (auto status = validate_spec(request.spec(), *catalog); !status.ok()) return status;
  const auto artifacts = parts_.artifacts.of(*tenant);
  if (!artifacts.ok()) return artifacts.status();
  const auto input = (*artifacts)->stat(input_sha256(request.spec()));
  if (!input.ok()) return input.status();
  if (!input->complete) {
    return absl::FailedPreconditionError(fmt::format("the {} {} is not uploaded; upload it first",
                                                     input_word(request.spec()),
                                                     input_sha256(request.spec())));
  }
  JobRecord record = new_record(request, *tenant, *catalog);
  if (auto status = take_warm_start(record, **artifacts); !status.ok()) return status;
  record.reuse_key = reuse_key_of(record);
  std::optional<JobRecord> earlier;
  if (!request.no_reuse()) {
    auto found = find_reusable(record, **artifacts);
    if (!found.ok()) return found.status();
    earlier = *std::move(found);
  }
  if (request.validate_only()) {
    for (std::string& check : checks_that_hold(request.spec())) response.add_checks(std::move(check));
    if (earlier)
      response.add_checks(
          fmt::format("job {} asked for the same: its result would be reused", earlier->job.job_id()));
    return absl::OkStatus();
  }
  const Time now = parts_.clock.now();
  const Change change = earlier ? decide_reuse(std::move(record), *earlier, now, parts_.policy)
                                : decide_submit(std::move(record), now, parts_.policy);
  auto created =
      parts_.store.create(change, {parts_.queue_limit, parts_.tenants.rule_of(*tenant).most_queued});
  if (!created.ok()) return created.status();
  *response.mutable_job() = std::move(created->record.job);
  if (response.job().state() == v1::JOB_STATE_QUEUED) {
    // The job is durable whatever comes of this: a failure to count is not one to submit.
    const auto before = parts_.store.queued_before(response.job().job_id());
    if (before.ok()) response.set_queued_before(static_cast<std::int32_t>(*before));
  }
  return absl::OkStatus();
}

// An earlier job with the same outcome, all of whose files are there still. Asking for them counts as use, so
// that they stay.
absl::StatusOr<std::optional<JobRecord>> JobService::find_reusable(const JobRecord& record,
                                                                   ArtifactStore& artifacts) {
  auto earlier = parts_.store.find_reusable(record.job.tenant(), record.reuse_key);
  if (!earlier.ok() || !earlier->has_value()) return earlier;
  for (const v1::ResultFile& file : (*earlier)->job.files()) {
    const auto facts = artifacts.stat(file.sha256());
    if (!facts.ok()) return facts.status();
    if (!facts->complete) return std::optional<JobRecord>();
  }
  return earlier;
}

// The earlier job's files by their hashes, so that it may be deleted while this one waits.
absl::Status JobService::take_warm_start(JobRecord& record, ArtifactStore& artifacts) {
  const std::string& id = record.job.spec().warm_start_job_id();
  if (id.empty()) return absl::OkStatus();
  const auto earlier = parts_.store.get(id);
  absl::Status there = earlier.status();
  if (there.ok()) there = check_owner(*earlier, record.job.tenant());
  if (!there.ok())
    return absl::Status(there.code(), fmt::format("warm_start_job_id: {}", std::string(there.message())));
  if (auto status = permit_warm_start(*earlier, record.job.spec()); !status.ok()) return status;
  for (const v1::ResultFile& file : earlier->job.files()) {
    const auto facts = artifacts.stat(file.sha256());
    if (!facts.ok()) return facts.status();
    if (!facts->complete)
      return absl::FailedPreconditionError(
          fmt::format("warm_start_job_id: file {} of job {} is not there any more", file.path(), id));
    record.warm_start_files.push_back(file);
  }
  return absl::OkStatus();
}

JobRecord JobService::new_record(const v1::SubmitJobRequest& request, const std::string& tenant,
                                 const Catalog& catalog) {
  JobRecord record;
  record.job.set_tenant(tenant);
  record.request_id = request.request_id();
  record.spec_digest = digest_of(request.spec());
  record.job.set_job_id(parts_.ids.next());
  *record.job.mutable_spec() = request.spec();
  for (const v1::PrinterRequest& wanted : request.spec().printers()) {  // validated: all are known
    const v1::PrinterProfile& printer = *catalog.find_printer(wanted.printer_id());
    const std::string& material_id =
        wanted.material_id().empty() ? printer.default_material_id() : wanted.material_id();
    record.printers.push_back(printer);
    record.materials.push_back(*catalog.find_material(material_id));
    record.printers.back()
        .clear_sources();  // a worker needs the numbers alone, and each job is kept with them
    record.materials.back().clear_sources();
  }
  return record;
}

grpc::ServerUnaryReactor* JobService::GetJob(grpc::CallbackServerContext* context,
                                             const v1::GetJobRequest* request, v1::Job* response) {
  return answer_on(
      parts_.executor, context,
      [=, this]() -> absl::Status {
        const auto tenant = tenant_of(parts_, *context);
        if (!tenant.ok()) return tenant.status();
        auto record = parts_.store.get(request->job_id());
        if (!record.ok()) return record.status();
        if (auto status = check_owner(*record, *tenant); !status.ok()) return status;
        *response = std::move(record->job);
        return absl::OkStatus();
      },
      request->job_id());
}

grpc::ServerUnaryReactor* JobService::ListJobs(grpc::CallbackServerContext* context,
                                               const v1::ListJobsRequest* request,
                                               v1::ListJobsResponse* response) {
  return answer_on(parts_.executor, context, [=, this]() -> absl::Status {
    const auto tenant = tenant_of(parts_, *context);
    return tenant.ok() ? list(*tenant, *request, *response) : tenant.status();
  });
}

absl::Status JobService::list(const std::string& tenant, const v1::ListJobsRequest& request,
                              v1::ListJobsResponse& response) {
  if (request.page_size() < 0 || request.page_size() > kLargestPage) {
    return absl::InvalidArgumentError(fmt::format("page_size is {}, must be within 1 .. {}, or 0 for {}",
                                                  request.page_size(), kLargestPage, kDefaultPage));
  }
  ListQuery query;
  query.tenant = tenant;
  query.limit = request.page_size() == 0 ? kDefaultPage : request.page_size();
  query.before_ordinal = parse_page_token(request.page_token());
  if (query.before_ordinal < 0) return absl::InvalidArgumentError("page_token is not one that ListJobs gave");
  for (const int state : request.states()) {
    if (state == v1::JOB_STATE_UNSPECIFIED || !v1::JobState_IsValid(state)) {
      return absl::InvalidArgumentError(fmt::format("states has {}, which is no state", state));
    }
    if (std::find(query.states.begin(), query.states.end(), state) == query.states.end()) {
      query.states.push_back(static_cast<v1::JobState>(state));
    }
  }
  if (request.labels_size() > 16) return absl::InvalidArgumentError("labels has more than 16 entries");
  query.labels.insert(request.labels().begin(), request.labels().end());

  auto page = parts_.store.list(query);
  if (!page.ok()) return page.status();
  bool more = page->more;
  std::size_t bytes = 0;
  std::int64_t last = 0;
  for (ListPage::Entry& entry : page->entries) {
    bytes += entry.job.ByteSizeLong();
    if (last != 0 && bytes > kLargestPageBytes) {
      more = true;
      break;
    }
    last = entry.ordinal;
    *response.add_jobs() = std::move(entry.job);
  }
  if (more) response.set_next_page_token(std::to_string(last));
  return absl::OkStatus();
}

grpc::ServerUnaryReactor* JobService::CancelJob(grpc::CallbackServerContext* context,
                                                const v1::CancelJobRequest* request, v1::Job* response) {
  return answer_on(
      parts_.executor, context,
      [=, this]() -> absl::Status {
        const auto tenant = tenant_of(parts_, *context);
        if (!tenant.ok()) return tenant.status();
        const Time now = parts_.clock.now();
        auto after = parts_.store.modify(request->job_id(), [&](const JobRecord& record) -> Decision {
          if (auto status = check_owner(record, *tenant); !status.ok()) return status;
          return decide_cancel(record, now, parts_.policy);
        });
        if (after.ok()) *response = std::move(after->job);
        return after.status();
      },
      request->job_id());
}

grpc::ServerUnaryReactor* JobService::DeleteJob(grpc::CallbackServerContext* context,
                                                const v1::DeleteJobRequest* request, v1::DeleteJobResponse*) {
  return answer_on(
      parts_.executor, context,
      [=, this]() -> absl::Status {
        const auto tenant = tenant_of(parts_, *context);
        if (!tenant.ok()) return tenant.status();
        return parts_.store.remove(request->job_id(), [&](const JobRecord& record) {
          const absl::Status owned = check_owner(record, *tenant);
          return owned.ok() ? permit_delete(record) : owned;
        });
      },
      request->job_id());
}

grpc::ServerWriteReactor<v1::JobEvent>* JobService::WatchJob(grpc::CallbackServerContext* context,
                                                             const v1::WatchJobRequest* request) {
  return WatchCall::start(parts_, *context, request->job_id(), request->after_sequence());
}

}  // namespace skinframe::server
