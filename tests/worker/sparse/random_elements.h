// SPDX-License-Identifier: GPL-3.0-or-later
// Elements between nodes of a lattice, with random stiffness that is symmetric and positive definite, and the
// dense matrix that they add up to, by the definition.
#pragma once

#include <Eigen/Core>
#include <random>
#include <vector>

#include "worker/sparse/node_matrix.h"

namespace skinframe::test {

struct Element {
  std::vector<int> nodes;
  Eigen::MatrixXd stiffness;
};

struct Elements {
  int width = 0;
  std::vector<char> is_free;
  std::vector<Element> elements;

  NodeMatrix sparse() const {
    std::vector<std::pair<int, int>> links;
    for (const Element& e : elements)
      for (const int a : e.nodes)
        for (const int b : e.nodes) links.emplace_back(a, b);
    NodeMatrix k(width, is_free, std::move(links));
    for (const Element& e : elements) k.add(e.nodes, e.stiffness);
    return k;
  }

  Eigen::MatrixXd dense() const {
    std::vector<int> row(is_free.size(), -1);
    int rows = 0;
    for (std::size_t i = 0; i < is_free.size(); ++i)
      if (is_free[i]) row[i] = rows++;
    Eigen::MatrixXd k = Eigen::MatrixXd::Zero(rows, rows);
    for (const Element& e : elements)
      for (Eigen::Index j = 0; j < e.stiffness.cols(); ++j)
        for (Eigen::Index i = 0; i < e.stiffness.rows(); ++i) {
          const int r = row[width * e.nodes[i / width] + i % width],
                    c = row[width * e.nodes[j / width] + j % width];
          if (r >= 0 && c >= 0) k(r, c) += e.stiffness(i, j);
        }
    return k;
  }
};

// side x side nodes, an element on each three of a square; one freedom in `held_one_in` is held.
inline Elements on_a_lattice(int side, int width, int held_one_in) {
  std::mt19937 random(7);
  Elements out;
  out.width = width;
  for (int i = 0; i < width * side * side; ++i) out.is_free.push_back(random() % held_one_in != 0);
  const auto number = [&] { return random() * 0x1p-32 - 0.5; };
  const auto add = [&](std::vector<int> nodes) {
    const auto size = static_cast<Eigen::Index>(nodes.size() * width);
    const Eigen::MatrixXd half = Eigen::MatrixXd::NullaryExpr(size, size, number);
    out.elements.push_back(
        {std::move(nodes), half * half.transpose() + Eigen::MatrixXd::Identity(size, size)});
  };
  for (int y = 0; y + 1 < side; ++y)
    for (int x = 0; x + 1 < side; ++x) {
      const int at = y * side + x;
      add({at + side, at, at + 1});
      add({at + side + 1, at + 1, at + side});
    }
  return out;
}

}  // namespace skinframe::test
