// SPDX-License-Identifier: Apache-2.0
#include "server/app/server.h"

#include <fmt/format.h>
#include <grpcpp/ext/proto_server_reflection_plugin.h>
#include <grpcpp/grpcpp.h>
#include <grpcpp/health_check_service_interface.h>
#include <grpcpp/resource_quota.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <optional>
#include <utility>
#include <vector>

#include "proto/metrics/metrics_listener.h"
#include "proto/metrics/process_metrics.h"
#include "server/api/artifact_service.h"
#include "server/api/catalog_service.h"
#include "server/api/job_service.h"
#include "server/api/server_service.h"
#include "server/api/worker_service.h"
#include "server/app/commit_bell.h"
#include "server/app/data_folder.h"
#include "server/app/listen_address.h"
#include "server/app/profile_watch.h"
#include "server/app/tenants_watch.h"
#include "server/leases/deadline_watch.h"
#include "server/leases/duty_runner.h"
#include "server/leases/lease_reaper.h"
#include "server/metrics/job_counts.h"
#include "server/metrics/queue_figures.h"
#include "server/metrics/rpc_times.h"
#include "server/replicas/progress_follower.h"
#include "server/retention/artifact_cleaner.h"
#include "server/retention/checkpoint_cleaner.h"
#include "server/retention/job_retention.h"
#include "server/retention/progress_thinning.h"
#include "server/store/postgres_store.h"
#include "server/store/sqlite_store.h"

namespace skinframe::server {
namespace {

constexpr int kExecutorThreads = 32;  // as many writes as one commit can hold
constexpr std::size_t kMostWatchers = 10'000;
constexpr Milliseconds kDutyPause{100};
constexpr Milliseconds kFollowEvery{500};  // progress that another server wrote is seen so late at most
constexpr Milliseconds kHour{3'600'000};
constexpr Milliseconds kDay = 24 * kHour;
constexpr Milliseconds kRetentionEvery{60'000};
constexpr Milliseconds kUnused = kDay;  // an upload waits so long for its submission
constexpr Milliseconds kCleanEvery{3'600'000};
constexpr Milliseconds kCheckpointsEvery{10'000};
constexpr Milliseconds kCheckpointGrace{60'000};
constexpr Milliseconds kReloadEvery{1'000};  // a look at the profiles and the tenants
constexpr int kDatabaseSessions = 16;
constexpr int kLargestMessageBytes = 4 << 20;
constexpr const char* kServices[] = {"skinframe.v1.JobService", "skinframe.v1.ArtifactService",
                                     "skinframe.v1.CatalogService", "skinframe.v1.WorkerService",
                                     "skinframe.v1.ServerService"};

// 2000 watches on one channel have room beside the calls of a farm's software.
constexpr int kMostStreamsOfAConnection = 4'096;
// For what gRPC buffers, over all connections; near it reads slow down and new connections are refused.
constexpr std::size_t kCallMemoryBytes = std::size_t{512} << 20;

// A partition is noticed within some 15 s on this side, and clients may ping every 5 s, calls or none,
// without being thrown out. One port belongs to one server.
void set_connection_rules(grpc::ServerBuilder& builder) {
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIME_MS, 10'000);
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, 5'000);
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_PERMIT_WITHOUT_CALLS, 1);
  builder.AddChannelArgument(GRPC_ARG_HTTP2_MAX_PINGS_WITHOUT_DATA, 0);
  builder.AddChannelArgument(GRPC_ARG_HTTP2_MIN_RECV_PING_INTERVAL_WITHOUT_DATA_MS, 1'000);
  builder.AddChannelArgument(GRPC_ARG_ALLOW_REUSEPORT, 0);
  builder.AddChannelArgument(GRPC_ARG_MAX_CONCURRENT_STREAMS, kMostStreamsOfAConnection);
  builder.SetMaxReceiveMessageSize(kLargestMessageBytes);
  grpc::ResourceQuota memory("skinframe-server");
  builder.SetResourceQuota(memory.Resize(kCallMemoryBytes));
}

absl::StatusOr<std::shared_ptr<grpc::ServerCredentials>> credentials(const ServerOptions& options) {
  if (options.tls_cert.empty()) return grpc::InsecureServerCredentials();
  auto certificate = read_whole_file(options.tls_cert);
  if (!certificate.ok()) return certificate.status();
  auto key = read_whole_file(options.tls_key);
  if (!key.ok()) return key.status();
  // Whoever shows no certificate may still be known by token or address: that is the tenants' file's to say.
  grpc::SslServerCredentialsOptions tls(options.client_ca.empty()
                                            ? GRPC_SSL_DONT_REQUEST_CLIENT_CERTIFICATE
                                            : GRPC_SSL_REQUEST_CLIENT_CERTIFICATE_AND_VERIFY);
  if (!options.client_ca.empty()) {
    auto authority = read_whole_file(options.client_ca);
    if (!authority.ok()) return authority.status();
    tls.pem_root_certs = *std::move(authority);
  }
  tls.pem_key_cert_pairs.push_back({*std::move(key), *std::move(certificate)});
  return grpc::SslServerCredentials(tls);
}

}  // namespace

// In the order in which each needs those before it.
struct Server::Rooms {
  Rooms(DataFolder locked, TenantsConfig callers, const ServerOptions& options, Catalog known)
      : folder(std::move(locked)),
        tenants(std::move(callers)),
        policy(options.policy),
        drain(options.drain),
        catalog(std::move(known)) {}

  DataFolder folder;
  TenantDirectory tenants;
  AttemptPolicy policy;
  Milliseconds drain;
  LiveCatalog catalog;
  std::shared_ptr<prometheus::Registry> registry = std::make_shared<prometheus::Registry>();
  JobCounts counts{*registry};
  WatchHub hub{kMostWatchers};
  CommitBell bell{hub, counts};
  std::unique_ptr<TenantArtifacts> artifacts;
  std::unique_ptr<JobStore> store;
  EventPages pages{hub, [this](const std::string& job_id, std::int64_t after_sequence, int limit) {
                     return store->events(job_id, after_sequence, limit);
                   }};
  Executor executor{kExecutorThreads};
  std::optional<LeaseDesk> desk;
  std::optional<LeaseReaper> reaper;
  std::optional<DeadlineWatch> deadlines;
  std::optional<ProgressFollower> follower;  // where other servers share the store
  std::optional<JobRetention> retention;
  std::optional<ProgressThinning> thinning;
  std::optional<ArtifactCleaner> cleaner;
  std::optional<CheckpointCleaner> checkpoint_cleaner;
  std::optional<ProfileWatch> profile_watch;  // where the operator has a folder
  std::optional<TenantsWatch> tenants_watch;  // where the operator has a file
  std::optional<DutyRunner> duties;
  std::optional<JobService> jobs;
  std::optional<ArtifactService> files;
  std::optional<CatalogService> profiles;
  std::optional<WorkerService> workers;
  std::optional<ServerService> info;
  std::unique_ptr<grpc::Server> grpc_server;
  std::string address;
  std::unique_ptr<metrics::MetricsListener> metrics_listener;  // where the operator wants them

  absl::Status open(const ServerOptions& options, const Clock& clock, IdGenerator& ids);
  absl::Status listen(const ServerOptions& options);
  absl::Status show_metrics(const ServerOptions& options, const Clock& clock);
};

absl::Status Server::Rooms::open(const ServerOptions& options, const Clock& clock, IdGenerator& ids) {
  auto opened_artifacts = TenantArtifacts::open(
      options.artifacts.empty() ? folder.artifacts() : options.artifacts, kDefaultTenant, ArtifactLimits{});
  if (!opened_artifacts.ok()) return opened_artifacts.status();
  artifacts = *std::move(opened_artifacts);
  auto opened_store = options.store_is_postgres()
                          ? open_postgres_store({options.store, kDatabaseSessions}, &bell)
                          : open_sqlite_store(folder.store_file(), &bell);
  if (!opened_store.ok()) return opened_store.status();
  store = *std::move(opened_store);

  desk.emplace(*store, executor, clock, policy, tenants);
  bell.connect(&*desk);
  reaper.emplace(*store, policy, clock.now());
  deadlines.emplace(*store);

  const Parts parts{*store, *artifacts, tenants, catalog, hub,    pages,
                    *desk,  executor,   clock,   ids,     policy, options.queue_limit};
  jobs.emplace(parts);
  files.emplace(parts);
  profiles.emplace(catalog);
  workers.emplace(parts);
  info.emplace(parts, options.store_is_postgres() ? "postgresql" : "sqlite");
  std::vector<Duty*> all{&*reaper, &*deadlines, &*desk};
  if (options.store_is_postgres()) all.push_back(&follower.emplace(*store, hub, kFollowEvery));
  if (options.keep_jobs_days > 0)
    all.push_back(&retention.emplace(*store, options.keep_jobs_days * kDay, kRetentionEvery));
  if (options.keep_progress_hours > 0)
    all.push_back(&thinning.emplace(*store, options.keep_progress_hours * kHour, kRetentionEvery));
  all.push_back(&cleaner.emplace(*store, *artifacts, kUnused, kCleanEvery));
  all.push_back(&checkpoint_cleaner.emplace(*store, *artifacts, kCheckpointsEvery, kCheckpointGrace));
  if (!options.profiles.empty())
    all.push_back(&profile_watch.emplace(options.profiles, catalog, kReloadEvery));
  if (!options.tenants.empty()) all.push_back(&tenants_watch.emplace(options.tenants, tenants, kReloadEvery));
  duties.emplace(clock, all, kDutyPause);
  return absl::OkStatus();
}

absl::Status Server::Rooms::listen(const ServerOptions& options) {
  grpc::EnableDefaultHealthCheckService(true);
  grpc::reflection::InitProtoReflectionServerBuilderPlugin();
  const auto allowed = credentials(options);
  if (!allowed.ok()) return allowed.status();
  grpc::ServerBuilder builder;
  set_connection_rules(builder);
  int port = 0;
  builder.AddListeningPort(options.listen, *allowed, &port);
  builder.RegisterService(&*jobs);
  builder.RegisterService(&*files);
  builder.RegisterService(&*profiles);
  builder.RegisterService(&*workers);
  builder.RegisterService(&*info);
  if (!options.metrics.empty()) {
    std::vector<std::unique_ptr<grpc::experimental::ServerInterceptorFactoryInterface>> interceptors;
    interceptors.push_back(std::make_unique<RpcTimes>(*registry));
    builder.experimental().SetInterceptorCreators(std::move(interceptors));
  }
  grpc_server = builder.BuildAndStart();
  if (grpc_server == nullptr || port == 0) {
    grpc_server.reset();
    return absl::UnavailableError(
        fmt::format("cannot listen on {}: the address is in use or not this machine's{}", options.listen,
                    options.tls_cert.empty() ? "" : ", or the TLS files are not a certificate and its key"));
  }
  for (const char* service : kServices) grpc_server->GetHealthCheckService()->SetServingStatus(service, true);
  address = with_port(options.listen, port);
  return absl::OkStatus();
}

absl::Status Server::Rooms::show_metrics(const ServerOptions& options, const Clock& clock) {
  if (options.metrics.empty()) return absl::OkStatus();
  try {
    metrics_listener = std::make_unique<metrics::MetricsListener>(
        options.metrics,
        metrics::Sources{registry, std::make_shared<QueueFigures>(*store, hub, *desk, *reaper, clock),
                         std::make_shared<metrics::ProcessMetrics>("server")});
  } catch (const std::runtime_error& error) {
    return absl::UnavailableError(fmt::format("--metrics: {}", error.what()));
  }
  spdlog::info("metrics at http://{}/metrics", metrics_listener->address());
  return absl::OkStatus();
}

absl::StatusOr<std::unique_ptr<Server>> Server::start(const ServerOptions& options, const Clock& clock,
                                                      IdGenerator& ids) {
  if (auto status = options.validate(); !status.ok()) return status;
  auto folder = DataFolder::lock(options.data);
  if (!folder.ok()) return folder.status();
  auto known = options.profiles.empty() ? built_in_catalog() : load_catalog(options.profiles);
  if (!known.ok()) return known.status();
  auto tenants = options.tenants.empty() ? one_tenant_for_all() : read_tenants(options.tenants);
  if (!tenants.ok()) return tenants.status();
  std::unique_ptr<Server> server(new Server(
      std::make_unique<Rooms>(*std::move(folder), *std::move(tenants), options, *std::move(known))));
  if (auto status = server->rooms_->open(options, clock, ids); !status.ok()) return status;
  if (auto status = server->rooms_->listen(options); !status.ok()) return status;
  if (auto status = server->rooms_->show_metrics(options, clock); !status.ok()) return status;
  if (!options.port_file.empty()) {
    auto status = write_file_at_once(options.port_file, server->address() + "\n");
    if (!status.ok()) return status;
  }
  return server;
}

Server::Server(std::unique_ptr<Rooms> rooms) : rooms_(std::move(rooms)) {}

Server::~Server() { stop(); }

const std::string& Server::address() const { return rooms_->address; }

void Server::reload() {
  if (rooms_->profile_watch) rooms_->profile_watch->reload();
  if (rooms_->tenants_watch) rooms_->tenants_watch->reload();
}

void Server::stop() {
  rooms_->duties.reset();
  if (rooms_->desk) rooms_->desk->close();
  rooms_->hub.close();
  if (rooms_->grpc_server != nullptr) {
    rooms_->grpc_server->GetHealthCheckService()->SetServingStatus(false);
    rooms_->grpc_server->Shutdown(std::chrono::system_clock::now() + rooms_->drain);
    rooms_->grpc_server->Wait();
    rooms_->grpc_server.reset();
  }
  rooms_->executor.stop();
  rooms_->metrics_listener.reset();
}

}  // namespace skinframe::server
