// SPDX-License-Identifier: Apache-2.0
// Time as the server counts it: milliseconds of the system clock, since leases and deadlines must survive a
// restart. The clock is injected, so that no test sleeps.
#pragma once

#include <google/protobuf/duration.pb.h>
#include <google/protobuf/timestamp.pb.h>

#include <chrono>

namespace skinframe::server {

using Milliseconds = std::chrono::milliseconds;
using Time = std::chrono::sys_time<Milliseconds>;

class Clock {
 public:
  virtual ~Clock() = default;
  virtual Time now() const = 0;
};

class SystemClock final : public Clock {
 public:
  Time now() const override;
};

google::protobuf::Timestamp to_timestamp(Time time);
Time from_timestamp(const google::protobuf::Timestamp& timestamp);  // rounds down to a millisecond
google::protobuf::Duration to_duration(Milliseconds duration);
// Rounds down to a millisecond. The caller has checked the range (a protobuf duration may be 10,000 years).
Milliseconds from_duration(const google::protobuf::Duration& duration);

}  // namespace skinframe::server
