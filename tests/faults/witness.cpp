// SPDX-License-Identifier: Apache-2.0
#include "tests/faults/witness.h"

#include <grpcpp/create_channel.h>

#include <algorithm>
#include <fstream>
#include <regex>
#include <set>

#include "server/jobs/job_id.h"

namespace skinframe::faults {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr seconds kCall{5};
constexpr seconds kWatch{20};  // then it is begun again, as after any other end
constexpr milliseconds kRest{50};
constexpr int kMostAttempts = 2400;  // some two minutes of servers that do not answer

bool is_worth_another_attempt(const grpc::Status& status) {
  switch (status.error_code()) {
    case grpc::StatusCode::UNAVAILABLE:
    case grpc::StatusCode::DEADLINE_EXCEEDED:
    case grpc::StatusCode::ABORTED:              // an upload of the same content is under way
    case grpc::StatusCode::FAILED_PRECONDITION:  // and moved on
    case grpc::StatusCode::DATA_LOSS:            // a part that was kept is of another content
    case grpc::StatusCode::RESOURCE_EXHAUSTED:
    case grpc::StatusCode::CANCELLED:
      return true;
    default:
      return false;
  }
}

}  // namespace

Witness::Witness(const std::vector<std::string>& server_addresses) {
  grpc::ChannelArguments arguments;
  arguments.SetInt(GRPC_ARG_INITIAL_RECONNECT_BACKOFF_MS, 50);
  arguments.SetInt(GRPC_ARG_MIN_RECONNECT_BACKOFF_MS, 50);
  arguments.SetInt(GRPC_ARG_MAX_RECONNECT_BACKOFF_MS, 200);
  arguments.SetInt(GRPC_ARG_KEEPALIVE_TIME_MS, 2000);
  arguments.SetInt(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, 1000);
  for (const std::string& address : server_addresses) {
    const auto channel = grpc::CreateCustomChannel(address, grpc::InsecureChannelCredentials(), arguments);
    servers_.push_back({v1::JobService::NewStub(channel), v1::ArtifactService::NewStub(channel),
                        v1::WorkerService::NewStub(channel)});
  }
}

Witness::~Witness() {
  end_.request_stop();
  std::vector<std::jthread> watches;
  {
    const std::lock_guard lock(mutex_);
    watches.swap(watches_);
  }
}

void Witness::rest() {
  std::mutex own;
  std::condition_variable_any wake;
  std::unique_lock lock(own);
  wake.wait_for(lock, end_.get_token(), kRest, [] { return false; });
}

grpc::Status Witness::insist(const std::function<grpc::Status(Server&, grpc::ClientContext&)>& attempt) {
  grpc::Status status(grpc::StatusCode::UNAVAILABLE, "not asked");
  for (int i = 0; i < kMostAttempts && !end_.stop_requested(); ++i) {
    grpc::ClientContext context;
    context.set_deadline(std::chrono::system_clock::now() + kCall);
    status = attempt(servers_[static_cast<std::size_t>(i) % servers_.size()], context);
    if (status.ok() || !is_worth_another_attempt(status)) break;
    rest();
  }
  return status;
}

std::string Witness::upload(const std::string& content) {
  const std::string sha256 = server::sha256_hex(content);
  const auto status = insist([&](Server& server, grpc::ClientContext& context) {
    v1::StatArtifactRequest ask;
    ask.set_sha256(sha256);
    v1::StatArtifactResponse stat;
    grpc::ClientContext stat_context;
    stat_context.set_deadline(std::chrono::system_clock::now() + kCall);
    if (auto asked = server.artifacts->Stat(&stat_context, ask, &stat); !asked.ok()) return asked;
    if (stat.complete()) return grpc::Status::OK;
    v1::UploadArtifactResponse response;
    const auto writer = server.artifacts->Upload(&context, &response);
    v1::UploadArtifactRequest part;
    part.mutable_header()->set_sha256(sha256);
    part.mutable_header()->set_size_bytes(static_cast<std::int64_t>(content.size()));
    part.mutable_header()->set_offset(stat.resume_offset());
    constexpr std::size_t kChunk = 256 * 1024;
    bool open = writer->Write(part);
    for (auto at = static_cast<std::size_t>(stat.resume_offset()); open && at < content.size();
         at += kChunk) {
      part.set_chunk(content.substr(at, kChunk));
      open = writer->Write(part);
    }
    writer->WritesDone();
    return writer->Finish();
  });
  if (!status.ok()) throw std::runtime_error("upload: " + status.error_message());
  return sha256;
}

std::string Witness::submit(const v1::JobSpec& spec) {
  v1::SubmitJobRequest request;
  *request.mutable_spec() = spec;
  request.set_no_reuse(true);  // each is to be run
  {
    const std::lock_guard lock(mutex_);
    request.set_request_id("witness-" + std::to_string(requests_made_++));
  }
  v1::SubmitJobResponse response;
  const auto status = insist([&](Server& server, grpc::ClientContext& context) {
    return server.jobs->SubmitJob(&context, request, &response);
  });
  if (!status.ok()) throw std::runtime_error("submit: " + status.error_message());
  const std::string id = response.job().job_id();
  watch_also(id);
  return id;
}

void Witness::watch_also(const std::string& job_id) {
  const std::lock_guard lock(mutex_);
  ++acknowledged_;
  judges_[job_id];
  watches_.emplace_back([this, job_id] { watch(end_.get_token(), job_id); });
}

void Witness::watch(std::stop_token stop, const std::string& job_id) {
  for (std::size_t turn = 0; !stop.stop_requested(); ++turn) {
    grpc::ClientContext context;
    context.set_deadline(std::chrono::system_clock::now() + kWatch);
    const std::stop_callback cancel(stop, [&] { context.TryCancel(); });
    v1::WatchJobRequest request;
    request.set_job_id(job_id);
    {
      const std::lock_guard lock(mutex_);
      request.set_after_sequence(judges_.at(job_id).last_sequence());
    }
    const auto reader = servers_[turn % servers_.size()].jobs->WatchJob(&context, request);
    v1::JobEvent event;
    while (reader->Read(&event)) {
      const std::lock_guard lock(mutex_);
      judges_.at(job_id).see(event);
      ++events_;
      notes_[job_id] += event.progress().note();
      news_.notify_all();
    }
    if (reader->Finish().ok()) return;  // the server says that this was the end
    {
      const std::lock_guard lock(mutex_);
      ++reconnections_;
    }
    rest();
  }
}

int Witness::submitted() const {
  const std::lock_guard lock(mutex_);
  return static_cast<int>(judges_.size());
}

int Witness::running_or_queued() const {
  const std::lock_guard lock(mutex_);
  return static_cast<int>(
      std::count_if(judges_.begin(), judges_.end(), [](const auto& job) { return !job.second.ended(); }));
}

bool Witness::wait(seconds at_most, const std::function<bool()>& condition) {
  const auto end = std::chrono::steady_clock::now() + at_most;
  while (!condition()) {
    std::unique_lock lock(mutex_);
    if (std::chrono::steady_clock::now() > end) return false;
    news_.wait_for(lock, milliseconds(100));
  }
  return true;
}

bool Witness::wait_for_all(seconds at_most) {
  return wait(at_most, [this] { return running_or_queued() == 0; });
}

v1::JobState Witness::state_of(const std::string& job_id) const {
  const std::lock_guard lock(mutex_);
  return judges_.at(job_id).state();
}

int Witness::attempt_of(const std::string& job_id) const {
  const std::lock_guard lock(mutex_);
  return judges_.at(job_id).attempt();
}

bool Witness::noted(const std::string& job_id, const std::string& words) const {
  const std::lock_guard lock(mutex_);
  const auto notes = notes_.find(job_id);
  return notes != notes_.end() && notes->second.find(words) != std::string::npos;
}

std::string Witness::download(const std::string& sha256) {
  std::string content;
  const auto status = insist([&](Server& server, grpc::ClientContext& context) {
    v1::DownloadArtifactRequest request;
    request.set_sha256(sha256);
    request.set_offset(static_cast<std::int64_t>(content.size()));
    const auto reader = server.artifacts->Download(&context, request);
    v1::DownloadArtifactResponse response;
    while (reader->Read(&response)) content += response.chunk();
    return reader->Finish();
  });
  return status.ok() ? content : "";
}

Verdict Witness::judge(const std::vector<std::filesystem::path>& worker_logs, const SameFile& same) {
  Verdict verdict;
  const std::regex accepted("job=([0-9a-f]{32}) attempt ([0-9]+) ended: JOB_STATE_SUCCEEDED");
  std::map<std::string, std::set<int>> acceptances;
  for (const auto& log : worker_logs) {
    std::ifstream in(log);
    for (std::string line; std::getline(in, line);)
      if (std::smatch found; std::regex_search(line, found, accepted))
        acceptances[found[1]].insert(std::stoi(found[2]));
  }
  std::map<std::string, JobJudge> judges;
  std::size_t acknowledged = 0;
  {
    const std::lock_guard lock(mutex_);
    judges = judges_;
    acknowledged = acknowledged_;
    verdict.events = events_;
    verdict.reconnections = reconnections_;
  }
  verdict.jobs = static_cast<int>(judges.size());
  if (acknowledged != judges.size())
    verdict.faults.push_back("two submissions were answered with the same job");
  std::set<std::string> sound;  // files that were looked at
  for (auto& [id, judge] : judges) {
    v1::Job job;
    const auto status = insist([&, &job_id = id](Server& server, grpc::ClientContext& context) {
      v1::GetJobRequest request;
      request.set_job_id(job_id);
      return server.jobs->GetJob(&context, request, &job);
    });
    if (!status.ok()) verdict.faults.push_back("job " + id + " is lost: " + status.error_message());
    judge.see_job(job);
    for (const int attempt : acceptances[id]) judge.see_acceptance(attempt);
    for (const std::string& fault : judge.faults()) verdict.faults.push_back("job " + id + ": " + fault);
    if (job.state() != v1::JOB_STATE_SUCCEEDED)
      verdict.faults.push_back("job " + id + " ended " + v1::JobState_Name(job.state()) + ": " +
                               job.detail());
    if (job.state() == v1::JOB_STATE_SUCCEEDED && job.files().empty())
      verdict.faults.push_back("job " + id + " has no result");
    for (const v1::ResultFile& file : job.files()) {
      if (!sound.insert(file.path() + file.sha256()).second) continue;
      const std::string content = download(file.sha256());
      if (server::sha256_hex(content) != file.sha256() || !same(file.path(), content))
        verdict.faults.push_back("job " + id + ": " + file.path() + " is not what it should be");
    }
    verdict.attempts += judge.attempt();
  }
  // Jobs that nobody was told of would be duplicates.
  int listed = 0;
  v1::ListJobsRequest request;
  request.set_page_size(500);
  do {
    v1::ListJobsResponse page;
    const auto status = insist([&](Server& server, grpc::ClientContext& context) {
      return server.jobs->ListJobs(&context, request, &page);
    });
    if (!status.ok()) verdict.faults.push_back("list: " + status.error_message());
    listed += page.jobs_size();
    request.set_page_token(page.next_page_token());
  } while (!request.page_token().empty());
  if (listed != verdict.jobs)
    verdict.faults.push_back(std::to_string(listed) + " jobs are listed, " + std::to_string(verdict.jobs) +
                             " were acknowledged");
  return verdict;
}

}  // namespace skinframe::faults
