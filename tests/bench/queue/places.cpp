// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/queue/places.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <vector>

#include "server/store/postgres_store.h"
#include "server/store/sqlite_store.h"

namespace skinframe::bench {

std::filesystem::path Places::fresh_folder() {
  auto folder = folder_ / std::to_string(++next_);
  std::filesystem::create_directories(folder);
  return folder;
}

std::string Places::fresh_postgres() {
  if (postgres_ == nullptr)
    postgres_ = std::make_unique<server::PostgresServer>(server::PostgresServer::Commits::kDurable);
  return postgres_->new_database();
}

namespace {

std::unique_ptr<server::JobStore> opened(absl::StatusOr<std::unique_ptr<server::JobStore>> store) {
  if (!store.ok()) throw std::runtime_error(std::string(store.status().message()));
  return *std::move(store);
}

constexpr int kSessions = 16;  // as a server has

}  // namespace

std::unique_ptr<server::JobStore> Places::fresh_store(const std::string& kind) {
  return opened(kind == "postgres" ? server::open_postgres_store({fresh_postgres(), kSessions}, nullptr)
                                   : server::open_sqlite_store(fresh_folder() / "jobs.sqlite", nullptr));
}

std::unique_ptr<server::JobStore> Places::fresh_store_in_memory(const std::string& kind) {
  if (kind == "sqlite")
    return opened(server::open_sqlite_store(memory_.path() / (std::to_string(++next_) + ".sqlite"), nullptr));
  if (fast_postgres_ == nullptr) fast_postgres_ = std::make_unique<server::PostgresServer>();
  return opened(server::open_postgres_store({fast_postgres_->new_database(), kSessions}, nullptr));
}

double sync_ms(const std::filesystem::path& folder, int times) {
  const auto file = folder / "sync-probe";
  const int descriptor = ::open(file.c_str(), O_CREAT | O_WRONLY | O_TRUNC | O_CLOEXEC, 0600);
  if (descriptor < 0) throw std::runtime_error("cannot write " + file.string());
  const std::string block(4096, 'x');
  std::vector<double> taken;
  for (int i = 0; i < times; ++i) {
    const auto before = std::chrono::steady_clock::now();
    if (::write(descriptor, block.data(), block.size()) != static_cast<ssize_t>(block.size()) ||
        ::fdatasync(descriptor) != 0) {
      ::close(descriptor);
      throw std::runtime_error("cannot sync " + file.string());
    }
    taken.push_back(
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - before).count());
  }
  ::close(descriptor);
  std::filesystem::remove(file);
  std::nth_element(taken.begin(), taken.begin() + times / 2, taken.end());
  return taken[static_cast<std::size_t>(times / 2)];
}

}  // namespace skinframe::bench
