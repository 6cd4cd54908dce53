// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/queue/service_times.h"

#include <fmt/format.h>
#include <grpcpp/grpcpp.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <future>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <vector>

#include "server/app/server.h"
#include "skinframe/v1/artifact.grpc.pb.h"
#include "skinframe/v1/job.grpc.pb.h"
#include "skinframe/v1/worker.grpc.pb.h"

namespace skinframe::bench {
namespace {

using SteadyClock = std::chrono::steady_clock;

constexpr int kStreamsOfAConnection = 500;
constexpr char kMesh[] = "a mesh";

double ms_since(SteadyClock::time_point begin) {
  return std::chrono::duration<double, std::milli>(SteadyClock::now() - begin).count();
}

void check(const grpc::Status& status, const char* what) {
  if (!status.ok()) throw std::runtime_error(std::string(what) + ": " + status.error_message());
}

Spread spread_of(std::vector<double> times) {
  std::sort(times.begin(), times.end());
  const auto at = [&](std::size_t percent) {
    return times[std::min(times.size() - 1, times.size() * percent / 100)];
  };
  return {at(50), at(95), at(99)};
}

class Service {
 public:
  explicit Service(const server::ServerOptions& options) {
    auto started = server::Server::start(options, clock_, ids_);
    if (!started.ok()) throw std::runtime_error(std::string(started.status().message()));
    server_ = *std::move(started);
    const auto channel = connection(0);
    jobs = v1::JobService::NewStub(channel);
    workers = v1::WorkerService::NewStub(channel);
    upload_mesh(*v1::ArtifactService::NewStub(channel));
  }

  // Connections of one number are one.
  std::shared_ptr<grpc::Channel> connection(int number) const {
    grpc::ChannelArguments arguments;
    arguments.SetInt("skinframe-bench-connection", number);
    return grpc::CreateCustomChannel(server_->address(), grpc::InsecureChannelCredentials(), arguments);
  }

  std::string submit() {
    grpc::ClientContext context;
    v1::SubmitJobRequest request;
    request.set_no_reuse(true);
    request.mutable_spec()->set_mesh_sha256(server::sha256_hex(kMesh));
    request.mutable_spec()->add_printers()->set_printer_id("sinterstation-hiq");
    v1::SubmitJobResponse response;
    check(jobs->SubmitJob(&context, request, &response), "submit");
    return response.job().job_id();
  }
  v1::Assignment lease() {
    for (;;) {
      grpc::ClientContext context;
      v1::LeaseRequest request;
      request.set_worker_id("bench");
      request.set_instance_id("bench");
      request.mutable_wait()->set_seconds(30);
      v1::LeaseResponse response;
      check(workers->Lease(&context, request, &response), "lease");
      if (response.has_assignment()) return response.assignment();
    }
  }
  void beat(const v1::Assignment& work, int iteration) {
    grpc::ClientContext context;
    v1::HeartbeatRequest request;
    request.set_job_id(work.job_id());
    request.set_fencing_token(work.fencing_token());
    request.add_progress()->set_iteration(iteration);
    v1::HeartbeatResponse response;
    check(workers->Heartbeat(&context, request, &response), "heartbeat");
  }
  void complete(const v1::Assignment& work) {
    grpc::ClientContext context;
    v1::CompleteRequest request;
    request.set_job_id(work.job_id());
    request.set_fencing_token(work.fencing_token());
    request.set_state(v1::JOB_STATE_SUCCEEDED);
    v1::CompleteResponse response;
    check(workers->Complete(&context, request, &response), "complete");
  }

  std::unique_ptr<v1::JobService::Stub> jobs;
  std::unique_ptr<v1::WorkerService::Stub> workers;

 private:
  static void upload_mesh(v1::ArtifactService::Stub& artifacts) {
    grpc::ClientContext context;
    v1::UploadArtifactResponse response;
    const auto writer = artifacts.Upload(&context, &response);
    v1::UploadArtifactRequest part;
    part.mutable_header()->set_sha256(server::sha256_hex(kMesh));
    part.mutable_header()->set_size_bytes(sizeof kMesh - 1);
    writer->Write(part);
    part.set_chunk(kMesh);
    writer->Write(part);
    writer->WritesDone();
    check(writer->Finish(), "upload");
  }

  server::SystemClock clock_;
  server::RandomIds ids_;
  std::unique_ptr<server::Server> server_;
};

// How many watchers have seen which event.
class Tally {
 public:
  void saw(std::int64_t sequence) {
    const std::lock_guard lock(mutex_);
    newest_ = std::max(newest_, sequence);
    if (sequence == wanted_ && ++count_ == watchers_) done_.notify_all();
  }
  void expect(std::int64_t sequence, int watchers) {
    const std::lock_guard lock(mutex_);
    wanted_ = sequence;
    watchers_ = watchers;
    count_ = 0;
  }
  void failed(const grpc::Status& status) {
    const std::lock_guard lock(mutex_);
    failure_ = status;
    done_.notify_all();
  }
  void wait() {
    std::unique_lock lock(mutex_);
    const bool woken =
        done_.wait_for(lock, std::chrono::minutes(1), [&] { return count_ == watchers_ || !failure_.ok(); });
    check(failure_, "watch");
    if (!woken)
      throw std::runtime_error(
          fmt::format("after a minute {} of {} watchers have event {}", count_, watchers_, wanted_));
  }

 private:
  std::mutex mutex_;
  std::condition_variable done_;
  std::int64_t wanted_ = 0;
  std::int64_t newest_ = 0;
  int watchers_ = 0;
  int count_ = 0;
  grpc::Status failure_;
};

class WatchStream final : public grpc::ClientReadReactor<v1::JobEvent> {
 public:
  WatchStream(v1::JobService::Stub& stub, const v1::WatchJobRequest& request, Tally& tally)
      : tally_(tally), request_(request) {
    stub.async()->WatchJob(&context_, &request_, this);
    StartRead(&event_);
    StartCall();
  }
  ~WatchStream() override {
    context_.TryCancel();
    ended_->get_future().wait();
  }
  void OnReadDone(bool ok) override {
    if (!ok) return;
    tally_.saw(event_.sequence());
    StartRead(&event_);
  }
  void OnDone(const grpc::Status& status) override {
    if (!status.ok() && status.error_code() != grpc::StatusCode::CANCELLED) tally_.failed(status);
    const auto ended = ended_;  // the stream may be gone before set_value is back
    ended->set_value();
  }

 private:
  Tally& tally_;
  grpc::ClientContext context_;
  v1::WatchJobRequest request_;
  v1::JobEvent event_;
  const std::shared_ptr<std::promise<void>> ended_ = std::make_shared<std::promise<void>>();
};

}  // namespace

Spread measure_pick_up(const server::ServerOptions& options, int jobs) {
  Service service(options);
  std::vector<double> times;
  for (int i = 0; i < jobs; ++i) {
    SteadyClock::time_point has_it;
    v1::Assignment work;
    std::thread worker([&] {
      work = service.lease();
      has_it = SteadyClock::now();
    });
    std::this_thread::sleep_for(std::chrono::milliseconds(20));  // idle: the worker waits at the desk
    const auto begin = SteadyClock::now();
    service.submit();
    worker.join();
    times.push_back(std::chrono::duration<double, std::milli>(has_it - begin).count());
    service.complete(work);
  }
  return spread_of(std::move(times));
}

Broadcast measure_watchers(const server::ServerOptions& options, int watchers, int events) {
  Service service(options);
  v1::WatchJobRequest request;
  request.set_job_id(service.submit());
  const v1::Assignment work = service.lease();  // events 1 and 2
  Tally tally;
  tally.expect(2, watchers);
  std::vector<std::unique_ptr<v1::JobService::Stub>> stubs;
  std::vector<std::unique_ptr<WatchStream>> streams;
  for (int i = 0; i < watchers; ++i) {
    if (i % kStreamsOfAConnection == 0)
      stubs.push_back(v1::JobService::NewStub(service.connection(1 + i / kStreamsOfAConnection)));
    streams.push_back(std::make_unique<WatchStream>(*stubs.back(), request, tally));
  }
  tally.wait();
  std::vector<double> times;
  for (int i = 0; i < events; ++i) {
    tally.expect(3 + i, watchers);
    const auto begin = SteadyClock::now();
    service.beat(work, i);
    tally.wait();
    times.push_back(ms_since(begin));
  }
  return {spread_of(std::move(times)), watchers};
}

}  // namespace skinframe::bench
