// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/worker/verify/ask_calculix.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>

#include "tests/fixture/temporary_folder.h"

namespace skinframe::test {
namespace {

using Eigen::Vector3d;
using Edge = std::pair<int, int>;

Edge edge_of(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

std::string list(const Vector3d& v) { return fmt::format("{:.9g},{:.9g},{:.9g}", v[0], v[1], v[2]); }

// Nodes of the structure keep their numbers, from 1 on; those along sides and struts follow.
class Deck {
 public:
  Deck(const Structure& s, Contraction contraction)
      : s_(s), contraction_(contraction), next_(static_cast<int>(s.nodes_mm.size()) + 1) {
    for (std::size_t i = 0; i < s.nodes_mm.size(); ++i) {
      nodes_ += fmt::format("{},{}\n", i + 1, list(s.nodes_mm[i]));
      hold(static_cast<int>(i) + 1, s.held[i]);
    }
  }

  std::string write(const NodalColumns& loads) {
    add_shells();
    add_struts();
    std::string deck = "*NODE,NSET=ALL\n" + nodes_ + elements_ + "*BOUNDARY\n" + held_;
    for (Eigen::Index c = 0; c < loads.cols(); ++c) {
      deck += "*STEP\n*STATIC\n*CLOAD,OP=NEW\n";
      for (Eigen::Index i = 0; i < loads.rows(); ++i)
        if (i % 6 < 3 && loads(i, c) != 0)
          deck += fmt::format("{},{},{:.9g}\n", i / 6 + 1, i % 6 + 1, loads(i, c));
      deck += "*NODE FILE,OUTPUT=2D\nU\n*END STEP\n";
    }
    return deck;
  }

 private:
  void hold(int node, const HeldFreedoms& held) {
    for (int k = 0; k < 6; ++k)
      if (held[k]) held_ += fmt::format("{},{}\n", node, k + 1);
  }
  int add_node(const Vector3d& p) {
    nodes_ += fmt::format("{},{}\n", next_, list(p));
    return next_++;
  }
  int middle_of_side(int a, int b) {
    const auto [it, fresh] = middles_.try_emplace(edge_of(a, b), next_);
    if (!fresh) return it->second;
    HeldFreedoms both;
    for (int k = 0; k < 6; ++k) both[k] = s_.held[a][k] && s_.held[b][k];
    hold(next_, both);
    return add_node((s_.nodes_mm[a] + s_.nodes_mm[b]) / 2);
  }

  void add_shells() {
    if (s_.shells.empty()) return;
    elements_ += fmt::format("*MATERIAL,NAME=SKIN\n*ELASTIC\n{:.9g},{:.9g}\n", s_.material.modulus_mpa,
                             s_.material.poisson_ratio);
    for (const StructureShell& shell : s_.shells) {
      const auto& [a, b, c] = shell.nodes;
      const int ab = middle_of_side(a, b), bc = middle_of_side(b, c), ca = middle_of_side(c, a);
      elements_ += fmt::format(
          "*ELEMENT,TYPE=S6,ELSET=T{0}\n{0},{1},{2},{3},{4},{5},{6}\n"
          "*SHELL SECTION,ELSET=T{0},MATERIAL=SKIN\n{7:.9g}\n",
          element_, a + 1, b + 1, c + 1, ab, bc, ca, shell.thickness_mm);
      ++element_;
    }
  }

  void add_strut_material() {
    const double e = s_.material.modulus_mpa, nu = s_.material.poisson_ratio, g = e / (2 * (1 + nu));
    if (contraction_ == Contraction::kIsotropic)
      elements_ += fmt::format("*MATERIAL,NAME=STRUT\n*ELASTIC\n{:.9g},{:.9g}\n", e, nu);
    else
      elements_ += fmt::format(
          "*MATERIAL,NAME=STRUT\n*ELASTIC,TYPE=ENGINEERING CONSTANTS\n"
          "{0:.9g},{0:.9g},{0:.9g},0,0,0,{1:.9g},{1:.9g}\n{1:.9g}\n",
          e, g);
  }

  // Where a strut's beams end, in shares of its length.
  std::vector<double> beam_ends(double length_mm, double radius_mm) const {
    if (contraction_ == Contraction::kNone) return {0.5, 1};
    const double last = std::min(radius_mm / length_mm, 0.25);
    return {last, 0.5, 1 - last, 1};
  }

  void add_struts() {
    if (s_.struts.empty()) return;
    add_strut_material();
    for (std::size_t j = 0; j < s_.struts.size(); ++j) {
      const auto& [from, to] = s_.struts[j].nodes;
      const Vector3d &a = s_.nodes_mm[from], &b = s_.nodes_mm[to];
      const Vector3d along = (b - a).normalized(), across = along.unitOrthogonal();
      elements_ += fmt::format("*ELEMENT,TYPE=B32R,ELSET=S{}\n", j + 1);
      const auto side = middles_.find(edge_of(from, to));
      if (side != middles_.end()) {
        elements_ += fmt::format("{},{},{},{}\n", element_++, from + 1, side->second, to + 1);
      } else {
        int last = from + 1;
        double begun = 0;
        for (const double ends : beam_ends((b - a).norm(), s_.struts[j].radius_mm)) {
          const int middle = add_node(a + (begun + ends) / 2 * (b - a));
          const int end = ends < 1 ? add_node(a + ends * (b - a)) : to + 1;
          elements_ += fmt::format("{},{},{},{}\n", element_++, last, middle, end);
          last = end;
          begun = ends;
        }
      }
      const bool turned = contraction_ == Contraction::kNone;
      if (turned)
        elements_ += fmt::format("*ORIENTATION,NAME=O{}\n{},{}\n", j + 1, list(along), list(across));
      elements_ += fmt::format(
          "*BEAM SECTION,ELSET=S{0},MATERIAL=STRUT,{1}SECTION=PIPE\n{2:.9g},{2:.9g}\n{3}\n", j + 1,
          turned ? fmt::format("ORIENTATION=O{},", j + 1) : "", s_.struts[j].radius_mm, list(across));
    }
  }

  const Structure& s_;
  const Contraction contraction_;
  int next_, element_ = 1;
  std::map<Edge, int> middles_;  // of shells' sides
  std::string nodes_, elements_, held_;
};

// Blocks of lines " -1", node (10 wide), three figures (12 wide each) between "DISP" and " -3", one a step.
Eigen::MatrixXd displacements_in(const std::filesystem::path& path, std::size_t nodes, Eigen::Index steps) {
  std::ifstream file(path);
  Eigen::MatrixXd d = Eigen::MatrixXd::Constant(3 * static_cast<Eigen::Index>(nodes), steps, std::nan(""));
  Eigen::Index step = -1;
  bool inside = false;
  for (std::string line; std::getline(file, line);) {
    if (line.find("DISP") != std::string::npos) {
      inside = ++step < steps;
    } else if (line.starts_with(" -3")) {
      inside = false;
    } else if (inside && line.starts_with(" -1")) {
      const Eigen::Index node = std::stoi(line.substr(3, 10)) - 1;
      if (3 * node >= d.rows()) continue;  // along a side or a strut
      for (int k = 0; k < 3; ++k) d(3 * node + k, step) = std::stod(line.substr(13 + 12 * k, 12));
    }
  }
  return d;
}

}  // namespace

Eigen::MatrixXd ask_calculix(const Structure& structure, const NodalColumns& loads, Contraction contraction) {
  const TemporaryFolder folder;
  folder.write("model.inp", Deck(structure, contraction).write(loads));
  const std::string command = fmt::format("cd {} && OMP_NUM_THREADS=1 {} model > model.log 2>&1",
                                          folder.path().string(), SKINFRAME_CCX);
  if (std::system(command.c_str()) != 0) {
    ADD_FAILURE() << folder.read("model.log");
    return {};
  }
  return displacements_in(folder.path() / "model.frd", structure.nodes_mm.size(), loads.cols());
}

}  // namespace skinframe::test
