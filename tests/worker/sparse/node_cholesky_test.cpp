// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/sparse/node_cholesky.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <Eigen/Dense>
#include <fstream>
#include <new>

#include "tests/worker/sparse/random_elements.h"

namespace skinframe {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

TEST(NodeCholesky, SolvesAsADenseFactorDoes) {
  for (const int width : {1, 3, 6}) {
    const test::Elements elements = test::on_a_lattice(9, width, 4);
    const MatrixXd k = elements.dense();
    const MatrixXd f = MatrixXd::Random(k.rows(), 3);
    const auto factor = NodeCholesky::factorise(elements.sparse());
    ASSERT_TRUE(factor.has_value());
    const MatrixXd expected = k.ldlt().solve(f);
    EXPECT_LT((factor->solve(f) - expected).norm(), 1e-10 * expected.norm());
  }
}

TEST(NodeCholesky, ItsHalvesMakeTheInverseAndAreEachOthersTranspose) {
  const test::Elements elements = test::on_a_lattice(7, 6, 4);
  const MatrixXd k = elements.dense();
  const auto factor = NodeCholesky::factorise(elements.sparse());
  ASSERT_TRUE(factor.has_value());
  const VectorXd x = VectorXd::Random(k.rows()), y = VectorXd::Random(k.rows());
  const VectorXd both = factor->other_half_solve(factor->half_solve(x)), expected = k.ldlt().solve(x);
  EXPECT_LT((both - expected).norm(), 1e-10 * expected.norm());
  EXPECT_NEAR(y.dot(factor->half_solve(x)), x.dot(factor->other_half_solve(y)), 1e-10 * x.norm() * y.norm());
}

TEST(NodeCholesky, SaysThatAMatrixIsNotPositiveDefinite) {
  test::Elements elements = test::on_a_lattice(4, 3, 1000);
  elements.elements.push_back({{5}, -100 * MatrixXd::Identity(3, 3)});
  EXPECT_FALSE(NodeCholesky::factorise(elements.sparse()).has_value());
}

TEST(NodeCholesky, TakesNodesThatNothingLinksAndNoNodesAtAll) {
  NodeMatrix loose(1, {1, 1}, {});
  for (const int v : {0, 1}) loose.add(std::vector<int>{v}, MatrixXd::Constant(1, 1, 4));
  const auto factor = NodeCholesky::factorise(loose);
  ASSERT_TRUE(factor.has_value());
  EXPECT_TRUE(factor->solve(VectorXd::Constant(2, 8)).isApprox(VectorXd::Constant(2, 2)));
  EXPECT_TRUE(NodeCholesky::factorise(NodeMatrix(1, {0}, {})).has_value());
}

// More than this process has, and so much.
void limit_address_space(std::size_t more_bytes) {
  std::size_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  const rlimit limit{pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE)) + more_bytes, RLIM_INFINITY};
  if (::setrlimit(RLIMIT_AS, &limit) != 0) ::_exit(2);
}

[[noreturn]] void factorise_where_only_the_small_one_fits(const NodeMatrix& small, const NodeMatrix& large) {
  if (!NodeCholesky::factorise(small)) ::_exit(2);  // BLAS has its buffers now
  limit_address_space(8 << 20);
  try {
    (void)NodeCholesky::factorise(large);
  } catch (const std::bad_alloc&) {
    ::_exit(NodeCholesky::factorise(small) ? 0 : 3);
  }
  ::_exit(1);
}

TEST(NodeCholeskyDeath, MemoryThatDoesNotDoIsToldAndNoFactorGiven) {
  const NodeMatrix small = test::on_a_lattice(4, 6, 4).sparse(),
                   large = test::on_a_lattice(60, 6, 100).sparse();
  EXPECT_EXIT(factorise_where_only_the_small_one_fits(small, large), testing::ExitedWithCode(0), "");
  EXPECT_TRUE(NodeCholesky::factorise(large).has_value()) << "with memory enough";
}

}  // namespace
}  // namespace skinframe
