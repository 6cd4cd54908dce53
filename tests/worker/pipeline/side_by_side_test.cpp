// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/pipeline/side_by_side.h"

#include <gtest/gtest.h>

#include <condition_variable>
#include <mutex>
#include <semaphore>
#include <stdexcept>

namespace skinframe {
namespace {

// Longer than any machine needs; only what does not hold waits for it.
constexpr std::chrono::seconds kPatience{60};
// For the other part to begin, which it may not do before this one has ended.
constexpr std::chrono::milliseconds kHead{500};

RunContext with_threads(int threads) {
  RunContext context;
  context.threads = threads;
  return context;
}

// True when the part was asked to stop.
bool waits_for_stop(const RunContext& context) {
  std::mutex mutex;
  std::condition_variable_any changed;
  std::unique_lock lock(mutex);
  changed.wait_for(lock, context.stop, kPatience, [] { return false; });
  return context.cancelled();
}

TEST(SideBySide, AFailureStopsTheOtherAndIsWhatIsTold) {
  for (const int threads : {1, 2}) {
    std::binary_semaphore begun(0);
    bool stopped = false;
    const Status ended = side_by_side(
        [&](const RunContext&) -> Status {
          (void)begun.try_acquire_for(kHead);
          return io_error("disk full");
        },
        [&](const RunContext& context) -> Status {
          begun.release();
          stopped = waits_for_stop(context);
          return cancelled_error();
        },
        with_threads(threads));
    EXPECT_TRUE(stopped) << threads;
    ASSERT_FALSE(ended.ok());
    EXPECT_EQ(ended.error().kind, ErrorKind::kIo) << ended.error().message;
  }
}

TEST(SideBySide, TheOthersFailureIsTold) {
  for (const int threads : {1, 2}) {
    const Status ended = side_by_side([](const RunContext&) { return ok_status(); },
                                      [](const RunContext&) -> Status { return io_error("disk full"); },
                                      with_threads(threads));
    ASSERT_FALSE(ended.ok());
    EXPECT_EQ(ended.error().message, "disk full");
  }
}

TEST(SideBySide, WhatIsThrownStopsTheOtherAndIsThrownOn) {
  std::binary_semaphore begun(0);
  bool stopped = true;  // also when it never begins
  EXPECT_THROW((void)side_by_side(
                   [&](const RunContext&) -> Status {
                     (void)begun.try_acquire_for(kHead);
                     throw std::runtime_error("no memory");
                   },
                   [&](const RunContext& context) {
                     begun.release();
                     stopped = waits_for_stop(context);
                     return ok_status();
                   },
                   with_threads(2)),
               std::runtime_error);
  EXPECT_TRUE(stopped);
}

TEST(SideBySide, TheJobsCancellationReachesBoth) {
  std::stop_source stop;
  RunContext context = with_threads(2);
  context.stop = stop.get_token();
  bool here = false, beside = false;
  stop.request_stop();
  const Status ended = side_by_side(
      [&](const RunContext& c) -> Status {
        here = c.cancelled();
        return cancelled_error();
      },
      [&](const RunContext& c) -> Status {
        beside = c.cancelled();
        return cancelled_error();
      },
      context);
  EXPECT_TRUE(here && beside);
  ASSERT_FALSE(ended.ok());
  EXPECT_EQ(ended.error().kind, ErrorKind::kCancelled);
}

}  // namespace
}  // namespace skinframe
