// SPDX-License-Identifier: Apache-2.0
// The HTTP endpoint of a program's metrics: GET /metrics in Prometheus' text format, 404 for all else. Plain
// HTTP without any proof of who asks: it shows figures and no content of jobs, and belongs on a loopback or
// monitoring network.
//
// Guarantees: one thread and at most 32 connections, each for at most 5 s and one request of 8 KiB; so
// whoever hangs on, or sends nonsense, costs neither the program nor the next scrape more than that.
#pragma once

#include <prometheus/collectable.h>
#include <prometheus/metric_family.h>

#include <memory>
#include <string>
#include <vector>

namespace skinframe::metrics {

// What an endpoint shows: each is asked at each scrape, on the endpoint's thread.
using Sources = std::vector<std::shared_ptr<const prometheus::Collectable>>;

class MetricsListener {
 public:
  // "HOST:PORT", "[::1]:PORT" or "PORT", which is 127.0.0.1; port 0 takes a free one. Throws
  // std::runtime_error with a sentence for people: not such an address, or it cannot be listened on.
  MetricsListener(const std::string& address, Sources sources);
  ~MetricsListener();
  MetricsListener(const MetricsListener&) = delete;
  MetricsListener& operator=(const MetricsListener&) = delete;

  const std::string& address() const { return address_; }  // host:port as bound

 private:
  struct Service;
  std::unique_ptr<Service> service_;
  std::string address_;
};

}  // namespace skinframe::metrics
