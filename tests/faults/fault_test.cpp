// SPDX-License-Identifier: Apache-2.0
#include "tests/faults/fault_test.h"

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/integration/tower_problem.h"

namespace skinframe::faults {
namespace {

using integration::binary;
using integration::read_file;
using nlohmann::json;

// The result but for how long it took.
std::string timeless(const std::string& result) {
  json document = json::parse(result, nullptr, false);
  if (document.is_discarded()) return "no JSON";
  document.erase("seconds");
  return document.dump();
}

unsigned chosen_seed() {
  if (const char* given = std::getenv("SKINFRAME_FAULTS_SEED"))
    return static_cast<unsigned>(std::stoul(given));
  return extended() ? std::random_device{}() : 1;
}

}  // namespace

bool extended() {
  const char* mode = std::getenv("SKINFRAME_FAULTS");
  return mode != nullptr && std::string(mode) == "extended";
}

FaultTest::FaultTest() : seed_(chosen_seed()), random_(seed_) {
  set_problem(integration::tower(5, 5, 8, 40));
  std::printf("SKINFRAME_FAULTS_SEED=%u\n", seed_);
}

void FaultTest::begin(const FarmShape& shape, const std::filesystem::path& data) {
  farm_ = std::make_unique<FaultFarm>(scratch_.path(), shape, data);
  witness_ = std::make_unique<Witness>(farm_->addresses());
  std::ofstream(scratch_ / "tower.json") << problem_;
  const auto alone = integration::run(
      {binary("skinframe-worker"), "solve-frame", scratch_ / "tower.json", "--out", scratch_ / "alone.json"},
      scratch_.path());
  ASSERT_EQ(alone.exit_code, 0) << alone.err;
  expected_ = timeless(read_file(scratch_ / "alone.json"));
  problem_sha256_ = witness_->upload(problem_);
}

v1::JobSpec FaultTest::frame_job() {
  v1::JobSpec spec;
  spec.set_frame_problem_sha256(problem_sha256_);
  spec.set_mesh_name("tower.json");
  return spec;
}

v1::JobSpec FaultTest::mesh_job() {
  const std::string mesh = scratch_ / "egg.stl";
  EXPECT_EQ(integration::run({binary("skinframe-worker"), "sample", "egg", "--out", mesh}, scratch_.path())
                .exit_code,
            0);
  v1::JobSpec spec;
  spec.set_mesh_sha256(witness_->upload(read_file(mesh)));
  spec.set_mesh_name("egg.stl");
  spec.add_printers()->set_printer_id("sinterstation-hiq");
  spec.mutable_options()->set_size_mm(40);
  spec.mutable_options()->set_skin_nodes(60);
  spec.mutable_options()->set_verify(v1::VERIFY_OFF);
  spec.set_priority(1);
  return spec;
}

void FaultTest::pause(int from_ms, int to_ms) {
  std::this_thread::sleep_for(std::chrono::milliseconds(draw(from_ms, to_ms)));
}

void FaultTest::expect_all_well(std::chrono::seconds at_most) {
  EXPECT_TRUE(witness_->wait_for_all(at_most)) << witness_->running_or_queued() << " jobs did not end";
  const Verdict verdict =
      witness_->judge(farm_->worker_logs(), [this](const std::string& path, const std::string& content) {
        return path != "result.json" || timeless(content) == expected_;
      });
  for (const std::string& fault : verdict.faults) ADD_FAILURE() << fault;
  const Kills& kills = farm_->kills();
  std::printf(
      "%d kills (%d workers, %d job processes, %d servers, %d databases), %d freezes; %d jobs in %d "
      "attempts; "
      "%lld events watched, %lld reconnections; %zu faults\n",
      kills.total(), kills.workers, kills.jobs, kills.servers, kills.databases, kills.freezes, verdict.jobs,
      verdict.attempts, static_cast<long long>(verdict.events), static_cast<long long>(verdict.reconnections),
      verdict.faults.size());
}

Submitter::Submitter(Witness& witness, std::function<v1::JobSpec()> next, int at_once, int at_most)
    : thread_([this, &witness, next = std::move(next), at_once, at_most](std::stop_token stop) {
        try {
          for (int i = 0; i < at_most && !stop.stop_requested();) {
            const bool room =
                witness.wait(std::chrono::seconds(1), [&] { return witness.running_or_queued() < at_once; });
            if (!room) continue;
            witness.submit(next());
            ++i;
          }
        } catch (...) {
          failure_ = std::current_exception();
        }
        done_ = true;
      }) {}

void Submitter::finish() {
  thread_.request_stop();
  if (thread_.joinable()) thread_.join();
  if (failure_) std::rethrow_exception(failure_);
}

}  // namespace skinframe::faults
