// SPDX-License-Identifier: Apache-2.0
// One WatchJob stream. It reads page by page from its own sequence number and writes one event at a time;
// when there is nothing more it rests until the hub wakes it. So it holds one page of memory, which it may
// share, however slow its client is, and it can neither miss nor repeat an event. Where events were thinned
// out it ends and says where it goes on: nobody takes a gap for the whole.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "server/api/parts.h"
#include "skinframe/v1/job.grpc.pb.h"

namespace skinframe::server {

class WatchCall final : public grpc::ServerWriteReactor<v1::JobEvent>,
                        public Watcher,
                        public std::enable_shared_from_this<WatchCall> {
 public:
  // The call owns itself until gRPC is done with it.
  static grpc::ServerWriteReactor<v1::JobEvent>* start(const Parts& parts,
                                                       grpc::CallbackServerContext& context,
                                                       const std::string& job_id,
                                                       std::int64_t after_sequence);

  void wake() override;
  void server_stops() override;
  void OnWriteDone(bool ok) override;
  void OnCancel() override;
  void OnDone() override;

 private:
  // Who may act: in kReading the executor's task, in kWriting gRPC's OnWriteDone, in kResting whoever comes
  // first.
  enum class Phase { kReading, kWriting, kResting, kEnded };

  WatchCall(const Parts& parts, grpc::CallbackServerContext& context, std::string job_id,
            std::int64_t after_sequence)
      : parts_(parts), context_(context), job_id_(std::move(job_id)), sequence_(after_sequence) {}

  void begin();
  void read_page();
  void write_next();
  void end_before(const v1::JobEvent& next);
  void read_later();
  void stop(const absl::Status& status);
  bool stopped();
  void end(const absl::Status& status);

  Parts parts_;
  grpc::CallbackServerContext& context_;  // there until OnDone
  const std::string job_id_;
  std::int64_t sequence_;  // of the last event written
  EventPage page_;
  std::size_t next_ = 0;  // in the page

  std::mutex mutex_;  // guards what follows
  Phase phase_ = Phase::kReading;
  bool news_ = false;                 // woken while not resting
  std::optional<absl::Status> stop_;  // the client hung up or the server stops
  std::shared_ptr<WatchCall> self_;
};

}  // namespace skinframe::server
