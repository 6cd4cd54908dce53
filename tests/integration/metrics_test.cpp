// SPDX-License-Identifier: Apache-2.0
// What deploy/METRICS.md documents is there, in the real programs, and moves when a job runs; nothing else is
// shown.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include "tests/fixture/loopback.h"
#include "tests/integration/farm.h"
#include "tests/integration/tower_problem.h"

namespace skinframe::integration {
namespace {

// The whole answer to what is sent; empty where nobody listens.
std::string send_and_hear(int port, const std::string& request) {
  const int link = ::socket(AF_INET, SOCK_STREAM, 0);
  const sockaddr_in address = test::loopback(port);
  std::string answer;
  if (::connect(link, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 &&
      ::send(link, request.data(), request.size(), MSG_NOSIGNAL) > 0) {
    char part[4096];
    for (ssize_t got = 0; (got = ::recv(link, part, sizeof part, 0)) > 0;)
      answer.append(part, static_cast<std::size_t>(got));
  }
  ::close(link);
  return answer;
}

std::string get(int port, const std::string& path) {
  return send_and_hear(port, "GET " + path + " HTTP/1.1\r\nHost: here\r\n\r\n");
}

// Each family that is declared, and the sum of its figures: of a histogram's its counts.
std::map<std::string, double> scrape(int port) {
  std::istringstream lines(get(port, "/metrics"));
  std::map<std::string, double> sums;
  std::set<std::string> histograms;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string first, second, name, type;
    words >> first >> second >> name >> type;
    if (first == "#" && second == "TYPE") {
      sums[name];
      if (type == "histogram") histograms.insert(name);
      continue;
    }
    const std::string key = line.substr(0, line.find_first_of(" {"));
    const bool count = key.ends_with("_count") && histograms.contains(key.substr(0, key.size() - 6));
    if (count) sums[key.substr(0, key.size() - 6)] += std::stod(line.substr(line.rfind(' ')));
    if (sums.contains(key)) sums[key] += std::stod(line.substr(line.rfind(' ')));
  }
  return sums;
}

struct Documented {
  std::set<std::string> names, moving;  // moving: those that a job must move
};

// The table's rows: | `name` | program | ... | moves or stays |
Documented documented(const std::string& program) {
  std::ifstream in(SKINFRAME_SOURCE_DIR "/deploy/METRICS.md");
  Documented found;
  const std::regex row(R"(\| `([a-z_]+)` *\| ([a-z, ]+) \|.*\| (moves|stays) \|)");
  for (std::string line; std::getline(in, line);) {
    std::smatch parts;
    if (!std::regex_match(line, parts, row) || parts[2].str().find(program) == std::string::npos) continue;
    found.names.insert(parts[1]);
    if (parts[3] == "moves") found.moving.insert(parts[1]);
  }
  return found;
}

std::set<std::string> names_of(const std::map<std::string, double>& sums) {
  std::set<std::string> names;
  for (const auto& [name, sum] : sums) names.insert(name);
  return names;
}

TEST(Metrics, EachDocumentedOneIsThereAndMovesWithAJobAndThereIsNoOther) {
  const Scratch scratch;
  const int server_port = test::free_port(), worker_port = test::free_port();
  Farm farm(scratch, {"--metrics", std::to_string(server_port)});
  const auto at_rest = scrape(server_port);
  std::ofstream(scratch / "tower.json") << tower(9, 9, 12, 600).dump();
  const std::string job = farm.submit({(scratch / "tower.json").string()});
  const auto queued = scrape(server_port);
  EXPECT_EQ(queued.at("skinframe_jobs_queued"), 1);
  // A worker that dies with the job, so that a lease expires; then one that does it.
  Process& lost = farm.start_worker("lost");
  ASSERT_TRUE(eventually([&] { return farm.state_of(job) == "RUNNING"; }, Seconds(30)));
  EXPECT_EQ(scrape(server_port).at("skinframe_jobs_running"), 1);
  lost.signal(SIGKILL);
  Process worker({binary("skinframe-worker"), "--server", farm.address(), "--work-dir", scratch / "work",
                  "--metrics", "127.0.0.1:" + std::to_string(worker_port)},
                 scratch / "worker-log");
  const auto idle = [&] {
    auto sums = scrape(worker_port);
    return sums;
  };
  std::map<std::string, double> worker_before;
  ASSERT_TRUE(eventually([&] { return !(worker_before = idle()).empty(); }, Seconds(30)));
  ASSERT_TRUE(eventually([&] { return farm.state_of(job) == "SUCCEEDED"; }, Seconds(120)));
  const auto server_after = scrape(server_port);
  std::map<std::string, double> worker_after;
  ASSERT_TRUE(eventually([&] { return (worker_after = idle())["skinframe_worker_attempts_total"] == 1; },
                         Seconds(30)));

  const Documented of_server = documented("server"), of_worker = documented("worker");
  ASSERT_GE(of_server.names.size(), 10u) << "the table was not understood";
  EXPECT_EQ(names_of(server_after), of_server.names);
  EXPECT_EQ(names_of(worker_after), of_worker.names);
  for (const std::string& name : of_server.moving) {
    const double before = at_rest.contains(name) ? at_rest.at(name) : 0;
    const bool moved =
        server_after.at(name) != before || (queued.contains(name) && queued.at(name) != before);
    EXPECT_TRUE(moved || name == "skinframe_jobs_running") << name << " stayed " << before;
  }
  for (const std::string& name : of_worker.moving) EXPECT_TRUE(worker_after.at(name) > 0) << name;
  EXPECT_EQ(server_after.at("skinframe_lease_expiries_total"), 1);
  EXPECT_EQ(server_after.at("skinframe_attempts_total"), 2);
  EXPECT_EQ(server_after.at("skinframe_jobs_ended_total"), 1);
  EXPECT_EQ(server_after.at("skinframe_jobs_queued"), 0);
  EXPECT_EQ(worker_after.at("skinframe_worker_jobs_running"), 0);
  EXPECT_THAT(get(server_port, "/metrics"),
              testing::HasSubstr("method=\"skinframe.v1.JobService/SubmitJob\""));
}

TEST(Metrics, WhateverIsSentTheEndpointGoesOn) {
  const Scratch scratch;
  const int port = test::free_port();
  const Farm farm(scratch, {"--metrics", std::to_string(port)});
  EXPECT_THAT(get(port, "/metrics?x=1"), testing::StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(get(port, "/"), testing::StartsWith("HTTP/1.1 404"));
  EXPECT_THAT(send_and_hear(port, "POST /metrics HTTP/1.1\r\nContent-Length: 0\r\n\r\n"),
              testing::StartsWith("HTTP/1.1 405"));
  send_and_hear(port, "nonsense\r\n\r\n");
  send_and_hear(port, "GET /" + std::string(100'000, 'x') + " HTTP/1.1\r\n\r\n");
  // Connections that only hang on: more than there are places for. Those are given up after 5 s.
  std::vector<int> idle;
  for (int i = 0; i < 40; ++i) {
    idle.push_back(::socket(AF_INET, SOCK_STREAM, 0));
    const sockaddr_in address = test::loopback(port);
    EXPECT_EQ(::connect(idle.back(), reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  }
  EXPECT_TRUE(eventually([&] { return get(port, "/metrics").starts_with("HTTP/1.1 200"); }, Seconds(30)));
  for (const int link : idle) ::close(link);
  EXPECT_EQ(farm.ask({"list"}).exit_code, 0);
}

}  // namespace
}  // namespace skinframe::integration
