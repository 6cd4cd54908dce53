// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/clock.h"

namespace skinframe::server {

using std::chrono::duration_cast;
using std::chrono::nanoseconds;
using std::chrono::seconds;

Time SystemClock::now() const { return std::chrono::floor<Milliseconds>(std::chrono::system_clock::now()); }

google::protobuf::Timestamp to_timestamp(Time time) {
  const auto whole = std::chrono::floor<seconds>(time);
  google::protobuf::Timestamp timestamp;
  timestamp.set_seconds(whole.time_since_epoch().count());
  timestamp.set_nanos(static_cast<int>(duration_cast<nanoseconds>(time - whole).count()));
  return timestamp;
}

Time from_timestamp(const google::protobuf::Timestamp& timestamp) {
  return Time(seconds(timestamp.seconds()) +
              std::chrono::floor<Milliseconds>(nanoseconds(timestamp.nanos())));
}

google::protobuf::Duration to_duration(Milliseconds duration) {
  google::protobuf::Duration result;
  const auto whole = duration_cast<seconds>(duration);
  result.set_seconds(whole.count());
  result.set_nanos(static_cast<int>(duration_cast<nanoseconds>(duration - whole).count()));
  return result;
}

Milliseconds from_duration(const google::protobuf::Duration& duration) {
  return seconds(duration.seconds()) + std::chrono::floor<Milliseconds>(nanoseconds(duration.nanos()));
}

}  // namespace skinframe::server
