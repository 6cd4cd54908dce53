// SPDX-License-Identifier: Apache-2.0
// Ctrl-C (SIGINT), SIGTERM and SIGHUP as events of a thread instead of as the end of the process.
// Make it before any other thread starts: they must inherit the blocked signals.
#pragma once

#include <functional>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>

namespace skinframe::client {

enum class Answer { kYes, kNo, kSignal };  // kSignal: another signal came instead of an answer

class Interrupts {
 public:
  using Handler = std::function<void(int signal)>;

  Interrupts();
  ~Interrupts();
  Interrupts(const Interrupts&) = delete;
  Interrupts& operator=(const Interrupts&) = delete;

  // Without a handler a signal asks this source to stop.
  const std::stop_source& stop_source() const { return stop_; }

  // Handles signals for as long as it lives, one at a time, in the thread of Interrupts. Its end waits for a
  // handler that runs, and takes back a question that stands.
  class Handling {
   public:
    Handling(Interrupts& interrupts, Handler handler);
    ~Handling();
    Handling(const Handling&) = delete;
    Handling& operator=(const Handling&) = delete;

   private:
    Interrupts& interrupts_;
  };

  // From a handler: asks on stderr, reads a line of stdin.
  Answer ask(const std::string& question);

 private:
  void run();

  std::stop_source stop_;
  std::mutex mutex_;  // held while a handler runs
  Handler handler_;   // guarded by mutex_
  int signals_ = -1, quit_ = -1, no_question_ = -1;
  std::thread thread_;
};

}  // namespace skinframe::client
