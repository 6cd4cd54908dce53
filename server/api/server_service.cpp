// SPDX-License-Identifier: Apache-2.0
#include "server/api/server_service.h"

#include <algorithm>

#include "server/api/answer.h"
#include "server/api/caller.h"

namespace skinframe::server {

grpc::ServerUnaryReactor* ServerService::GetServerInfo(grpc::CallbackServerContext* context,
                                                       const v1::GetServerInfoRequest*,
                                                       v1::ServerInfo* response) {
  return answer_on(parts_.executor, context, [=, this] { return tell(*context, *response); });
}

absl::Status ServerService::tell(const grpc::CallbackServerContext& context, v1::ServerInfo& response) {
  const auto tenant = tenant_of(parts_, context);
  if (!tenant.ok()) return tenant.status();
  ListQuery any;  // whether the store answers
  any.tenant = *tenant;
  any.limit = 1;
  if (const auto jobs = parts_.store.list(any); !jobs.ok()) return jobs.status();
  const auto artifacts = parts_.artifacts.of(*tenant);
  if (!artifacts.ok()) return artifacts.status();
  const auto free = (*artifacts)->bytes_free();
  if (!free.ok()) return free.status();
  const std::int64_t quota = parts_.tenants.rule_of(*tenant).most_artifact_bytes;
  if (quota != TenantRule::kNoLimit) {
    const auto used = (*artifacts)->bytes_used();
    if (!used.ok()) return used.status();
    response.set_artifact_bytes_left(std::max<std::int64_t>(0, quota - *used));
  }
  response.set_version(SKINFRAME_VERSION);
  response.set_tenant(*tenant);
  response.set_artifact_bytes_free(*free);
  response.set_workers_waiting(static_cast<std::int32_t>(parts_.desk.waiting()));
  response.set_store(store_);
  *response.mutable_time() = to_timestamp(parts_.clock.now());
  return absl::OkStatus();
}

}  // namespace skinframe::server
