// SPDX-License-Identifier: Apache-2.0
#include "client/cli/verbs.h"

#include <fmt/format.h>

#include <algorithm>

#include "client/cli/follow.h"
#include "client/jobs/client.h"
#include "client/present/json.h"
#include "client/present/profile_table.h"
#include "client/present/words.h"

namespace skinframe::client {
namespace {

template <class Profiles>
ExitCode show_profile(const char* kind, const Profiles& profiles, const std::string& id, bool json) {
  const auto at = std::find_if(profiles.begin(), profiles.end(), [&](const auto& p) { return p.id() == id; });
  if (at == profiles.end()) {
    std::string known;
    for (const auto& profile : profiles) known += (known.empty() ? "" : ", ") + one_line(profile.id());
    return tell(
        {FailureKind::kUsage, fmt::format("unknown {} \"{}\"; known: {}", kind, one_line(id), known)});
  }
  if (json) {
    print_json(profile_file(*at));
  } else {
    fmt::print("{}", profile_sheet(*at));
  }
  return kExitSuccess;
}

}  // namespace

ExitCode printers(const GlobalArguments& global, const std::string& id) {
  const auto connection = connect(global.server);
  if (!connection) return tell(connection.failure());
  const auto all = list_printers(*connection);
  if (!all) return tell(all.failure());
  if (!id.empty()) return show_profile("printer", all->printers(), id, global.json);
  if (global.json) {
    print_json(to_json(*all));
  } else {
    fmt::print("{}", printer_list(*all));
  }
  return kExitSuccess;
}

ExitCode materials(const GlobalArguments& global, const std::string& id) {
  const auto connection = connect(global.server);
  if (!connection) return tell(connection.failure());
  const auto all = list_materials(*connection);
  if (!all) return tell(all.failure());
  if (!id.empty()) return show_profile("material", all->materials(), id, global.json);
  if (global.json) {
    print_json(to_json(*all));
  } else {
    fmt::print("{}", material_list(*all));
  }
  return kExitSuccess;
}

}  // namespace skinframe::client
