// SPDX-License-Identifier: GPL-3.0-or-later
// The stages of the geometry on one body: seconds, peak memory, triangles, and the error against voxels of
// half the width. One body a process, so that the peak is its own:
//   skinframe_bench_geometry MESH SIZE_MM [THREADS [times]]
// With "times" it leaves the error out.
// Prints one line a stage and ends with 1 when a stage fails. Radii stand at their lower bounds.
#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "worker/export/compact_mesh.h"
#include "worker/export/crossings.h"
#include "worker/export/write_3mf.h"
#include "worker/frame/sample_frame.h"
#include "worker/mesh/read_mesh.h"
#include "worker/mesh/write_stl.h"
#include "worker/skin/build_skin.h"
#include "worker/solid/place.h"
#include "worker/solid/repair.h"

namespace {

using namespace skinframe;

constexpr double kEtaMm = 0.5;  // of the powder printer

double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double cpu_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) { return static_cast<double>(t.tv_sec) + 1e-6 * t.tv_usec; };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

double peak_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

class Stages {
 public:
  void done(const char* stage, const std::string& what) {
    const double wall = wall_seconds(), cpu = cpu_seconds();
    fmt::print("{:<10} {:>7.2f} {:>7.2f} {:>7.0f}  {}\n", stage, wall - wall_, cpu - cpu_, peak_mb(), what);
    wall_ = wall;
    cpu_ = cpu;
  }

 private:
  double wall_ = wall_seconds(), cpu_ = cpu_seconds();
};

[[noreturn]] void give_up(const std::string& why) {
  fmt::print(stderr, "bench: {}\n", why);
  std::exit(1);
}

template <class T>
T take(Result<T> result) {
  if (!result) give_up(result.error().message);
  return std::move(result).value();
}

// Of the paper's powder printer and its material.
FrameOptions frame_options() {
  FrameOptions options;
  options.plate.tensile_modulus_mpa = 1586;
  options.plate.displacement_limit_mm = 0.05;
  options.strut_radius_mm = kEtaMm;
  return options;
}

void run(const std::filesystem::path& path, double size_mm, int threads, bool times_only) {
  RunContext context;
  context.threads = threads;
  const auto folder = std::filesystem::temp_directory_path() / fmt::format("skinframe-bench-{}", getpid());
  std::filesystem::create_directories(folder);
  fmt::print("{} at {:g} mm, {} threads\n{:<10} {:>7} {:>7} {:>7}\n", path.filename().string(), size_mm,
             threads, "stage", "wall s", "cpu s", "peak MB");
  const double cpu_before = cpu_seconds(), wall_before = wall_seconds();
  Stages stages;
  auto file = take(read_mesh(path, {}, context));
  stages.done("read", fmt::format("{} triangles", file.mesh.triangles.size()));
  const auto solid =
      take(repair(put_on_plate(scale_to_largest_edge(std::move(file.mesh), size_mm)), {}, context)).solid;
  stages.done("repair", fmt::format("{:.0f} mm3", solid.volume_mm3()));
  const auto skin = take(build_skin(solid, {.thickness_mm = 2 * kEtaMm}, context));
  stages.done("skin", fmt::format("voxel {:.3f} mm, cavity {:.0f} mm3, thin {:.4f} of the volume",
                                  skin.voxel_mm, skin.cavity_volume_mm3, skin.thin.fraction));
  const auto sampled = take(sample_frame(skin, frame_options(), context));
  stages.done("sample",
              fmt::format("{} nodes, {} struts", sampled.frame.nodes_mm.size(), sampled.frame.struts.size()));
  const std::vector<double> radii(sampled.frame.struts.size(), kEtaMm);
  const auto printable = take(merge_solid(solid, skin, sampled.frame, radii, {}, context));
  std::string steps;
  for (const auto& [step, seconds] : printable.seconds) steps += fmt::format(", {} {:.2f}", step, seconds);
  stages.done("merge", fmt::format("{} triangles{}", printable.mesh.triangles.size(), steps));
  take(write_stl(printable.mesh, folder / "a.stl"));
  stages.done("stl", fmt::format("{} bytes", std::filesystem::file_size(folder / "a.stl")));
  take(write_3mf(printable.mesh, {"skin-frame", "bench", ""}, folder / "a.3mf"));
  stages.done("3mf", fmt::format("{} bytes", std::filesystem::file_size(folder / "a.3mf")));
  const auto compact = take(make_compact(printable, solid.mesh().triangles.size(), {}, context));
  stages.done("compact", fmt::format("{} triangles, {:.3f} mm off", compact.mesh.triangles.size(),
                                     compact.deviation_mm));
  fmt::print("{:<10} {:>7.2f} {:>7.2f} {:>7.0f}\n", "all", wall_seconds() - wall_before,
             cpu_seconds() - cpu_before, peak_mb());
  std::filesystem::remove_all(folder);

  if (times_only) return;
  // What it is worth: not part of the times above.
  const auto finer =
      take(build_skin(solid, {.thickness_mm = 2 * kEtaMm, .voxel_mm = 0.5 * skin.voxel_mm}, context));
  fmt::print(
      "error      cavity {:+.4f} % against voxels of {:.3f} mm; {} of the printable mesh's triangles cross, "
      "{} of "
      "the input's\n",
      100 * (skin.cavity_volume_mm3 / finer.cavity_volume_mm3 - 1), finer.voxel_mm,
      crossing_triangles(printable.mesh).size(), crossing_triangles(solid.mesh()).size());
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) give_up("usage: skinframe_bench_geometry MESH SIZE_MM [THREADS [times]]");
  run(argv[1], std::atof(argv[2]), argc > 3 ? std::max(1, std::atoi(argv[3])) : 2,
      argc > 4 && std::string(argv[4]) == "times");
  return 0;
}
