// SPDX-License-Identifier: Apache-2.0
// A network between two programs of a test that can be cut, slowed down and made silent: accepts on a free
// port of this machine and passes bytes on to a server's.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <list>
#include <mutex>
#include <string>
#include <thread>

namespace skinframe::faults {

class TcpProxy {
 public:
  explicit TcpProxy(const std::string& server_address);  // "127.0.0.1:PORT"
  ~TcpProxy();
  TcpProxy(const TcpProxy&) = delete;
  TcpProxy& operator=(const TcpProxy&) = delete;

  const std::string& address() const { return address_; }
  // Ends all connections in their midst; new ones are taken. Returns how many there were.
  int cut();
  // Each piece of a stream waits so long before it goes on; 0: none.
  void delay(std::chrono::milliseconds by) { delay_ms_ = by.count(); }
  // Nothing passes and nothing is told, as when a cable is pulled, until it is turned off again.
  void silence(bool on);

 private:
  struct Connection {
    int client = -1, server = -1;
    std::atomic<int> pumps = 2;  // at work
    std::thread up, down;
  };
  void accept_all();
  void pump(Connection& connection, int from, int to);
  bool wait_to_pass();  // false: the proxy ends

  std::string address_;
  int server_port_ = 0;
  int listener_ = -1;
  std::atomic<std::int64_t> delay_ms_ = 0;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool silent_ = false;
  bool ended_ = false;
  std::list<Connection> connections_;
  std::thread accepting_;
};

}  // namespace skinframe::faults
