// SPDX-License-Identifier: Apache-2.0
#include "server/app/options.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <vector>

#include "server/app/listen_address.h"
#include "tests/fixture/temporary_folder.h"

namespace skinframe::server {
namespace {

std::variant<ServerOptions, EarlyEnd> parse(std::vector<const char*> arguments) {
  arguments.insert(arguments.begin(), "skinframe-server");
  return parse_command_line(static_cast<int>(arguments.size()), arguments.data());
}

absl::Status validate(const std::vector<const char*>& arguments) {
  const auto parsed = parse(arguments);
  const auto* options = std::get_if<ServerOptions>(&parsed);
  return options == nullptr ? absl::UnknownError(std::get<EarlyEnd>(parsed).text) : options->validate();
}

void expect_refused(const std::vector<const char*>& arguments, const std::string& names) {
  const absl::Status status = validate(arguments);
  EXPECT_FALSE(status.ok());
  EXPECT_NE(status.message().find(names), absl::string_view::npos) << status;
}

TEST(Options, DefaultsListenOnLoopback) {
  const auto parsed = parse({"--data", "d"});
  const auto& options = std::get<ServerOptions>(parsed);
  EXPECT_EQ(options.listen, "127.0.0.1:7350");
  EXPECT_TRUE(options.validate().ok());
}

TEST(Options, AreTakenFromTheCommandLineThenTheFileThenTheEnvironment) {
  const test::TemporaryFolder folder;
  folder.write("server.conf", "# ours\nlease = 30\nqueue-limit = 7\nallow-plaintext = true\n");
  const std::string file = (folder.path() / "server.conf").string();
  ::setenv("SKINFRAME_SERVER_QUEUE_LIMIT", "8", 1);
  ::setenv("SKINFRAME_SERVER_KEEP_JOBS_DAYS", "9", 1);
  const auto parsed = parse({"--data", "d", "--config", file.c_str(), "--lease", "40"});
  ::unsetenv("SKINFRAME_SERVER_QUEUE_LIMIT");
  ::unsetenv("SKINFRAME_SERVER_KEEP_JOBS_DAYS");
  ASSERT_TRUE(std::holds_alternative<ServerOptions>(parsed)) << std::get<EarlyEnd>(parsed).text;
  const auto& options = std::get<ServerOptions>(parsed);
  EXPECT_EQ(options.policy.lease, Milliseconds(40'000));
  EXPECT_EQ(options.queue_limit, 7);
  EXPECT_TRUE(options.allow_plaintext);
  EXPECT_EQ(options.keep_jobs_days, 9);
}

TEST(Options, AFileWithALineThatNamesNoOptionOrThatIsNotThereIsWrongUsage) {
  const test::TemporaryFolder folder;
  folder.write("server.conf", "leese = 30\n");
  const std::string file = (folder.path() / "server.conf").string();
  for (const std::string& name : {file, file + ".none"}) {
    const auto parsed = parse({"--data", "d", "--config", name.c_str()});
    ASSERT_TRUE(std::holds_alternative<EarlyEnd>(parsed)) << name;
    EXPECT_EQ(std::get<EarlyEnd>(parsed).exit_code, 2);
    EXPECT_NE(std::get<EarlyEnd>(parsed).text.find(name), std::string::npos) << "it names the file";
  }
}

TEST(Options, SecondsBecomeMilliseconds) {
  const auto parsed = parse({"--data", "d", "--lease", "2.5", "--heartbeat", "0.25", "--ageing", "30"});
  const auto& options = std::get<ServerOptions>(parsed);
  EXPECT_EQ(options.policy.lease, Milliseconds(2500));
  EXPECT_EQ(options.policy.heartbeat, Milliseconds(250));
  EXPECT_EQ(options.policy.ageing, Milliseconds(30'000));
}

TEST(Options, TheNetworkNeedsTlsOrAnExplicitFlag) {
  expect_refused({"--data", "d", "--listen", "0.0.0.0:7350"}, "--allow-plaintext");
  expect_refused({"--data", "d", "--listen", "[::]:7350"}, "--allow-plaintext");
  expect_refused({"--data", "d", "--listen", "farm.example:7350"}, "--allow-plaintext");
  EXPECT_TRUE(validate({"--data", "d", "--listen", "0.0.0.0:7350", "--allow-plaintext"}).ok());
  EXPECT_TRUE(
      validate({"--data", "d", "--listen", "0.0.0.0:7350", "--tls-cert", "c", "--tls-key", "k"}).ok());
}

TEST(Options, WhatIsWrongIsNamed) {
  expect_refused({}, "--data");
  expect_refused({"--data", "d", "--keep-jobs-days", "-1"}, "--keep-jobs-days");
  expect_refused({"--data", "d", "--store", "mysql://farm"}, "--store");
  expect_refused({"--data", "d", "--store", "postgresql://farm"}, "--artifacts");
  expect_refused({"--data", "d", "--store", "oracle"}, "oracle");
  expect_refused({"--data", "d", "--tls-cert", "c"}, "--tls-key");
  expect_refused({"--data", "d", "--listen", "7350"}, "--listen");
  expect_refused({"--data", "d", "--listen", "127.0.0.1:70000"}, "--listen");
  expect_refused({"--data", "d", "--queue-limit", "0"}, "--queue-limit");
  expect_refused({"--data", "d", "--max-attempts", "0"}, "--max-attempts");
  expect_refused({"--data", "d", "--lease", "0"}, "--lease");
  expect_refused({"--data", "d", "--heartbeat", "11"}, "--heartbeat");
  expect_refused({"--data", "d", "--ageing", "0"}, "--ageing");
  expect_refused({"--data", "d", "--drain", "-1"}, "--drain");
  expect_refused({"--data", "d", "--keep-progress-hours", "-1"}, "--keep-progress-hours");
  expect_refused({"--data", "d", "--client-ca", "ca.crt"}, "--tls-cert");
  expect_refused({"--data", "d", "--tls-cert", "c", "--tls-key", "k", "--client-ca", "ca.crt"}, "--tenants");
}

TEST(Options, HelpAndVersionEndWithZeroUnknownFlagsWithTwo) {
  const auto help = parse({"--help"});
  EXPECT_EQ(std::get<EarlyEnd>(help).exit_code, 0);
  EXPECT_NE(std::get<EarlyEnd>(help).text.find("Examples:"), std::string::npos);
  EXPECT_EQ(std::get<EarlyEnd>(parse({"--version"})).exit_code, 0);
  EXPECT_EQ(std::get<EarlyEnd>(parse({"--config", "f"})).exit_code, 2);
  EXPECT_EQ(std::get<EarlyEnd>(parse({"--lease", "soon"})).exit_code, 2);
}

TEST(ListenAddress, LoopbackIsRecognisedInAllItsForms) {
  for (const char* address : {"127.0.0.1:1", "127.9.9.9:1", "localhost:1", "[::1]:1"})
    EXPECT_TRUE(is_loopback(address));
  for (const char* address : {"128.0.0.1:1", "0.0.0.0:1", "[::]:1", "127.0.0.1.example:1", "local:1"}) {
    EXPECT_FALSE(is_loopback(address)) << address;
  }
}

TEST(ListenAddress, TheBoundPortReplacesTheAskedOne) {
  EXPECT_EQ(with_port("127.0.0.1:0", 4711), "127.0.0.1:4711");
  EXPECT_EQ(with_port("[::1]:0", 4711), "[::1]:4711");
}

}  // namespace
}  // namespace skinframe::server
