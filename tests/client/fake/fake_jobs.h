// SPDX-License-Identifier: Apache-2.0
// A JobService of one job with given events, whose watch streams break as often as a test asks for.
#pragma once

#include <grpcpp/grpcpp.h>

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <vector>

#include "skinframe/v1/job.grpc.pb.h"
#include "skinframe/v1/status.pb.h"

namespace skinframe::fake {

class FakeJobs final : public v1::JobService::Service {
 public:
  std::mutex mutex;
  v1::Job job;                             // what GetJob answers; NOT_FOUND for another id
  std::vector<v1::JobEvent> events;        // sequence 1, 2, ...
  std::vector<std::int64_t> watched_from;  // after_sequence of each stream
  grpc::StatusCode break_with = grpc::StatusCode::UNAVAILABLE;
  std::vector<std::size_t> break_after;  // events before the k-th stream breaks; none: it stays whole
  std::vector<v1::SubmitJobRequest> submissions;  // each attempt
  std::vector<grpc::Status> refusals;             // of the first submissions
  bool name_delay = true;                         // of 1.234 s, with a refusal
  std::string authorization;                      // metadata of the last submission
  bool tell_of_gaps = false;                      // where events are missing
  bool hang = false;               // watches stay open after their events, and CancelJob does not answer
  std::condition_variable called;  // with the mutex: one of the two below has risen
  int hanging_watches = 0;
  int hanging_cancels = 0;

  void add_event(v1::JobEvent event) {
    event.set_sequence(static_cast<std::int64_t>(events.size()) + 1);
    events.push_back(std::move(event));
    job.set_last_sequence(static_cast<std::int64_t>(events.size()));
  }
  void add_progress(const std::string& stage, int iteration) {
    v1::JobEvent event;
    event.mutable_progress()->set_stage(stage);
    event.mutable_progress()->set_iteration(iteration);
    add_event(event);
  }
  void add_state(v1::JobState state) {
    v1::JobEvent event;
    event.mutable_state()->set_state(state);
    job.set_state(state);
    add_event(event);
  }

  grpc::Status SubmitJob(grpc::ServerContext* context, const v1::SubmitJobRequest* request,
                         v1::SubmitJobResponse* response) override {
    const std::lock_guard lock(mutex);
    submissions.push_back(*request);
    if (const auto it = context->client_metadata().find("authorization");
        it != context->client_metadata().end())
      authorization.assign(it->second.data(), it->second.size());
    if (submissions.size() <= refusals.size()) {
      const grpc::Status& refusal = refusals[submissions.size() - 1];
      return name_delay ? with_delay(refusal) : refusal;
    }
    *response->mutable_job() = job;
    return grpc::Status::OK;
  }

  grpc::Status GetJob(grpc::ServerContext*, const v1::GetJobRequest* request, v1::Job* response) override {
    const std::lock_guard lock(mutex);
    if (request->job_id() != job.job_id())
      return {grpc::StatusCode::NOT_FOUND, "there is no job " + request->job_id()};
    *response = job;
    return grpc::Status::OK;
  }

  grpc::Status WatchJob(grpc::ServerContext* context, const v1::WatchJobRequest* request,
                        grpc::ServerWriter<v1::JobEvent>* writer) override {
    std::unique_lock lock(mutex);
    const std::size_t stream = watched_from.size();
    watched_from.push_back(request->after_sequence());
    std::size_t sent = 0;
    std::int64_t position = request->after_sequence();
    for (const v1::JobEvent& event : events) {
      if (event.sequence() <= request->after_sequence()) continue;
      if (tell_of_gaps && event.sequence() != position + 1) {
        context->AddTrailingMetadata("first-available-sequence", std::to_string(event.sequence()));
        return {grpc::StatusCode::OUT_OF_RANGE, "thinned out"};
      }
      position = event.sequence();
      if (stream < break_after.size() && sent == break_after[stream]) {
        return {break_with, "connection lost"};
      }
      writer->Write(event);
      ++sent;
    }
    if (hang) until_hung_up(*context, lock, hanging_watches);
    return grpc::Status::OK;
  }

  grpc::Status CancelJob(grpc::ServerContext* context, const v1::CancelJobRequest*, v1::Job*) override {
    std::unique_lock lock(mutex);
    if (hang) until_hung_up(*context, lock, hanging_cancels);
    return {grpc::StatusCode::UNAVAILABLE, "not now"};
  }

 private:
  // As Google's own libraries write it.
  static grpc::Status with_delay(const grpc::Status& refusal) {
    v1::RetryInfo retry;
    retry.mutable_retry_delay()->set_seconds(1);
    retry.mutable_retry_delay()->set_nanos(234'000'000);
    v1::StatusDetails details;
    details.set_code(refusal.error_code());
    details.set_message(refusal.error_message());
    details.add_details()->set_type_url(
        "type.googleapis.com/google.rpc.Help");  // some other detail before it
    details.add_details()->set_type_url("type.googleapis.com/google.rpc.RetryInfo");
    details.mutable_details(1)->set_value(retry.SerializeAsString());
    return {refusal.error_code(), refusal.error_message(), details.SerializeAsString()};
  }
  void until_hung_up(grpc::ServerContext& context, std::unique_lock<std::mutex>& lock, int& hanging) {
    ++hanging;
    called.notify_all();
    while (!context.IsCancelled()) called.wait_for(lock, std::chrono::milliseconds(5));
  }
};

}  // namespace skinframe::fake
