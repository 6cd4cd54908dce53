// SPDX-License-Identifier: GPL-3.0-or-later
// The job's checkpoints as one file: what each stage kept last. The agent brings it to the server, and hands
// the newest of an earlier attempt to the next one.
//
//   WORKDIR/resume       of an earlier attempt, or absent
//   WORKDIR/checkpoint   the newest of this one, written whole under a temporary name and renamed; an event
//                        line tells of it
//
// A file of another version of the program, of another job, or that is damaged (a fingerprint over all of it)
// is refused in a note, and the job begins at its beginning. A file is written when kLeastWork has passed
// since the last one: what took less is cheaper to do again than to keep.
#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "worker/job/event_stream.h"
#include "worker/run/checkpoints.h"

namespace skinframe {

inline constexpr std::chrono::milliseconds kLeastWork{1000};
inline constexpr std::uintmax_t kMostCheckpointBytes = std::uintmax_t{64} << 20;  // the server takes no more

class CheckpointFile final : public Checkpoints {
 public:
  // Reads WORKDIR/resume; events outlives this.
  CheckpointFile(std::filesystem::path work_dir, std::string job_id, EventStream& events,
                 std::chrono::milliseconds least_work = kLeastWork);

  std::optional<std::string> find(const std::string& key) override;
  void keep(const std::string& key, const std::string& stage, std::string bytes) override;
  void used(const std::string& stage) override;
  void refused(const std::string& why) override;

  struct Entry {
    std::string key, stage, bytes;
  };

 private:
  void read_resume();
  void write(const std::string& stage);  // mutex_ held

  const std::filesystem::path work_dir_;
  const std::string job_id_;
  EventStream& events_;
  const std::chrono::milliseconds least_work_;
  std::mutex mutex_;  // printers may run side by side
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
  std::map<std::string, std::string> earlier_;  // of WORKDIR/resume, by key
  std::vector<Entry> entries_;                  // what the next file holds, oldest first
};

}  // namespace skinframe
