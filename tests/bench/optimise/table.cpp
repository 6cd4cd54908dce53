// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/bench/optimise/table.h"

#include <fmt/format.h>

namespace skinframe::bench {
namespace {

template <class T>
std::string cell(const std::optional<T>& value, const char* format) {
  return value ? fmt::format(fmt::runtime(format), *value) : "-";
}

std::string ratio(const std::optional<double>& a, const std::optional<double>& b, const char* format) {
  if (!a || !b || !(*b > 0)) return "-";
  return fmt::format(fmt::runtime(format), *a / *b);
}

constexpr const char* kLine =
    "{:<22} {:<11} {:<8} {:>9} {:>9} {:>9} {:>7} {:>7} {:>7} {:>5} {:>5} {:>11} {:>9} {:>7} {:>7} {:>8} "
    "{:>6} {:>6}  "
    "{}\n";

}  // namespace

std::string table_head() {
  return fmt::format(fmt::runtime(kLine), "frame", "load", "method", "seconds", "CPU s", "solve s", "t/Ipo",
                     "CPU/Ipo", "sol/Ipo", "iter", "fact", "volume mm3", "V/Ipopt", "gap", "struts", "demand",
                     "KKT", "MB", "ending");
}

std::string table_line(const Row& row, const Row* ipopt) {
  const std::string load = row.force_n > 0 ? fmt::format("{} {:g} N", row.load, row.force_n) : row.load;
  const std::optional<double> gap = row.gap();
  return fmt::format(
      fmt::runtime(kLine), fmt::format("{} {}/{}", row.frame, row.nodes, row.struts), load, row.method,
      cell(row.seconds, "{:.3f}"), cell(row.cpu_seconds, "{:.3f}"), cell(row.solve_seconds, "{:.3f}"),
      ipopt ? ratio(row.seconds, ipopt->seconds, "{:.2f}") : "-",
      ipopt ? ratio(row.cpu_seconds, ipopt->cpu_seconds, "{:.2f}") : "-",
      ipopt ? ratio(row.solve_seconds, ipopt->solve_seconds, "{:.2f}") : "-", cell(row.iterations, "{}"),
      cell(row.factorisations, "{}"), cell(row.volume_mm3, "{:.1f}"),
      ipopt ? ratio(row.volume_mm3, ipopt->volume_mm3, "{:.7f}") : "-",
      gap ? fmt::format("{:.2f} %", 100 * *gap) : "-", cell(row.struts_left, "{}"),
      cell(row.worst_ratio, "{:.5f}"), cell(row.kkt_error, "{:.0e}"), cell(row.peak_mb, "{:.0f}"),
      row.status);
}

std::string stage_lines(const Row& row) {
  if (row.stages.size() != 4) return "";
  std::string text = fmt::format("    {} {} {}:", row.frame, row.load, row.method);
  const char* names[] = {"at lower bounds", "size", "topology", "geometry"};
  for (std::size_t i = 0; i < 4; ++i)
    text += fmt::format("{} {} {}/{} {:.0f} mm3", i == 0 ? "" : ",", names[i], row.stages[i].nodes,
                        row.stages[i].struts, row.stages[i].volume_mm3);
  if (row.relaxed_gap)
    text += fmt::format("; topology at most {:.1f} % above its bound", 100 * *row.relaxed_gap);
  return text + "\n";
}

std::string paper_lines() {
  return "    the paper's hanging ball (Table 2): 380/1949, topology 380/884, geometry 266/770; frame 37900 "
         "mm3 at first,\n"
         "    28750 mm3 in the end. Its body is not ours: the same kind, of about the same size, from figure "
         "7.\n";
}

}  // namespace skinframe::bench
