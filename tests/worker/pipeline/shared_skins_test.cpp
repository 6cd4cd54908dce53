// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/pipeline/shared_skins.h"

#include <gtest/gtest.h>

#include <atomic>
#include <latch>
#include <new>
#include <thread>

namespace skinframe {
namespace {

class SharedSkinsTest : public testing::Test {
 protected:
  std::function<Result<Skin>()> skin_of(double thickness_mm) {
    return [this, thickness_mm]() -> Result<Skin> {
      ++built_;
      Skin skin;
      skin.thickness_mm = thickness_mm;
      return skin;
    };
  }
  std::atomic<int> built_ = 0;
  SharedSkins skins_;
};

TEST_F(SharedSkinsTest, PrintersOfOneThicknessShareOneSkinThatIsBuiltOnce) {
  constexpr int kPrinters = 4;
  for (int i = 0; i < kPrinters; ++i) skins_.announce(0.8);
  skins_.announce(1.0);
  std::latch all_there(kPrinters);
  std::vector<std::shared_ptr<const Skin>> got(kPrinters);
  std::vector<std::thread> printers;
  for (int i = 0; i < kPrinters; ++i)
    printers.emplace_back([&, i] {
      all_there.arrive_and_wait();
      got[i] = skins_.get(0.8, skin_of(0.8)).value();
    });
  for (std::thread& printer : printers) printer.join();
  EXPECT_EQ(built_, 1);
  for (const auto& skin : got) EXPECT_EQ(skin, got.front());
  EXPECT_EQ(skins_.get(1.0, skin_of(1.0)).value()->thickness_mm, 1.0);
  EXPECT_EQ(built_, 2) << "another thickness is another skin";
}

TEST_F(SharedSkinsTest, ASkinIsLetGoOnceTheLastPrinterHasAskedAndIsDone) {
  skins_.announce(0.8);
  skins_.announce(0.8);
  std::weak_ptr<const Skin> seen = skins_.get(0.8, skin_of(0.8)).value();
  EXPECT_FALSE(seen.expired()) << "another one is still to come";
  seen = skins_.get(0.8, skin_of(0.8)).value();
  EXPECT_EQ(built_, 1);
  EXPECT_TRUE(seen.expired());
}

TEST_F(SharedSkinsTest, WhatFailedIsTriedAnewForTheNext) {
  for (int i = 0; i < 3; ++i) skins_.announce(0.8);
  EXPECT_FALSE(skins_.get(0.8, []() -> Result<Skin> { return invalid_input("too many voxels"); }).ok());
  EXPECT_THROW((void)skins_.get(0.8, []() -> Result<Skin> { throw std::bad_alloc(); }), std::bad_alloc);
  EXPECT_TRUE(skins_.get(0.8, skin_of(0.8)).ok());
  EXPECT_EQ(built_, 1);
  EXPECT_TRUE(skins_.get(0.8, skin_of(0.8)).ok()) << "nobody announced it";
  EXPECT_EQ(built_, 2);
}

}  // namespace
}  // namespace skinframe
