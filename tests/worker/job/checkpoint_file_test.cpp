// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/job/checkpoint_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <memory>

#include "tests/fixture/temporary_folder.h"
#include "worker/run/bytes.h"

namespace skinframe {
namespace {

using ::testing::HasSubstr;

class CheckpointFileTest : public ::testing::Test {
 protected:
  // A process of the job's own that keeps one value, and what is left is the next one's.
  void keep(const std::string& job_id, const std::string& value) {
    CheckpointFile file(folder_.path(), job_id, events_, std::chrono::milliseconds(0));
    file.keep("key", "size", value);
    hand_over();
  }
  void hand_over() { std::filesystem::rename(folder_.path() / "checkpoint", folder_.path() / "resume"); }
  std::optional<std::string> found(const std::string& job_id) {
    CheckpointFile file(folder_.path(), job_id, events_, std::chrono::milliseconds(0));
    return file.find("key");
  }
  std::string told() {
    std::rewind(out_.get());
    std::string text(100'000, '\0');
    text.resize(std::fread(text.data(), 1, text.size(), out_.get()));
    return text;
  }
  std::string resume() {
    std::ifstream in(folder_.path() / "resume", std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  void write_resume(const std::string& bytes) {
    std::ofstream(folder_.path() / "resume", std::ios::binary) << bytes;
  }

  test::TemporaryFolder folder_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> out_{std::tmpfile(), std::fclose};
  EventStream events_{out_.get(), TimeLeft::kUnknown};
};

TEST_F(CheckpointFileTest, WhatOneAttemptKeepsTheNextOneFindsAndHandsOn) {
  EXPECT_FALSE(found("job"));
  keep("job", std::string("\0\n\xff", 3));
  EXPECT_EQ(found("job"), std::string("\0\n\xff", 3));
  EXPECT_THAT(told(), HasSubstr("{\"checkpoint\":{\"stage\":\"size\"}}"));
  {
    CheckpointFile second(folder_.path(), "job", events_, std::chrono::milliseconds(0));
    second.keep("other", "topology", "later");
    EXPECT_FALSE(second.find("other")) << "an attempt does not go on from itself";
  }
  hand_over();
  EXPECT_TRUE(found("job")) << "what was taken over is handed on";
}

TEST_F(CheckpointFileTest, LittleWorkIsNotWorthAFile) {
  CheckpointFile file(folder_.path(), "job", events_, std::chrono::hours(1));
  file.keep("key", "size", "value");
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "checkpoint"));
}

TEST_F(CheckpointFileTest, EveryDamageIsRefusedAndSaidSo) {
  keep("job", "value");
  const std::string good = resume();
  for (std::size_t at = 0; at < good.size(); ++at) {
    std::string damaged = good;
    damaged[at] = static_cast<char>(damaged[at] ^ 1);
    write_resume(damaged);
    ASSERT_FALSE(found("job")) << at;
    write_resume(good.substr(0, at));
    ASSERT_FALSE(found("job")) << at;
  }
  EXPECT_THAT(told(), HasSubstr("it is damaged; starting from the beginning"));
}

TEST_F(CheckpointFileTest, AnotherJobsIsRefused) {
  keep("another", "value");
  EXPECT_FALSE(found("job"));
  EXPECT_THAT(told(), HasSubstr("of another job"));
}

TEST_F(CheckpointFileTest, AnotherVersionsIsRefused) {
  ByteWriter writer;
  std::string magic = "skinframe checkpoint 1", version = "0.0.1";
  writer(magic, version);
  const std::string bytes = writer.take();
  write_resume(bytes + fingerprint(bytes));
  EXPECT_FALSE(found("job"));
  EXPECT_THAT(told(), HasSubstr("it is of version 0.0.1"));
}

}  // namespace
}  // namespace skinframe
