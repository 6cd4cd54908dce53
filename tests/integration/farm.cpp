// SPDX-License-Identifier: Apache-2.0
#include "tests/integration/farm.h"

#include <gtest/gtest.h>
#include <signal.h>

#include <nlohmann/json.hpp>

namespace skinframe::integration {

using nlohmann::json;

Farm::Farm(const Scratch& scratch, std::vector<std::string> server_words)
    : scratch_(scratch.path()), server_words_(std::move(server_words)) {
  start_server();
}

void Farm::start_server() {
  const auto port_file = scratch_ / "port";
  std::filesystem::remove(port_file);
  std::vector<std::string> words{binary("skinframe-server"),
                                 "--listen",
                                 address_.empty() ? "127.0.0.1:0" : address_,
                                 "--data",
                                 scratch_ / "data",
                                 "--port-file",
                                 port_file,
                                 "--lease-seconds",
                                 "3",
                                 "--heartbeat-seconds",
                                 "1"};
  words.insert(words.end(), server_words_.begin(), server_words_.end());
  server_ = std::make_unique<Process>(words, scratch_ / ("server-" + std::to_string(starts_++)));
  ASSERT_TRUE(eventually([&] { return !read_file(port_file).empty(); }, Seconds(30))) << server_->err();
  address_ = read_file(port_file);
  while (!address_.empty() && (address_.back() == '\n' || address_.back() == ' ')) address_.pop_back();
}

void Farm::kill_server() {
  server_->signal(SIGKILL);
  ASSERT_EQ(server_->wait(), 128 + SIGKILL);
}

void Farm::stop_server() {
  server_->signal(SIGTERM);
  ASSERT_EQ(server_->wait(Seconds(15)), 0) << server_->err();
}

Process& Farm::start_worker(const std::string& name) {
  workers_.push_back(std::make_unique<Process>(
      std::vector<std::string>{binary("skinframe-worker"), "--server", address_, "--name", name, "--work-dir",
                               scratch_ / ("work-" + name)},
      scratch_ / ("worker-" + name)));
  return *workers_.back();
}

std::vector<std::string> Farm::client(std::vector<std::string> words) const {
  words.insert(words.begin(), {binary("skinframe"), "--server", address_});
  return words;
}

std::string Farm::submit(std::vector<std::string> words) const {
  words.insert(words.begin(), {"--json", "submit"});
  const Ran ran = ask(std::move(words));
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
  const json reply = json::parse(ran.out, nullptr, false);
  return reply.is_discarded() ? "" : reply.value("job_id", "");
}

std::string Farm::state_of(const std::string& job) const {
  const Ran ran = ask({"--json", "get", job});
  const json reply = json::parse(ran.out, nullptr, false);
  return reply.is_discarded() ? "" : reply.value("state", "");
}

bool Farm::at_work(const std::string& job) const {
  Process watch(client({"--json", "watch", job}), scratch_ / "at-work");
  const bool seen = eventually(
      [&] { return watch.out().find("\"skin\"") != std::string::npos || !watch.running(); }, Seconds(60));
  watch.signal(SIGINT);
  watch.wait();
  return seen && watch.out().find("\"skin\"") != std::string::npos;
}

}  // namespace skinframe::integration
