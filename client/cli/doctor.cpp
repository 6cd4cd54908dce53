// SPDX-License-Identifier: Apache-2.0
#include "client/cli/doctor.h"

#include <fmt/format.h>
#include <google/protobuf/util/time_util.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>

#include "client/cli/sibling.h"
#include "client/jobs/client.h"
#include "client/present/json.h"
#include "client/present/words.h"

namespace skinframe::client {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kMebibyte = 1024.0 * 1024.0;
// A result is some 60 MB a printer.
constexpr std::int64_t kLittleRoomBytes = std::int64_t{2} << 30;
constexpr std::int64_t kNoRoomBytes = std::int64_t{200} << 20;
// What a deadline of minutes or the order of two logs can bear; half a lease.
constexpr double kClockNoteSeconds = 2;
constexpr double kClockWrongSeconds = 10;

std::int64_t now_ms() {
  return std::chrono::duration_cast<std::chrono::milliseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

Finding room_finding(std::int64_t bytes) {
  return bytes < kNoRoomBytes ? Finding::kWrong : bytes < kLittleRoomBytes ? Finding::kNote : Finding::kWell;
}

std::string mib(std::int64_t bytes) {
  return fmt::format("{:.0f} MiB", static_cast<double>(bytes) / kMebibyte);
}

Examined examine_clock(const v1::ServerInfo& info, std::int64_t asked_ms, std::int64_t came_ms) {
  const std::int64_t server_ms = google::protobuf::util::TimeUtil::TimestampToMilliseconds(info.time());
  // The answer was given at some moment in between.
  const double ahead = static_cast<double>(server_ms - (asked_ms + came_ms) / 2) / 1000.0;
  const double unsure = static_cast<double>(came_ms - asked_ms) / 2000.0;
  const double least = std::max(0.0, std::abs(ahead) - unsure);
  const std::string says = fmt::format("the server's is {:.1f} s {} this machine's", std::abs(ahead),
                                       ahead < 0 ? "behind" : "ahead of");
  if (least >= kClockWrongSeconds)
    return {Finding::kWrong, "clock",
            says + "; set both by NTP: deadlines and times of events are the server's"};
  if (least >= kClockNoteSeconds) return {Finding::kNote, "clock", says + "; set both by NTP"};
  return {Finding::kWell, "clock", says};
}

Examined examine_way(const GlobalArguments& global, std::int64_t took_ms) {
  const std::string& address = global.server.address;
  const bool encrypted = !global.server.tls_ca.empty();
  const bool here =
      address.starts_with("127.") || address.starts_with("localhost:") || address.starts_with("[::1]");
  const std::string says =
      fmt::format("{} answers in {} ms, {}", address, took_ms, encrypted ? "over TLS" : "in the clear");
  if (!encrypted && !here && !global.server.token.empty())
    return {Finding::kWrong, "server", says + "; the token can be read on the way: give --tls-ca"};
  if (!encrypted && !here)
    return {Finding::kNote, "server", says + "; --tls-ca encrypts, where the server has TLS"};
  return {Finding::kWell, "server", says};
}

Examined examine_profiles(const v1::ListPrintersResponse& printers,
                          const v1::ListMaterialsResponse& materials) {
  const auto can_print = [&](const v1::PrinterProfile& printer) {
    return std::any_of(materials.materials().begin(), materials.materials().end(),
                       [&](const v1::MaterialProfile& m) {
                         return m.id() == printer.default_material_id() && m.has_shear_modulus_mpa() &&
                                m.has_tensile_modulus_mpa() && m.has_density_g_cm3();
                       });
  };
  const auto ready = std::count_if(printers.printers().begin(), printers.printers().end(), can_print);
  const std::string says =
      fmt::format("{} printers, {} materials; {} printers work with their default material",
                  printers.printers_size(), materials.materials_size(), ready);
  return {ready > 0 ? Finding::kWell : Finding::kWrong, "profiles",
          ready > 0 ? says : says + "; the server's --profiles folder must give what is missing"};
}

Examined examine_local_room() {
  std::error_code error;
  const auto space = std::filesystem::space(".", error);
  if (error) return {Finding::kNote, "disk here", "cannot be looked at: " + error.message()};
  const auto free = static_cast<std::int64_t>(space.available);
  return {room_finding(free), "disk here", fmt::format("{} free for results in this folder", mib(free))};
}

Examined examine_worker_program() {
  const auto program = worker_program();
  if (!program) return {Finding::kNote, "local verbs", program.failure().message};
  return {Finding::kWell, "local verbs", fmt::format("run in {}", program->string())};
}

const char* word(Finding finding) {
  return finding == Finding::kWell ? "ok" : finding == Finding::kNote ? "note" : "WRONG";
}

ExitCode report(const std::vector<Examined>& all, bool as_json, ExitCode code) {
  const bool wrong =
      std::any_of(all.begin(), all.end(), [](const Examined& one) { return one.finding == Finding::kWrong; });
  if (as_json) {
    Json list = Json::array();
    for (const Examined& one : all)
      list.push_back({{"what", one.what},
                      {"finding", one.finding == Finding::kWrong ? "wrong" : word(one.finding)},
                      {"says", one.says}});
    print_json({{"well", !wrong}, {"examined", std::move(list)}});
  } else {
    for (const Examined& one : all) fmt::print("{:<6}{:<12} {}\n", word(one.finding), one.what, one_line(one.says));
  }
  if (code != kExitSuccess) return code;
  return wrong ? kExitFailed : kExitSuccess;
}

}  // namespace

std::vector<Examined> examine(const v1::ServerInfo& info, std::int64_t asked_ms, std::int64_t came_ms) {
  std::vector<Examined> all;
  const bool same = info.version() == SKINFRAME_VERSION;
  all.push_back({same ? Finding::kWell : Finding::kNote, "version",
                 fmt::format("server {}, this program {}{}", info.version(), SKINFRAME_VERSION,
                             same ? "" : "; the newer of the two may offer what the other does not build")});
  all.push_back({Finding::kWell, "tenant",
                 fmt::format("you are \"{}\"; jobs are kept in {}", info.tenant(), info.store())});
  all.push_back(examine_clock(info, asked_ms, came_ms));
  all.push_back(
      {room_finding(info.artifact_bytes_free()), "disk there",
       fmt::format("{} free for meshes and results at the server", mib(info.artifact_bytes_free()))});
  if (info.has_artifact_bytes_left())
    all.push_back({room_finding(info.artifact_bytes_left()), "quota",
                   fmt::format("{} left of the tenant's bytes; deleted jobs give theirs back a day later",
                               mib(info.artifact_bytes_left()))});
  const bool some = info.workers_waiting() > 0;
  all.push_back(
      {some ? Finding::kWell : Finding::kNote, "workers",
       some ? fmt::format("{} wait for a job", info.workers_waiting())
            : std::string("none waits for a job here: all are busy, or none is started (skinframe-worker "
                          "--server ADDRESS)")});
  return all;
}

ExitCode doctor(const GlobalArguments& global) {
  std::vector<Examined> all{examine_local_room(), examine_worker_program()};
  const auto fail = [&](const Failure& failure) {
    all.push_back({Finding::kWrong, "server", failure.message});
    return report(all, global.json, exit_code(failure.kind));
  };
  const auto connection = connect(global.server);
  if (!connection) return fail(connection.failure());
  if (const auto first = server_info(*connection); !first)
    return fail(first.failure());  // opens the connection
  const std::int64_t asked = now_ms();
  const auto info = server_info(*connection);
  const std::int64_t came = now_ms();
  if (!info) return fail(info.failure());
  all.push_back(examine_way(global, came - asked));
  const auto told = examine(*info, asked, came);
  all.insert(all.end(), told.begin(), told.end());
  const auto known_printers = list_printers(*connection);
  if (!known_printers) return fail(known_printers.failure());
  const auto known_materials = list_materials(*connection);
  if (!known_materials) return fail(known_materials.failure());
  all.push_back(examine_profiles(*known_printers, *known_materials));
  return report(all, global.json, kExitSuccess);
}

}  // namespace skinframe::client
