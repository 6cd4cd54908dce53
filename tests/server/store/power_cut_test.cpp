// SPDX-License-Identifier: Apache-2.0
// What the SQLite store acknowledged is there after the power failed, wherever it failed: between two writes,
// in the midst of one, before a sync, while the log goes back into the database, while the file is made. A
// disk whose syncs do nothing must be found out by the same judge.
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <map>
#include <mutex>
#include <random>
#include <thread>

#include "server/store/sqlite_database.h"
#include "server/store/sqlite_store.h"
#include "tests/server/fixture/example_job.h"
#include "tests/server/fixture/power_cut_disk.h"
#include "tests/server/fixture/temporary_folder.h"

namespace skinframe::server {
namespace {

namespace fs = std::filesystem;

const AttemptPolicy kPolicy;
constexpr char kFile[] = "jobs.sqlite";
constexpr int kJobs = 32;  // of one life: enough for the log to go back into the database more than once
constexpr int kBeats = 3;
constexpr unsigned kOperationsPerCut = 24;

struct Acknowledged {
  std::int64_t last_sequence = 0;
  int beats = 0;
  bool completed = false;
  bool maybe_removed = false;
  bool removed = false;
};

// What callers were told. A copy taken at a cut is what must be there afterwards.
struct Promises {
  std::map<std::string, Acknowledged> jobs;
  std::int64_t fencing_token = 0;
};

class Ledger {
 public:
  explicit Ledger(Promises kept) : promises_(std::move(kept)) {}
  template <class Change>
  void note(Change change) {
    const std::lock_guard lock(mutex_);
    change(promises_);
  }
  Promises copy() const {
    const std::lock_guard lock(mutex_);
    return promises_;
  }

 private:
  mutable std::mutex mutex_;
  Promises promises_;
};

std::string digest_of(const std::string& job_id) { return job_id + "-result"; }

void note_record(Ledger& ledger, const JobRecord& record) {
  ledger.note([&](Promises& promises) {
    Acknowledged& job = promises.jobs[record.job.job_id()];
    job.last_sequence = std::max(job.last_sequence, record.job.last_sequence());
    promises.fencing_token = std::max(promises.fencing_token, record.lease.fencing_token);
  });
}

// Submits a job, takes some job, brings it to its end, and sometimes forgets it.
void one_job(JobStore& store, Ledger& ledger, const std::string& job_id, bool remove) {
  const auto created = store.create(example_job(job_id), 1'000'000);
  ASSERT_TRUE(created.ok()) << created.status();
  note_record(ledger, created->record);
  const auto taken =
      store.lease_next(kNoon, [](const JobRecord& job, std::int64_t token) { return leased(job, token); });
  ASSERT_TRUE(taken.ok() && taken->has_value()) << taken.status();
  note_record(ledger, **taken);
  const std::string own = (*taken)->job.job_id();
  const std::int64_t token = (*taken)->lease.fencing_token;
  for (int beat = 1; beat <= kBeats; ++beat) {
    auto request = heartbeat(own, token);
    request.add_progress()->set_iteration(beat);
    const auto beaten = store.modify(
        own, [&](const JobRecord& job) { return decide_heartbeat(job, request, kNoon, kPolicy); });
    ASSERT_TRUE(beaten.ok()) << beaten.status();
    note_record(ledger, *beaten);
    ledger.note([&](Promises& promises) { promises.jobs[own].beats = beat; });
  }
  auto request = completion(own, token, v1::JOB_STATE_SUCCEEDED);
  request.add_files()->set_sha256(digest_of(own));
  const auto completed =
      store.modify(own, [&](const JobRecord& job) { return decide_complete(job, request, kNoon, kPolicy); });
  ASSERT_TRUE(completed.ok()) << completed.status();
  note_record(ledger, *completed);
  ledger.note([&](Promises& promises) { promises.jobs[own].completed = true; });
  if (!remove) return;
  ledger.note([&](Promises& promises) { promises.jobs[own].maybe_removed = true; });
  ASSERT_TRUE(store.remove(own, permit_delete).ok());
  ledger.note([&](Promises& promises) { promises.jobs[own].removed = true; });
}

std::string fault_of(JobStore& store, const std::string& job_id, const Acknowledged& promised) {
  const auto record = store.get(job_id);
  if (absl::IsNotFound(record.status())) return promised.maybe_removed ? "" : "job " + job_id + " is lost";
  if (!record.ok()) return std::string(record.status().message());
  if (promised.removed) return "job " + job_id + " was removed and is back";
  if (record->job.last_sequence() < promised.last_sequence) return "events of job " + job_id + " are lost";
  if (promised.completed &&
      (record->job.state() != v1::JOB_STATE_SUCCEEDED || record->job.files_size() != 1 ||
       record->job.files(0).sha256() != digest_of(job_id)))
    return "the result of job " + job_id + " is lost";
  const auto events = store.events(job_id, 0, 1000);
  if (!events.ok()) return std::string(events.status().message());
  std::int64_t sequence = 0;
  int beats = 0;
  for (const v1::JobEvent& event : *events) {
    if (event.sequence() != ++sequence) return "the events of job " + job_id + " have a gap";
    if (event.has_progress() && event.progress().iteration() != ++beats)
      return "the progress of job " + job_id + " is out of order";
  }
  if (sequence != record->job.last_sequence()) return "job " + job_id + " and its events differ";
  return beats < promised.beats ? "progress of job " + job_id + " is lost" : "";
}

// The first promise that the store in the folder does not keep; empty: it keeps all and goes on.
std::string first_fault(const fs::path& folder, const Promises& promised) {
  {
    const auto store = open_sqlite_store(folder / kFile, nullptr);
    if (!store.ok()) return std::string(store.status().message());
    for (const auto& [job_id, job] : promised.jobs) {
      if (std::string fault = fault_of(**store, job_id, job); !fault.empty()) return fault;
    }
    if (const auto created = (*store)->create(example_job("after"), 1'000'000); !created.ok())
      return std::string(created.status().message());
    const auto next = (*store)->lease_next(
        kNoon, [](const JobRecord& job, std::int64_t token) { return leased(job, token); });
    if (!next.ok()) return std::string(next.status().message());
    if (!next->has_value() || (*next)->lease.fencing_token <= promised.fencing_token)
      return "a fencing token is given twice";
  }
  const auto database = SqliteDatabase::open(folder / kFile, SqliteDatabase::Mode::kReadWrite);
  if (!database.ok()) return std::string(database.status().message());
  SqliteStatement check(**database, "PRAGMA integrity_check");
  if (!check.step()) return std::string(check.status().message());
  return check.bytes(0) == "ok" ? "" : check.bytes(0);
}

struct Cut {
  fs::path image;
  Promises promised;
};

// Runs a store in `folder` over a disk of this kind, and leaves an image for each of the cuts that the seed
// drew.
std::vector<Cut> live(const fs::path& folder, const Promises& kept, PowerCutDisk::Syncs syncs, unsigned seed,
                      int threads) {
  std::vector<Cut> cuts;
  Ledger ledger(kept);
  std::mt19937_64 random(seed);
  PowerCutDisk* under = nullptr;
  PowerCutDisk disk(syncs, [&] {
    if (random() % kOperationsPerCut != 0) return;
    // The promises first: what is acknowledged while the image is made need not be in it.
    Cut cut{folder.string() + "-cut-" + std::to_string(cuts.size()), ledger.copy()};
    under->image(cut.image, random);
    cuts.push_back(std::move(cut));
  });
  under = &disk;
  auto store = open_sqlite_store(folder / kFile, nullptr);
  EXPECT_TRUE(store.ok()) << store.status();
  if (!store.ok()) return {};
  std::vector<std::jthread> callers;
  for (int caller = 0; caller < threads; ++caller) {
    callers.emplace_back([&, caller] {
      for (int i = caller; i < kJobs; i += threads)
        one_job(**store, ledger, "job-" + std::to_string(seed) + "-" + std::to_string(i), i % 7 == 3);
    });
  }
  callers.clear();
  store->reset();  // closing writes too: cuts must not be on its way out yet
  return cuts;
}

struct Verdict {
  int cuts = 0;
  std::size_t promised_jobs = 0;
  std::vector<std::string> faults;
};

// One life after the other, each from what the last cut of the one before left.
Verdict judge(PowerCutDisk::Syncs syncs, unsigned first_seed, int lives) {
  Verdict verdict;
  TemporaryFolder root;
  fs::path folder = root.path() / "life-0";
  fs::create_directories(folder);
  Promises kept;
  for (int life = 0; life < lives; ++life) {
    const unsigned seed = first_seed + static_cast<unsigned>(life);
    auto cuts = live(folder, kept, syncs, seed, life % 2 == 0 ? 1 : 4);
    const fs::path next = root.path() / ("life-" + std::to_string(life + 1));
    if (!cuts.empty()) {
      fs::copy(cuts.back().image, next, fs::copy_options::recursive);
      kept = cuts.back().promised;
    }
    for (const Cut& cut : cuts) {
      ++verdict.cuts;
      verdict.promised_jobs += cut.promised.jobs.size();
      if (std::string fault = first_fault(cut.image, cut.promised); !fault.empty())
        verdict.faults.push_back("seed " + std::to_string(seed) + ", " + cut.image.filename().string() +
                                 ": " + fault);
      fs::remove_all(cut.image);
    }
    if (!verdict.faults.empty()) break;
    folder = next;
  }
  return verdict;
}

TEST(PowerCut, WhateverIsAcknowledgedIsThereWhereverThePowerFails) {
  const Verdict verdict = judge(PowerCutDisk::Syncs::kHonest, 1, 8);
  EXPECT_TRUE(verdict.faults.empty()) << verdict.faults.front();
  EXPECT_GE(verdict.cuts, 300);
  std::printf("%d cuts, %zu acknowledged jobs looked for\n", verdict.cuts, verdict.promised_jobs);
}

TEST(PowerCut, AStoreThatDoesNotSyncIsFoundOut) {
  EXPECT_FALSE(judge(PowerCutDisk::Syncs::kNone, 1, 1).faults.empty());
}

TEST(PowerCut, AStoreWhoseCommitsDoNotWaitForTheLogIsFoundOut) {
  EXPECT_FALSE(judge(PowerCutDisk::Syncs::kNotOfTheLog, 1, 1).faults.empty());
}

}  // namespace
}  // namespace skinframe::server
