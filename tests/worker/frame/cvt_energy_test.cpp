// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/frame/cvt_energy.h"

#include <gtest/gtest.h>

#include <random>

namespace skinframe {
namespace {

double unit(std::mt19937_64& random) { return static_cast<double>(random() % 100000) / 1e5; }

// A square sheet of even samples.
WeightedSamples sheet(int side) {
  WeightedSamples samples;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      samples.points.emplace_back((x + 0.5) / side, (y + 0.5) / side, 0.0);
      samples.weights.push_back(1.0 / (side * side));
    }
  return samples;
}

std::vector<Eigen::Vector3d> scattered(int n) {
  std::mt19937_64 random(5);
  std::vector<Eigen::Vector3d> sites;
  for (int i = 0; i < n; ++i) sites.emplace_back(unit(random), unit(random), 0.2 * unit(random));
  return sites;
}

TEST(CvtEnergy, GradientIsThatOfFiniteDifferences) {
  const WeightedSamples samples = sheet(60);
  auto sites = scattered(7);
  std::vector<Eigen::Vector3d> gradient;
  cvt_energy(samples, sites, 1, &gradient);
  constexpr double kStep = 1e-6;
  for (std::size_t i = 0; i < sites.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      auto before = sites, after = sites;
      before[i][k] -= kStep;
      after[i][k] += kStep;
      const double slope =
          (cvt_energy(samples, after, 1, nullptr) - cvt_energy(samples, before, 1, nullptr)) / (2 * kStep);
      EXPECT_NEAR(gradient[i][k], slope, 1e-5 + 1e-3 * std::abs(slope));
    }
}

TEST(CvtEnergy, OneSiteEndsAtTheWeightedCentroid) {
  WeightedSamples samples = sheet(20);
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
  double weight = 0.0;
  for (std::size_t v = 0; v < samples.points.size(); ++v) {
    samples.weights[v] *= 1.0 + samples.points[v].x();
    centroid += samples.weights[v] * samples.points[v];
    weight += samples.weights[v];
  }
  std::vector<Eigen::Vector3d> sites{{0.1, 0.9, 0.4}};
  minimise_cvt(samples, {0}, 50, RunContext{}, sites);
  EXPECT_LT((sites[0] - centroid / weight).norm(), 1e-4);
}

TEST(CvtEnergy, DensePartsGetMoreSitesHeldOnesStayAndEnergyFalls) {
  WeightedSamples samples = sheet(100);
  for (std::size_t v = 0; v < samples.points.size(); ++v)
    if (samples.points[v].x() > 0.5) samples.weights[v] *= 16.0;  // edges half as long there
  auto sites = scattered(60);
  const auto before = sites;
  std::vector<char> held(sites.size(), 0);
  held[3] = 1;
  minimise_cvt(samples, held, 100, RunContext{}, sites);
  EXPECT_EQ(sites[3], before[3]);
  EXPECT_LT(cvt_energy(samples, sites, 1, nullptr), 0.9 * cvt_energy(samples, before, 1, nullptr));
  int right = 0;
  for (const auto& s : sites) right += s.x() > 0.5;
  EXPECT_GT(right, 33);  // half by area is 30
}

TEST(CvtEnergy, SameAtAnyThreadCount) {
  const WeightedSamples samples = sheet(80);
  auto one = scattered(25), two = one;
  const std::vector<char> held(one.size(), 0);
  RunContext context;
  minimise_cvt(samples, held, 30, context, one);
  context.threads = 2;
  minimise_cvt(samples, held, 30, context, two);
  EXPECT_EQ(one, two);
}

}  // namespace
}  // namespace skinframe
