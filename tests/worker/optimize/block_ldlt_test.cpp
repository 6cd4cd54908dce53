// SPDX-License-Identifier: GPL-3.0-or-later
// The block factorisation against Eigen on the dense matrix.
#include "worker/optimize/block_ldlt.h"
#include "worker/run/one_blas_thread.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>
#include <set>

namespace skinframe {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

struct RandomMatrix {
  std::vector<int> block_rows;
  std::vector<std::pair<int, int>> edges;
  std::vector<MatrixXd> node_blocks, edge_blocks;
};

RandomMatrix random_matrix(int blocks, int edges, unsigned seed) {
  std::mt19937 generator(seed);
  const auto value = [&] { return static_cast<double>(generator()) / 2147483648.0 - 1; };
  RandomMatrix m;
  for (int i = 0; i < blocks; ++i) m.block_rows.push_back(3 + static_cast<int>(generator() % 4));
  std::set<std::pair<int, int>> known;
  while (static_cast<int>(known.size()) < edges) {
    const int a = static_cast<int>(generator() % blocks), b = static_cast<int>(generator() % blocks);
    if (a != b && !known.count({b, a})) known.insert({a, b});
  }
  m.edges.assign(known.begin(), known.end());
  for (int rows : m.block_rows) {
    const MatrixXd half = MatrixXd::NullaryExpr(rows, rows, value);
    m.node_blocks.push_back(half + half.transpose() + 2 * MatrixXd(MatrixXd::Identity(rows, rows)));
  }
  for (const auto& [a, b] : m.edges)
    m.edge_blocks.push_back(MatrixXd::NullaryExpr(m.block_rows[a], m.block_rows[b], value));
  return m;
}

BlockLdlt load(const RandomMatrix& m, std::shared_ptr<ThreadTeam> team = nullptr,
               std::function<bool()> cancelled = {}) {
  BlockLdlt matrix(m.block_rows, m.edges, std::move(team), std::move(cancelled));
  matrix.set_zero();
  for (std::size_t i = 0; i < m.node_blocks.size(); ++i)
    matrix.node_block(static_cast<int>(i)) += m.node_blocks[i];
  for (std::size_t e = 0; e < m.edges.size(); ++e) matrix.edge_block(static_cast<int>(e)) += m.edge_blocks[e];
  return matrix;
}

MatrixXd dense(const RandomMatrix& m, const BlockLdlt& matrix) {
  MatrixXd full = MatrixXd::Zero(matrix.rows(), matrix.rows());
  for (std::size_t i = 0; i < m.node_blocks.size(); ++i) {
    const int row = matrix.first_row(static_cast<int>(i)), rows = m.block_rows[i];
    full.block(row, row, rows, rows) = m.node_blocks[i];
  }
  for (std::size_t e = 0; e < m.edges.size(); ++e) {
    const auto [a, b] = m.edges[e];
    full.block(matrix.first_row(a), matrix.first_row(b), m.block_rows[a], m.block_rows[b]) = m.edge_blocks[e];
    full.block(matrix.first_row(b), matrix.first_row(a), m.block_rows[b], m.block_rows[a]) =
        m.edge_blocks[e].transpose();
  }
  return full;
}

class BlockLdltOf : public ::testing::TestWithParam<std::tuple<int, int>> {};

TEST_P(BlockLdltOf, SolvesAndCountsSignsAsTheDenseMatrix) {
  const auto [blocks, edges] = GetParam();
  for (unsigned seed = 1; seed <= 3; ++seed) {
    const RandomMatrix m = random_matrix(blocks, edges, seed);
    BlockLdlt matrix = load(m);
    const MatrixXd full = dense(m, matrix);
    ASSERT_TRUE(matrix.factorise());
    const VectorXd eigenvalues = Eigen::SelfAdjointEigenSolver<MatrixXd>(full).eigenvalues();
    EXPECT_EQ(matrix.inertia().positive, (eigenvalues.array() > 0).count());
    EXPECT_EQ(matrix.inertia().negative, (eigenvalues.array() < 0).count());

    const MatrixXd wanted = MatrixXd::Ones(matrix.rows(), 2) + MatrixXd(MatrixXd::Identity(matrix.rows(), 2));
    MatrixXd solved = full * wanted;
    EXPECT_LT((matrix.multiply(wanted.col(0)) - solved.col(0)).norm(), 1e-10 * solved.norm());
    matrix.solve_in_place(solved);
    EXPECT_LT((solved - wanted).norm(),
              1e-7 * wanted.norm() * std::max(1.0, 1e-4 / eigenvalues.cwiseAbs().minCoeff()));
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, BlockLdltOf,
                         ::testing::Values(std::tuple{1, 0}, std::tuple{2, 1}, std::tuple{6, 0},
                                           std::tuple{20, 40}, std::tuple{60, 180}, std::tuple{90, 350}));

// [0 K; K 0] has zero diagonal: only the pairing of a displacement with its multiplier can pivot.
TEST(BlockLdlt, SaddlePointOfANodePivotsWithinItsBlock) {
  BlockLdlt matrix({4, 4}, {{0, 1}});
  matrix.set_zero();
  for (int node : {0, 1}) {
    matrix.node_block(node).topRightCorner(2, 2) = 2 * Eigen::Matrix2d::Identity();
    matrix.node_block(node).bottomLeftCorner(2, 2) = 2 * Eigen::Matrix2d::Identity();
  }
  matrix.edge_block(0).topRightCorner(2, 2) = -Eigen::Matrix2d::Identity();
  matrix.edge_block(0).bottomLeftCorner(2, 2) = -Eigen::Matrix2d::Identity();
  ASSERT_TRUE(matrix.factorise());
  EXPECT_EQ(matrix.inertia(), (Inertia{4, 4, 0}));
}

TEST(BlockLdlt, SingularMatrixIsReported) {
  BlockLdlt matrix({2, 2}, {{0, 1}});
  matrix.set_zero();
  EXPECT_FALSE(matrix.factorise());
}

// A complete graph is one front, wider than one block of pivots.
TEST(BlockLdlt, WideFrontIsFactorisedBlockByBlock) {
  const RandomMatrix m = random_matrix(60, 60 * 59 / 2, 5);
  BlockLdlt matrix = load(m);
  ASSERT_GT(matrix.rows(), 2 * kPivotBlock);
  const MatrixXd full = dense(m, matrix);
  ASSERT_TRUE(matrix.factorise());
  const VectorXd eigenvalues = Eigen::SelfAdjointEigenSolver<MatrixXd>(full).eigenvalues();
  EXPECT_EQ(matrix.inertia().positive, (eigenvalues.array() > 0).count());
  const MatrixXd wanted = MatrixXd::Random(matrix.rows(), 3);
  MatrixXd solved = full * wanted;
  matrix.solve_in_place(solved);
  EXPECT_LT((solved - wanted).norm(), 1e-8 * wanted.norm());
}

TEST(BlockLdlt, SameBitsAtAnyNumberOfThreads) {
  use_one_blas_thread();
  const RandomMatrix m = random_matrix(400, 1600, 9);
  MatrixXd first;
  for (int threads : {1, 2, 3}) {
    BlockLdlt matrix = load(m, std::make_shared<ThreadTeam>(threads));
    ASSERT_TRUE(matrix.factorise());
    MatrixXd solved = MatrixXd::Ones(matrix.rows(), 1);
    matrix.solve_in_place(solved);
    if (threads == 1) first = solved;
    EXPECT_TRUE((solved.array() == first.array()).all()) << threads << " threads";
  }
}

// Between two questions lies one front: milliseconds in frames of two thousand nodes, and a good part of a
// second for the widest one of ten thousand.
TEST(BlockLdlt, CancellationIsAskedOfEveryFront) {
  const RandomMatrix m = random_matrix(400, 1600, 9);
  int asked = 0, allowed = 1 << 30;
  BlockLdlt matrix = load(m, nullptr, [&] { return ++asked > allowed; });
  ASSERT_TRUE(matrix.factorise());
  EXPECT_GT(asked, 20);
  allowed = asked / 2;
  asked = 0;
  EXPECT_FALSE(matrix.factorise());
  EXPECT_GT(asked, allowed);
  EXPECT_LE(asked, allowed + kLanes) << "each lane hears it once at most, and goes no further";
}

TEST(BlockLdlt, EmptyBlocksAreNoTrouble) {
  BlockLdlt matrix({0, 0, 0}, {{0, 1}, {1, 2}});
  matrix.set_zero();
  EXPECT_TRUE(matrix.factorise());
  EXPECT_EQ(matrix.rows(), 0);
}

}  // namespace
}  // namespace skinframe
