// SPDX-License-Identifier: Apache-2.0
// What every program tells of itself, read from /proc at each scrape, under the names that Prometheus' own
// libraries use; and which program and version it is.
#pragma once

#include <prometheus/collectable.h>
#include <prometheus/metric_family.h>

#include <string>
#include <vector>

namespace skinframe::metrics {

class ProcessMetrics final : public prometheus::Collectable {
 public:
  // program: "server" or "worker".
  explicit ProcessMetrics(std::string program) : program_(std::move(program)) {}
  std::vector<prometheus::MetricFamily> Collect() const override;

 private:
  const std::string program_;
};

// A family of one kind with one figure, or with none yet.
prometheus::MetricFamily family(const std::string& name, const std::string& help,
                                prometheus::MetricType type);

// Adds a gauge's or counter's figure to its family.
void add(prometheus::MetricFamily& to, double value,
         std::vector<prometheus::ClientMetric::Label> labels = {});

}  // namespace skinframe::metrics
