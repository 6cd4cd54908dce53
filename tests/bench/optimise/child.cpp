// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/bench/optimise/child.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <sstream>

namespace skinframe::bench {

ChildEnd run_child(const std::vector<std::string>& command, double max_seconds) {
  int ends[2];
  ChildEnd end;
  if (pipe2(ends, O_CLOEXEC) != 0) return end;
  std::vector<char*> arguments;
  for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  setenv("OPENBLAS_NUM_THREADS", "1", 1);
  const pid_t child = fork();
  if (child < 0) {
    close(ends[0]);
    close(ends[1]);
    return end;
  }
  if (child == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    dup2(ends[1], 1);
    execv(arguments[0], arguments.data());
    _exit(127);
  }
  close(ends[1]);

  using Clock = std::chrono::steady_clock;
  const auto limit =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(max_seconds));
  char buffer[1 << 16];
  for (;;) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(limit - Clock::now()).count();
    pollfd wanted{ends[0], POLLIN, 0};
    const int ready = left > 0 ? poll(&wanted, 1, static_cast<int>(std::min<long long>(left, 1'000'000))) : 0;
    if (ready == 0 && Clock::now() >= limit) {
      end.timed_out = true;
      kill(child, SIGKILL);
      break;
    }
    if (ready <= 0) continue;
    const ssize_t got = read(ends[0], buffer, sizeof buffer);
    if (got <= 0) break;
    end.out.append(buffer, static_cast<std::size_t>(got));
  }
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  end.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return end;
}

double peak_memory_mb() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.rfind("VmHWM:", 0) == 0) return std::stod(line.substr(6)) / 1024;
  return 0;
}

}  // namespace skinframe::bench
