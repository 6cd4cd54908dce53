// SPDX-License-Identifier: Apache-2.0
// The queue's figures, both stores in one run: tests/bench/QUEUE.md says how to read them.
#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <map>
#include <memory>
#include <vector>

#include "tests/bench/queue/one_core.h"
#include "tests/bench/queue/places.h"
#include "tests/bench/queue/service_times.h"
#include "tests/bench/queue/store_rates.h"

namespace skinframe::bench {
namespace {

struct Sizes {
  int jobs_one_by_one = 500;
  int jobs_batched = 10'000;
  int callers = 64;
  int deep_queue = 100'000;
  int shallow_queue = 100;
  int tenants = 10;
  int leases = 500;
  int pick_ups = 200;
  int watchers = 2'000;
  int broadcasts = 20;
};

Sizes smallest() { return {30, 200, 16, 5'000, 100, 5, 60, 10, 50, 5}; }

struct Figures {
  double cycle = 0;       // a second, batched
  double flat_ratio = 0;  // lease, or duties, with the deep queue over the same with the shallow one
  double pick_up_p95_ms = 0;
};

void say(const std::string& line) {
  std::fputs((line + "\n").c_str(), stdout);
  std::fflush(stdout);
}

// How many times as long a lease, or the duties, take with the deep queue as with the shallow one.
double measure_flatness(Places& places, const std::string& kind, const Sizes& sizes) {
  const OneCore one_core;
  const std::array depths = {sizes.shallow_queue, sizes.deep_queue};
  std::vector<std::unique_ptr<server::JobStore>> stores;
  for (const int queued : depths) {
    stores.push_back(places.fresh_store_in_memory(kind));
    fill(*stores.back(), queued, sizes.tenants);
  }
  const auto costs = measure_lease_costs({stores[0].get(), stores[1].get()}, sizes.leases);
  for (std::size_t i = 0; i < costs.size(); ++i) {
    say(fmt::format(
        "| {} | lease from {} queued jobs of {} tenants, no disk | median {:.0f} us | p95 {:.0f} "
        "us | duties {:.0f} us |",
        kind, depths[i], sizes.tenants, costs[i].median_us, costs[i].p95_us, costs[i].duties_median_us));
  }
  return std::max(costs[1].median_us / costs[0].median_us,
                  costs[1].duties_median_us / costs[0].duties_median_us);
}

Figures measure(Places& places, const std::string& kind, const Sizes& sizes) {
  Figures figures;
  for (const bool batched : {false, true}) {
    const auto store = places.fresh_store(kind);
    const int callers = batched ? sizes.callers : 1;
    const double sync = sync_ms(places.fresh_folder(), 25);
    const Rates rates = measure_rates(*store, batched ? sizes.jobs_batched : sizes.jobs_one_by_one, callers);
    say(fmt::format(
        "| {} | {} callers | enqueue {:.0f}/s | lease {:.0f}/s | complete {:.0f}/s | cycle {:.0f}/s | "
        "one sync {:.2f} ms |",
        kind, callers, rates.enqueue, rates.lease, rates.complete, rates.cycle(), sync));
    if (batched) figures.cycle = rates.cycle();
  }
  figures.flat_ratio = measure_flatness(places, kind, sizes);
  server::ServerOptions options;
  options.listen = "127.0.0.1:0";
  options.data = places.fresh_folder();
  if (kind == "postgres") {
    options.store = places.fresh_postgres();
    options.artifacts = places.fresh_folder();
  }
  const Spread pick_up = measure_pick_up(options, sizes.pick_ups);
  figures.pick_up_p95_ms = pick_up.p95_ms;
  say(fmt::format("| {} | pick-up of {} jobs, idle | p50 {:.1f} ms | p95 {:.1f} ms | p99 {:.1f} ms |", kind,
                  sizes.pick_ups, pick_up.p50_ms, pick_up.p95_ms, pick_up.p99_ms));
  const Broadcast watched = measure_watchers(options, sizes.watchers, sizes.broadcasts);
  say(fmt::format("| {} | one event to {} watchers | p50 {:.1f} ms | p95 {:.1f} ms |", kind, watched.watchers,
                  watched.all_have_it.p50_ms, watched.all_have_it.p95_ms));
  return figures;
}

int run(const std::vector<std::string>& kinds, const std::filesystem::path& folder, const Sizes& sizes,
        double most_flat_ratio, double most_pick_up_ms) {
  Places places(folder);
  std::map<std::string, Figures> all;
  for (const std::string& kind : kinds) all[kind] = measure(places, kind, sizes);
  if (all.size() == 2)
    say(fmt::format("SQLite : PostgreSQL, cycles of {} callers: {:.2f} : 1", sizes.callers,
                    all["sqlite"].cycle / all["postgres"].cycle));
  bool good = true;
  for (const auto& [kind, figures] : all) {
    say(
        fmt::format("{}: with the deep queue a lease, or the duties, take {:.2f} times as long as with the "
                    "shallow one; pick-up p95 "
                    "{:.1f} ms",
                    kind, figures.flat_ratio, figures.pick_up_p95_ms));
    good = good && figures.flat_ratio <= most_flat_ratio && figures.pick_up_p95_ms <= most_pick_up_ms;
  }
  if (!good) say("over a limit that was asked for");
  return good ? 0 : 1;
}

}  // namespace
}  // namespace skinframe::bench

int main(int argc, char** argv) {
  using namespace skinframe::bench;
  CLI::App app("What the queue does a second, how long a job waits, and that a long queue costs no more.");
  std::vector<std::string> kinds = {"sqlite", "postgres"};
  std::string folder = "/var/tmp";
  bool smoke = false;
  double most_flat_ratio = 1e9;
  double most_pick_up_ms = 1e9;
  app.add_option("--stores", kinds, "sqlite, postgres")->check(CLI::IsMember({"sqlite", "postgres"}));
  app.add_option("--folder", folder, "on the disk to measure")->capture_default_str();
  app.add_flag("--smoke", smoke, "the smallest sizes: that it runs, not what it can");
  app.add_option("--expect-flat", most_flat_ratio,
                 "exit 1 when the deep queue's lease takes more times that");
  app.add_option("--expect-pick-up-ms", most_pick_up_ms, "exit 1 when p95 is above");
  CLI11_PARSE(app, argc, argv);
  spdlog::set_level(spdlog::level::off);
  std::string own = folder + "/skinframe-bench-queue-XXXXXX";
  if (::mkdtemp(own.data()) == nullptr) {
    std::fprintf(stderr, "cannot make a folder in %s\n", folder.c_str());
    return 2;
  }
  int code = 2;
  try {
    code = run(kinds, own, smoke ? smallest() : Sizes{}, most_flat_ratio, most_pick_up_ms);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
  }
  std::error_code ignored;
  std::filesystem::remove_all(own, ignored);
  return code;
}
