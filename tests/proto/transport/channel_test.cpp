// SPDX-License-Identifier: Apache-2.0
#include "proto/transport/channel.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/fixture/temporary_folder.h"

namespace skinframe::transport {
namespace {

TEST(Channel, AFileWithoutACertificateIsNamed) {
  const test::TemporaryFolder folder;
  ChannelOptions options;
  options.address = "127.0.0.1:1";
  options.tls.authority = folder.path() / "missing.crt";
  EXPECT_THAT(std::string(open_channel(options).status().message()), testing::HasSubstr("missing.crt"));
  std::ofstream(folder.path() / "ca.crt") << "PEM";
  std::ofstream(folder.path() / "empty.key").flush();
  options.tls = {folder.path() / "ca.crt", folder.path() / "ca.crt", folder.path() / "empty.key"};
  EXPECT_THAT(std::string(open_channel(options).status().message()), testing::HasSubstr("empty.key"));
}

TEST(Channel, OpensWithoutAServer) {
  ChannelOptions options;
  options.address = "127.0.0.1:1";
  const auto channel = open_channel(options);
  ASSERT_TRUE(channel.ok());
  EXPECT_EQ((*channel)->GetState(false), GRPC_CHANNEL_IDLE);
}

}  // namespace
}  // namespace skinframe::transport
