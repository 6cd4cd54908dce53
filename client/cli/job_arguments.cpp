// SPDX-License-Identifier: Apache-2.0
#include "client/cli/job_arguments.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>

#include "client/cli/load_option.h"
#include "client/transfer/input_kind.h"

namespace skinframe::client {
namespace {

template <class Enum>
using Words = std::map<std::string, Enum>;

const Words<v1::Axis> kAxes = {{"x", v1::AXIS_X}, {"y", v1::AXIS_Y}, {"z", v1::AXIS_Z}};
const Words<v1::Balance> kBalances = {
    {"auto", v1::BALANCE_AUTO}, {"require", v1::BALANCE_REQUIRE}, {"off", v1::BALANCE_OFF}};
const Words<v1::Smooth> kSmooths = {
    {"auto", v1::SMOOTH_AUTO}, {"on", v1::SMOOTH_ON}, {"off", v1::SMOOTH_OFF}};
const Words<v1::Orient> kOrients = {{"keep", v1::ORIENT_KEEP}, {"best", v1::ORIENT_BEST}};
const Words<v1::Verify> kVerifies = {{"on", v1::VERIFY_ON}, {"off", v1::VERIFY_OFF}};
const Words<v1::StageOrder> kOrders = {{"tight", v1::STAGE_ORDER_TIGHT}, {"paper", v1::STAGE_ORDER_PAPER}};

template <class Enum>
CLI::IsMember one_of(const Words<Enum>& words) {
  std::vector<std::string> names;
  for (const auto& [name, value] : words) names.push_back(name);
  return CLI::IsMember(names);
}

// The flag's validator has let through only words of the map.
template <class Enum>
Enum value_of(const Words<Enum>& words, const std::string& word) {
  const auto it = words.find(word);
  return it == words.end() ? Enum{} : it->second;
}

v1::JobOptions options_of(const JobArguments& a) {
  v1::JobOptions out;
  out.set_up(value_of(kAxes, a.up));
  out.set_balance(value_of(kBalances, a.balance));
  out.set_smooth(value_of(kSmooths, a.smooth));
  out.set_orient(value_of(kOrients, a.orient));
  out.set_order(value_of(kOrders, a.order));
  out.set_no_optimize(a.no_optimize);
  out.set_verify(value_of(kVerifies, a.verify));
  if (a.size_mm) out.set_size_mm(*a.size_mm);
  if (a.skin_nodes) out.set_skin_nodes(*a.skin_nodes);
  if (a.internal_nodes) out.set_internal_nodes(*a.internal_nodes);
  if (a.voxel_mm) out.set_voxel_mm(*a.voxel_mm);
  if (a.displacement_limit_mm) out.set_displacement_limit_mm(*a.displacement_limit_mm);
  if (a.seed) out.set_seed(*a.seed);
  return out;
}

// The name of the file, cut to what the API takes.
std::string mesh_name(const std::string& path) {
  std::string name = std::filesystem::path(path).filename().string();
  if (name.size() > 255) name.resize(255);
  for (char& c : name) {
    if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) > 0x7E)
      c = '?';  // may not be UTF-8
  }
  return name;
}

}  // namespace

void add_job_options(CLI::App& verb, JobArguments& a) {
  verb.add_option("FILE", a.mesh,
                  "Mesh (STL, OBJ, PLY or OFF), or a frame problem (JSON), which takes no option of a mesh")
      ->required();
  verb.add_option("--printer", a.printers,
                  "Printer id (see `skinframe printers`); repeat for several; a mesh needs one at least")
      ->allow_extra_args(false);
  verb.add_option("--material", a.materials,
                  "Material id, one for all printers or one for each; the printer's default")
      ->allow_extra_args(false);
  verb.add_option("--size", a.size_mm,
                  "Scale the largest edge of the bounding box to MM; file units are mm otherwise");
  verb.add_option(
          "--load", a.loads,
          "External force NAME:WHERE:FX,FY,FZ[:RADIUS] in N and mm; WHERE = top, bottom, left, right, front, "
          "back or x,y,z; loads of one NAME act together")
      ->allow_extra_args(false);
  verb.add_option("--up", a.up, "Axis of the file that points up (default z)")->check(one_of(kAxes));
  verb.add_option("--balance", a.balance, "Keep it standing: when the solid stands (auto), always, never")
      ->check(one_of(kBalances));
  verb.add_option("--skin-nodes", a.skin_nodes, "Nodes on the skin, 12 .. 20000");
  verb.add_option("--internal-nodes", a.internal_nodes, "Nodes inside, 0 .. 20000");
  verb.add_option("--voxel", a.voxel_mm, "Voxel of the final solid in mm, 0.02 .. 5");
  verb.add_option(
          "--smooth", a.smooth,
          "Offset the cavity from a smooth copy: on, off, or auto where detail is finer than the skin")
      ->check(one_of(kSmooths));
  verb.add_option("--orient", a.orient, "Keep the orientation or search the best")->check(one_of(kOrients));
  verb.add_flag("--no-optimize", a.no_optimize, "Radii stay at their lower bounds");
  verb.add_option(
          "--verify", a.verify,
          "Analyse the result by a valid model too (shell and struts with rotations): displacement, stress, "
          "buckling, a pinch of 10 N, beside a hollow of equal mass and the solid; on, or off, which saves "
          "some "
          "seconds a printer (default on)")
      ->check(one_of(kVerifies));
  verb.add_option("--order", a.order, "Order of the optimiser's stages")->check(one_of(kOrders));
  verb.add_option("--displacement-limit", a.displacement_limit_mm,
                  "Largest displacement in mm (default 0.05)");
  verb.add_option("--seed", a.seed, "Same seed, same result (default 1)");
  verb.add_option("--warm-start", a.warm_start,
                  "Start from the frame of that earlier JOB of the same mesh, wherever it still fits");
  verb.add_flag("--no-reuse", a.no_reuse, "Run the job also where an earlier one has made the same already");
  verb.add_option("--label", a.labels, "KEY=VALUE, to find the job by; repeatable")->allow_extra_args(false);
  verb.add_option("--priority", a.priority, "-100 .. 100, higher runs earlier");
  verb.add_option("--deadline", a.deadline, "Give up after that time from submission: 90s, 15m, 2h");
}

Result<v1::SubmitJobRequest> to_request(const JobArguments& a) {
  v1::SubmitJobRequest request;
  request.set_request_id(a.request_id);
  request.set_validate_only(a.validate_only);
  request.set_no_reuse(a.no_reuse);
  v1::JobSpec& spec = *request.mutable_spec();
  spec.set_mesh_name(mesh_name(a.mesh));
  if (a.printers.empty() && input_kind(a.mesh) == InputKind::kMesh) {
    return Failure{
        FailureKind::kUsage,
        "--printer is required with a mesh; `skinframe printers` lists those that the server knows"};
  }
  if (a.materials.size() > 1 && a.materials.size() != a.printers.size()) {
    return Failure{FailureKind::kUsage,
                   fmt::format("--material is given {} times for {} printers; give it once for all "
                               "of them, or once for each, in order",
                               a.materials.size(), a.printers.size())};
  }
  for (std::size_t i = 0; i < a.printers.size(); ++i) {
    v1::PrinterRequest& printer = *spec.add_printers();
    printer.set_printer_id(a.printers[i]);
    if (!a.materials.empty()) printer.set_material_id(a.materials[a.materials.size() == 1 ? 0 : i]);
  }
  for (const std::string& text : a.loads) {
    auto load = parse_load(text);
    if (!load) return load.failure();
    *spec.add_loads() = *std::move(load);
  }
  *spec.mutable_options() = options_of(a);
  spec.set_warm_start_job_id(a.warm_start);
  for (const std::string& text : a.labels) {
    auto label = parse_label(text);
    if (!label) return label.failure();
    (*spec.mutable_labels())[label->first] = label->second;
  }
  spec.set_priority(a.priority);
  if (!a.deadline.empty()) {
    auto deadline = parse_deadline(a.deadline);
    if (!deadline) return deadline.failure();
    *spec.mutable_deadline() = *std::move(deadline);
  }
  return request;
}

}  // namespace skinframe::client
