// SPDX-License-Identifier: Apache-2.0
#include "server/store/postgres_news.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <pqxx/pqxx>
#include <utility>

#include "server/store/postgres_session.h"

namespace skinframe::server {
namespace {

using std::chrono::milliseconds;

constexpr long kWaitMicroseconds = 300'000;  // how late a stop is seen at most
constexpr milliseconds kFirstBackoff{100};
constexpr milliseconds kLongestBackoff{2'000};

// Takes the news that came in on a connection.
class Receiver final : public pqxx::notification_receiver {
 public:
  Receiver(pqxx::connection_base& connection, const std::string& own, CommitListener& listener)
      : pqxx::notification_receiver(connection, kNewsChannel), own_(own), listener_(listener) {}

  void operator()(const std::string& payload, int) override {
    News news;
    if (!decode(payload, news) || news.sender == own_) return;
    listener_.changed_elsewhere(news.job_id, news.kind == News::Kind::kQueued);
  }

 private:
  const std::string& own_;
  CommitListener& listener_;
};

}  // namespace

std::string encode(const News& news) {
  const char kind = news.kind == News::Kind::kQueued ? 'q' : news.kind == News::Kind::kRemoved ? 'r' : 's';
  return fmt::format("{} {} {}", news.sender, kind, news.job_id);
}

bool decode(const std::string& payload, News& news) {
  const std::size_t first = payload.find(' ');
  if (first == std::string::npos || first + 3 >= payload.size() || payload[first + 2] != ' ') return false;
  switch (payload[first + 1]) {
    case 'q':
      news.kind = News::Kind::kQueued;
      break;
    case 'r':
      news.kind = News::Kind::kRemoved;
      break;
    case 's':
      news.kind = News::Kind::kOtherState;
      break;
    default:
      return false;
  }
  news.sender = payload.substr(0, first);
  news.job_id = payload.substr(first + 3);
  return true;
}

PostgresNews::PostgresNews(std::string where, std::string own, CommitListener& listener)
    : where_(std::move(where)), own_(std::move(own)), listener_(listener), thread_([this] { run(); }) {}

PostgresNews::~PostgresNews() {
  stopping_ = true;
  thread_.join();
}

void PostgresNews::listen() {
  pqxx::connection connection(with_network_limits(where_));
  const Receiver receiver(connection, own_, listener_);
  listener_.missed_news();  // from here on nothing is missed; what was before, the listener looks at once
  while (!stopping_) connection.await_notification(0, kWaitMicroseconds);
}

void PostgresNews::run() {
  milliseconds pause = kFirstBackoff;
  while (!stopping_) {
    const auto began = std::chrono::steady_clock::now();
    try {
      listen();
    } catch (...) {
      bool lost = false;
      spdlog::warn("news of other servers: {}", std::string(postgres_status("listening", lost).message()));
    }
    if (std::chrono::steady_clock::now() - began > 2 * kLongestBackoff) pause = kFirstBackoff;
    for (auto rest = pause; rest.count() > 0 && !stopping_; rest -= kFirstBackoff)
      std::this_thread::sleep_for(std::min(rest, kFirstBackoff));
    pause = std::min(2 * pause, kLongestBackoff);
  }
}

}  // namespace skinframe::server
