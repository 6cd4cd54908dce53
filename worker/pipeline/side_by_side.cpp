// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/pipeline/side_by_side.h"

#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <mutex>
#include <optional>
#include <stop_token>

namespace skinframe {

Status side_by_side(const JobPart& here, const JobPart& beside, const RunContext& context) {
  std::stop_source stop;
  const std::stop_callback forward(context.stop, [&stop] { stop.request_stop(); });
  RunContext stopping = context;
  stopping.stop = stop.get_token();
  std::mutex mutex;
  std::optional<Error> first;
  const auto run = [&](const JobPart& part) {
    try {
      const Status ended = part(stopping);
      if (ended.ok()) return;
      const std::scoped_lock lock(mutex);
      if (!first) first = ended.error();
      stop.request_stop();
    } catch (...) {
      stop.request_stop();
      throw;  // the group waits for the other
    }
  };
  tbb::task_arena arena(std::max(1, context.threads));
  arena.execute([&] {
    tbb::task_group group;
    group.run([&] { run(beside); });
    run(here);
    group.wait();
  });
  return first ? Status(*first) : ok_status();
}

}  // namespace skinframe
