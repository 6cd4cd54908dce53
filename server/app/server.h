// SPDX-License-Identifier: Apache-2.0
// The whole server as a value: started when it exists, stopped when it goes. main() and the tests use the
// same one.
#pragma once

#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "server/app/options.h"
#include "server/jobs/clock.h"
#include "server/jobs/job_id.h"

namespace skinframe::server {

class Server {
 public:
  // Opens store and artifacts, and listens. The clock outlives the server; background duties run on it.
  static absl::StatusOr<std::unique_ptr<Server>> start(const ServerOptions& options, const Clock& clock,
                                                       IdGenerator& ids);
  ~Server();  // stops
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  const std::string& address() const;  // host:port as bound

  // Reads the profile folder and the tenants file again, where there are such: within a tenth of a second.
  // What is bad changes nothing.
  void reload();

  // Takes no new calls (UNAVAILABLE); ends watches and waiting leases with UNAVAILABLE, to go on elsewhere or
  // later; gives calls under way the time of --drain. What was acknowledged is durable with or without it.
  void stop();

 private:
  struct Rooms;
  explicit Server(std::unique_ptr<Rooms> rooms);
  std::unique_ptr<Rooms> rooms_;
};

}  // namespace skinframe::server
