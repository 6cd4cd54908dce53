// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/problem/problem_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <system_error>
#include <utility>

#include "worker/problem/json_bounds.h"
#include "worker/problem/json_field.h"

namespace skinframe {
namespace {

using nlohmann::json;

ElementModel read_element(const Field& field) {
  const std::string name = field.text();
  for (ElementModel model : {ElementModel::kPaper, ElementModel::kAxial})
    if (name == to_string(model)) return model;
  throw FieldError{
      unsupported(fmt::format("mechanics: \"{}\" is not built; use \"paper\" or \"axial\"", name))};
}

Material read_material(const Field& field, ElementModel element) {
  Material material;
  if (field.has("id")) material.id = field.at("id").text();
  material.tensile_modulus_mpa = field.at("tensile_modulus_mpa").number();
  if (element == ElementModel::kPaper || field.has("shear_modulus_mpa"))
    material.shear_modulus_mpa = field.at("shear_modulus_mpa").number();
  material.tensile_strength_mpa = field.optional_number("tensile_strength_mpa");
  material.shear_strength_mpa = field.optional_number("shear_strength_mpa");
  material.slenderness = field.optional_number("slenderness");
  material.density_g_cm3 = field.at("density_g_cm3").number();
  return material;
}

// Skin nodes stand first in a Frame; in a file they may stand anywhere, and then the count is not known (0).
int leading_skin_nodes(const Frame& frame) {
  const std::vector<bool> of_skin = skin_nodes(frame);
  std::size_t leading = 0;
  while (leading < of_skin.size() && of_skin[leading]) ++leading;
  for (std::size_t i = leading; i < of_skin.size(); ++i)
    if (of_skin[i]) return 0;
  return static_cast<int>(leading);
}

// By index: the problem itself knows only which nodes are joined.
void refuse_twins(const std::vector<Strut>& struts) {
  std::vector<std::array<int, 3>> ends;  // the nodes in order, then the strut
  ends.reserve(struts.size());
  for (std::size_t j = 0; j < struts.size(); ++j) {
    const auto [low, high] = std::minmax(struts[j].a, struts[j].b);
    ends.push_back({low, high, static_cast<int>(j)});
  }
  std::sort(ends.begin(), ends.end());
  const auto twin = std::adjacent_find(
      ends.begin(), ends.end(), [](const auto& p, const auto& q) { return p[0] == q[0] && p[1] == q[1]; });
  if (twin == ends.end()) return;
  refuse(
      fmt::format("struts[{}]", (*std::next(twin))[2]),
      fmt::format("joins nodes {} and {}, as struts[{}] does already", (*twin)[0], (*twin)[1], (*twin)[2]));
}

void read_frame(const Field& root, FrameProblem& problem) {
  Frame& frame = problem.frame;
  const Field nodes = root.at("nodes");
  const std::size_t node_count = nodes.size(kMaxProblemNodes);
  if (node_count == 0) refuse("nodes", "there are none");
  for (std::size_t i = 0; i < node_count; ++i) frame.nodes_mm.push_back(nodes.at(i).vector<3>());

  const Field struts = root.at("struts");
  const std::size_t strut_count = struts.size(kMaxProblemStruts);
  for (std::size_t j = 0; j < strut_count; ++j) {
    const Field strut = struts.at(j);
    frame.struts.push_back({strut.at("a").node(node_count), strut.at("b").node(node_count),
                            strut.has("skin") && strut.at("skin").boolean()});
    problem.bounds.push_back({strut.at("min_radius_mm").number(), strut.at("max_radius_mm").number()});
  }
  refuse_twins(frame.struts);
  if (root.has("skin_triangles")) {
    const Field triangles = root.at("skin_triangles");
    const std::size_t count = triangles.size(2 * kMaxProblemNodes);
    for (std::size_t t = 0; t < count; ++t) {
      const Field triangle = triangles.at(t);
      if (triangle.size(3) != 3) refuse(triangle.path(), "must name three nodes");
      frame.skin_triangles.push_back({triangle.at(std::size_t{0}).node(node_count),
                                      triangle.at(1).node(node_count), triangle.at(2).node(node_count)});
    }
  }
  frame.skin_node_count = leading_skin_nodes(frame);
}

void read_fixed(const Field& root, FrameProblem& problem) {
  const std::size_t nodes = problem.frame.nodes_mm.size();
  problem.fixed.assign(nodes, {false, false, false});
  const Field fixed = root.at("fixed");
  const std::size_t count = fixed.size(kMaxProblemNodes);
  for (std::size_t i = 0; i < count; ++i) {
    auto& axes = problem.fixed[fixed.at(i).at("node").node(nodes)];
    const Field names = fixed.at(i).at("axes");
    for (char axis : names.text()) {
      if (axis < 'x' || axis > 'z') refuse(names.path(), fmt::format("'{}' is not an axis (x, y, z)", axis));
      axes[axis - 'x'] = true;
    }
  }
}

void read_loads(const Field& root, FrameProblem& problem) {
  const std::size_t nodes = problem.frame.nodes_mm.size();
  const Field cases = root.at("load_cases");
  const std::size_t count = cases.size(std::min(kMaxProblemLoadCases, kMaxProblemForces / nodes));
  for (std::size_t k = 0; k < count; ++k) {
    const Field field = cases.at(k);
    LoadCase load;
    load.name = field.has("name") ? field.at("name").text() : fmt::format("case-{}", k);
    load.gravity = !field.has("gravity") || field.at("gravity").boolean();
    load.force_n.assign(nodes, Eigen::Vector3d::Zero());
    if (field.has("forces")) {
      const Field forces = field.at("forces");
      const std::size_t force_count = forces.size(kMaxProblemNodes);
      for (std::size_t i = 0; i < force_count; ++i)
        load.force_n[forces.at(i).at("node").node(nodes)] += forces.at(i).at("force_n").vector<3>();
    }
    problem.load_cases.push_back(std::move(load));
  }
  if (root.has("skin_weight_n")) {
    const Field weights = root.at("skin_weight_n");
    const std::size_t weight_count = weights.size(kMaxProblemNodes);
    for (std::size_t i = 0; i < weight_count; ++i) problem.skin_weight_n.push_back(weights.at(i).number());
  }
}

void read_balance(const Field& root, FrameProblem& problem) {
  if (root.has("skin_mass"))
    problem.skin_mass = {root.at("skin_mass").at("weight_n").number(),
                         root.at("skin_mass").at("centroid_mm").vector<3>()};
  if (!root.has("balance_half_planes")) return;
  const Field planes = root.at("balance_half_planes");
  const std::size_t row = 6 * problem.frame.nodes_mm.size() + problem.frame.struts.size();
  const std::size_t count = planes.size(std::min(kMaxProblemHalfPlanes, kMaxProblemBalanceEntries / row));
  for (std::size_t i = 0; i < count; ++i)
    problem.balance.push_back({planes.at(i).at("normal").vector<2>(), planes.at(i).at("offset_mm").number()});
}

void read_free_nodes(const Field& root, FrameProblem& problem) {
  problem.free_nodes.assign(problem.frame.nodes_mm.size(), false);
  if (!root.has("free_nodes")) return;
  const Field nodes = root.at("free_nodes");
  const std::size_t count = nodes.size(kMaxProblemNodes);
  for (std::size_t i = 0; i < count; ++i)
    problem.free_nodes[nodes.at(i).node(problem.free_nodes.size())] = true;
}

OptimizeOptions read_options(const Field& root) {
  OptimizeOptions options;
  if (root.has("order")) {
    const std::string order = root.at("order").text();
    if (order != "paper" && order != "tight")
      refuse("order", fmt::format("\"{}\" is neither paper nor tight", order));
    options.order = order == "paper" ? OptimizeOptions::Order::kPaper : OptimizeOptions::Order::kTight;
  }
  if (!root.has("stages")) return options;
  options.relaxed = options.topology = options.geometry = false;
  bool size = false;
  const std::pair<const char*, bool*> known[] = {{"size", &size},
                                                 {"relaxed", &options.relaxed},
                                                 {"topology", &options.topology},
                                                 {"geometry", &options.geometry}};
  const Field stages = root.at("stages");
  const std::size_t count = stages.size(std::size(known));
  for (std::size_t i = 0; i < count; ++i) {
    const std::string name = stages.at(i).text();
    const auto* stage =
        std::find_if(std::begin(known), std::end(known), [&](const auto& k) { return name == k.first; });
    if (stage == std::end(known))
      refuse(stages.at(i).path(),
             fmt::format("\"{}\" is not a stage (size, relaxed, topology, geometry)", name));
    *stage->second = true;
  }
  if (!size) refuse("stages", "\"size\" must be among them: the others build upon it");
  return options;
}

}  // namespace

Result<ProblemFile> parse_problem(const json& document) {
  try {
    const Field root(document, "");
    ProblemFile file;
    FrameProblem& problem = file.problem;
    problem.element = read_element(root.at("mechanics"));
    problem.material = read_material(root.at("material"), problem.element);
    read_frame(root, problem);
    read_fixed(root, problem);
    read_loads(root, problem);
    read_balance(root, problem);
    read_free_nodes(root, problem);
    problem.displacement_limit_mm = root.optional_number("displacement_limit_mm");
    file.options = read_options(root);
    if (Status s = validate(problem); !s.ok()) return s.error();
    return file;
  } catch (const FieldError& refused) {
    return refused.error;
  }
}

Result<ProblemFile> read_problem(const std::filesystem::path& path, const std::string& name) {
  std::error_code failure;
  const std::uintmax_t bytes = std::filesystem::file_size(path, failure);
  if (failure) return io_error(fmt::format("{}: {}", name, failure.message()));
  if (bytes > kMaxProblemFileBytes)
    return invalid_input(fmt::format("{}: {} bytes, at most {} are read", name, bytes, kMaxProblemFileBytes));
  std::ifstream stream(path, std::ios::binary);
  if (!stream) return io_error(fmt::format("{}: cannot be opened", name));
  if (const Status bounded = check_json_bounds(stream, {kMaxProblemValues, kMaxProblemDepth}); !bounded)
    return Error{bounded.error().kind, fmt::format("{}: {}", name, bounded.error().message)};
  stream.clear();
  stream.seekg(0);
  try {
    auto file = parse_problem(json::parse(stream));
    if (!file) return Error{file.error().kind, fmt::format("{}: {}", name, file.error().message)};
    return file;
  } catch (const json::exception& e) {
    return invalid_input(fmt::format("{}: not valid JSON ({})", name, e.what()));
  }
}

Result<ProblemFile> read_problem(const std::filesystem::path& path) {
  return read_problem(path, path.string());
}

}  // namespace skinframe
