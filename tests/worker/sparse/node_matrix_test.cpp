// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/sparse/node_matrix.h"

#include <gtest/gtest.h>

#include "tests/worker/sparse/random_elements.h"

namespace skinframe {
namespace {

using Eigen::MatrixXd;

TEST(NodeMatrix, IsTheSumOfItsElementsOnWhatIsFree) {
  for (const int width : {1, 3, 6}) {
    const test::Elements elements = test::on_a_lattice(6, width, 5);
    const MatrixXd expected = elements.dense();
    const NodeMatrix k = elements.sparse();
    ASSERT_EQ(k.rows(), expected.rows());
    EXPECT_LT((MatrixXd(k.lower()) - MatrixXd(expected.triangularView<Eigen::Lower>())).cwiseAbs().maxCoeff(),
              1e-13);
  }
}

TEST(NodeMatrix, GivesItsRowsInOrderOfNodesAndNoneToWhatIsHeld) {
  const NodeMatrix k(2, {1, 0, 0, 0, 1, 1}, {{2, 0}});
  EXPECT_EQ(k.rows(), 3);
  EXPECT_EQ(k.row(0), 0);
  EXPECT_EQ(k.row(1), -1);
  EXPECT_EQ(k.row(2), -1);
  EXPECT_EQ(k.row(5), 2);
  EXPECT_EQ(k.first_row(1), k.first_row(2));
  EXPECT_EQ(k.lower().nonZeros(), 6);  // both nodes with rows are linked: a full lower half
}

TEST(NodeMatrix, TakesAnElementThatNamesANodeTwice) {
  test::Elements elements;
  elements.width = 2;
  elements.is_free = {1, 1, 1, 1};
  elements.elements = {{{1, 0, 1}, MatrixXd::Constant(6, 6, 1) + MatrixXd::Identity(6, 6)}};
  EXPECT_TRUE(MatrixXd(elements.sparse().lower())
                  .isApprox(MatrixXd(elements.dense().triangularView<Eigen::Lower>())));
}

TEST(NodeMatrix, MayHaveNoRowAtAll) {
  const NodeMatrix k(3, {0, 0, 0, 0, 0, 0}, {{0, 1}});
  EXPECT_EQ(k.rows(), 0);
  EXPECT_EQ(k.lower().nonZeros(), 0);
}

TEST(NodeMatrixDeath, RefusesAnElementWhoseNodesAreNotLinked) {
  NodeMatrix k(1, {1, 1, 1}, {{0, 1}});
  EXPECT_DEATH(k.add(std::vector<int>{0, 2}, MatrixXd::Identity(2, 2)), "");
}

}  // namespace
}  // namespace skinframe
