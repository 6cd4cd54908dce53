// SPDX-License-Identifier: Apache-2.0
#include "proto/metrics/process_metrics.h"

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <utility>

namespace skinframe::metrics {
namespace {

using prometheus::MetricFamily;
using prometheus::MetricType;

// The fields of /proc/self/stat behind the name in parentheses, which may hold anything; see proc(5).
struct Stat {
  double cpu_ticks = 0, start_ticks = 0, virtual_bytes = 0, resident_pages = 0;
};

Stat read_stat() {
  std::ifstream in("/proc/self/stat");
  std::string line;
  std::getline(in, line);
  std::istringstream fields(line.substr(line.rfind(')') + 2));
  Stat stat;
  std::string skipped;
  for (int field = 3; fields && field <= 24; ++field) {
    double value = 0;
    if (field == 3) {
      fields >> skipped;  // the state, a letter
      continue;
    }
    fields >> value;
    if (field == 14 || field == 15) stat.cpu_ticks += value;
    if (field == 22) stat.start_ticks = value;
    if (field == 23) stat.virtual_bytes = value;
    if (field == 24) stat.resident_pages = value;
  }
  return stat;
}

double boot_time() {
  std::ifstream in("/proc/stat");
  for (std::string word; in >> word;) {
    if (word != "btime") continue;
    double seconds = 0;
    in >> seconds;
    return seconds;
  }
  return 0;
}

double open_files() {
  std::error_code error;
  double count = 0;
  for (std::filesystem::directory_iterator at("/proc/self/fd", error), end; !error && at != end;
       at.increment(error))
    ++count;
  return count;
}

}  // namespace

MetricFamily family(const std::string& name, const std::string& help, MetricType type) {
  MetricFamily made;
  made.name = name;
  made.help = help;
  made.type = type;
  return made;
}

void add(MetricFamily& to, double value, std::vector<prometheus::ClientMetric::Label> labels) {
  prometheus::ClientMetric metric;
  metric.label = std::move(labels);
  (to.type == MetricType::Counter ? metric.counter.value : metric.gauge.value) = value;
  to.metric.push_back(std::move(metric));
}

std::vector<MetricFamily> ProcessMetrics::Collect() const {
  const Stat stat = read_stat();
  const auto ticks = static_cast<double>(::sysconf(_SC_CLK_TCK));
  const auto one = [](const char* name, const char* help, MetricType type, double value) {
    MetricFamily made = family(name, help, type);
    add(made, value);
    return made;
  };
  MetricFamily build =
      family("skinframe_build_info", "1; which program and version this is", MetricType::Gauge);
  add(build, 1, {{"program", program_}, {"version", SKINFRAME_VERSION}});
  return {std::move(build),
          one("process_resident_memory_bytes", "Memory in use", MetricType::Gauge,
              stat.resident_pages * static_cast<double>(::sysconf(_SC_PAGESIZE))),
          one("process_virtual_memory_bytes", "Address space", MetricType::Gauge, stat.virtual_bytes),
          one("process_cpu_seconds_total", "Processor time, user and system", MetricType::Counter,
              stat.cpu_ticks / ticks),
          one("process_open_fds", "Open files and connections", MetricType::Gauge, open_files()),
          one("process_start_time_seconds", "When it was started, since 1970", MetricType::Gauge,
              boot_time() + stat.start_ticks / ticks)};
}

}  // namespace skinframe::metrics
