// SPDX-License-Identifier: Apache-2.0
#include "tests/faults/tcp_proxy.h"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <stdexcept>

#include "tests/fixture/loopback.h"

namespace skinframe::faults {
namespace {

int new_socket() { return ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0); }

// The next close tells the other side by a reset.
void reset_on_close(int fd) {
  const linger at_once{1, 0};
  ::setsockopt(fd, SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
}

}  // namespace

TcpProxy::TcpProxy(const std::string& server_address)
    : server_port_(std::stoi(server_address.substr(server_address.rfind(':') + 1))), listener_(new_socket()) {
  address_ = "127.0.0.1:" + std::to_string(test::bind_to_any_port(listener_));
  if (::listen(listener_, 64) != 0) throw std::runtime_error("the proxy cannot listen");
  accepting_ = std::thread([this] { accept_all(); });
}

TcpProxy::~TcpProxy() {
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
  }
  changed_.notify_all();
  ::shutdown(listener_, SHUT_RDWR);
  accepting_.join();
  cut();
  for (Connection& connection : connections_) {
    connection.up.join();
    connection.down.join();
    ::close(connection.client);
    ::close(connection.server);
  }
  ::close(listener_);
}

void TcpProxy::accept_all() {
  for (;;) {
    const int client = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
    if (client < 0) return;
    const int server = new_socket();
    const sockaddr_in to = test::loopback(server_port_);
    if (::connect(server, reinterpret_cast<const sockaddr*>(&to), sizeof to) != 0) {
      reset_on_close(client);
      ::close(client);
      ::close(server);
      continue;
    }
    const int yes = 1;
    ::setsockopt(client, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
    ::setsockopt(server, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
    const std::lock_guard lock(mutex_);
    Connection& connection = connections_.emplace_back();
    connection.client = client;
    connection.server = server;
    connection.up =
        std::thread([this, &connection] { pump(connection, connection.client, connection.server); });
    connection.down =
        std::thread([this, &connection] { pump(connection, connection.server, connection.client); });
  }
}

bool TcpProxy::wait_to_pass() {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, std::chrono::milliseconds(delay_ms_.load()), [this] { return ended_; });
  changed_.wait(lock, [this] { return ended_ || !silent_; });
  return !ended_;
}

void TcpProxy::pump(Connection& connection, int from, int to) {
  std::array<char, 64 * 1024> bytes;
  for (;;) {
    const ssize_t got = ::recv(from, bytes.data(), bytes.size(), 0);
    if (got <= 0 || !wait_to_pass()) break;
    ssize_t sent = 0;
    while (sent < got) {
      const ssize_t now = ::send(to, bytes.data() + sent, static_cast<std::size_t>(got - sent), MSG_NOSIGNAL);
      if (now <= 0) break;
      sent += now;
    }
    if (sent < got) break;
  }
  ::shutdown(from, SHUT_RDWR);
  ::shutdown(to, SHUT_RDWR);
  --connection.pumps;
}

int TcpProxy::cut() {
  const std::lock_guard lock(mutex_);
  int alive = 0;
  for (Connection& connection : connections_) {
    if (connection.pumps < 2) continue;
    ++alive;
    for (const int fd : {connection.client, connection.server}) ::shutdown(fd, SHUT_RDWR);
  }
  return alive;
}

void TcpProxy::silence(bool on) {
  {
    const std::lock_guard lock(mutex_);
    silent_ = on;
  }
  changed_.notify_all();
}

}  // namespace skinframe::faults
