// SPDX-License-Identifier: Apache-2.0
#include "server/api/lease_call.h"

#include "server/api/answer.h"
#include "server/api/worker_validation.h"

namespace skinframe::server {
namespace {

v1::Assignment assignment_of(const JobRecord& record, const AttemptPolicy& policy) {
  v1::Assignment assignment;
  assignment.set_job_id(record.job.job_id());
  assignment.set_fencing_token(record.lease.fencing_token);
  assignment.set_attempt(record.job.attempt());
  *assignment.mutable_spec() = record.job.spec();
  for (const auto& printer : record.printers) *assignment.add_printers() = printer;
  for (const auto& material : record.materials) *assignment.add_materials() = material;
  for (const auto& file : record.warm_start_files) *assignment.add_warm_start_files() = file;
  *assignment.mutable_heartbeat_interval() = to_duration(policy.heartbeat);
  *assignment.mutable_lease_duration() = to_duration(policy.lease);
  *assignment.mutable_lease_expire_time() = to_timestamp(record.lease.expires);
  if (record.job.has_checkpoint()) *assignment.mutable_checkpoint() = record.job.checkpoint();
  if (record.deadline) *assignment.mutable_deadline() = to_timestamp(*record.deadline);
  return assignment;
}

// Bounded before it is converted: a protobuf duration may be 10,000 years.
Milliseconds wait_of(const v1::LeaseRequest& request, const AttemptPolicy& policy) {
  if (request.wait().seconds() < 0 || request.wait().nanos() < 0) return Milliseconds(0);
  if (request.wait().seconds() > 3600) return policy.longest_wait;
  return from_duration(request.wait());
}

}  // namespace

grpc::ServerUnaryReactor* LeaseCall::start(const Parts& parts, const absl::Status& permitted,
                                           const v1::LeaseRequest& request, v1::LeaseResponse& response) {
  const std::shared_ptr<LeaseCall> call(new LeaseCall(parts, response));
  call->self_ = call;
  const absl::Status status = permitted.ok() ? validate_lease(request) : permitted;
  if (!status.ok()) {
    call->Finish(to_grpc(status));
  } else {
    call->wait_at_desk(request);
  }
  return call.get();
}

void LeaseCall::wait_at_desk(const v1::LeaseRequest& request) {
  const auto ticket =
      parts_.desk.ask(request.worker_id(), request.instance_id(), wait_of(request, parts_.policy),
                      [this](const absl::StatusOr<std::optional<JobRecord>>& leased) { answer(leased); });
  bool cancelled = false;
  {
    const std::lock_guard lock(mutex_);
    ticket_ = ticket;
    cancelled = cancelled_;
  }
  if (cancelled) parts_.desk.withdraw(ticket);
}

void LeaseCall::OnCancel() {
  LeaseDesk::Ticket ticket = 0;
  {
    const std::lock_guard lock(mutex_);
    cancelled_ = true;
    ticket = ticket_;
  }
  if (ticket != 0) parts_.desk.withdraw(ticket);
}

void LeaseCall::answer(const absl::StatusOr<std::optional<JobRecord>>& leased) {
  bool hung_up = false;
  {
    const std::lock_guard lock(mutex_);
    hung_up = cancelled_;
  }
  if (leased.ok() && leased->has_value() && hung_up) {
    parts_.desk.undelivered(**leased);
  } else if (leased.ok() && leased->has_value()) {
    *response_.mutable_assignment() = assignment_of(**leased, parts_.policy);
  }
  Finish(to_grpc(leased.status()));
}

void LeaseCall::OnDone() {
  std::shared_ptr<LeaseCall> last;
  const std::lock_guard lock(mutex_);
  last.swap(self_);
}

}  // namespace skinframe::server
