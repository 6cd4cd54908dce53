// SPDX-License-Identifier: Apache-2.0
#include "client/cli/verbs.h"

#include <fmt/format.h>

#include "client/cli/follow.h"
#include "client/cli/interrupts.h"
#include "client/cli/load_option.h"
#include "client/jobs/client.h"
#include "client/jobs/watch.h"
#include "client/present/job_table.h"
#include "client/present/json.h"
#include "client/present/words.h"
#include "client/transfer/download.h"

namespace skinframe::client {

using Json = nlohmann::ordered_json;

ExitCode get(const GlobalArguments& global, const std::string& job_id) {
  const auto connection = connect(global.server);
  if (!connection) return tell(connection.failure());
  const auto job = get_job(*connection, job_id);
  if (!job) return tell(job.failure());
  if (global.json) {
    print_json(to_json(*job));
  } else {
    fmt::print("{}", job_description(*job));
  }
  return kExitSuccess;
}

ExitCode list(const GlobalArguments& global, const ListArguments& arguments) {
  ListFilter filter;
  filter.limit = arguments.limit;
  for (const std::string& word : arguments.states) {
    const auto state = state_from_word(word);
    if (!state) {
      return tell(
          {FailureKind::kUsage,
           fmt::format("--state {}: is none of queued, running, succeeded, failed, cancelled", word)});
    }
    filter.states.push_back(*state);
  }
  for (const std::string& text : arguments.labels) {
    const auto label = parse_label(text);
    if (!label) return tell(label.failure());
    filter.labels[label->first] = label->second;
  }
  const auto connection = connect(global.server);
  if (!connection) return tell(connection.failure());
  const auto jobs = list_jobs(*connection, filter);
  if (!jobs) return tell(jobs.failure());
  if (global.json) {
    Json all = Json::array();
    for (const v1::Job& job : *jobs) all.push_back(to_json(job));
    print_json({{"jobs", std::move(all)}});
  } else {
    fmt::print("{}", job_list(*jobs));
  }
  return kExitSuccess;
}

ExitCode cancel(const GlobalArguments& global, const std::string& job_id) {
  const auto connection = connect(global.server);
  if (!connection) return tell(connection.failure());
  const auto job = cancel_job(*connection, job_id);
  if (!job) return tell(job.failure());
  if (global.json) {
    print_json(to_json(*job));
  } else if (is_final(job->state())) {
    fmt::print("{} {}\n", one_line(job_id), state_word(job->state()));
  } else {
    fmt::print("{} {}, its worker is asked to stop\n", one_line(job_id), state_word(job->state()));
  }
  return kExitSuccess;
}

ExitCode remove(const GlobalArguments& global, const std::string& job_id) {
  const auto connection = connect(global.server);
  if (!connection) return tell(connection.failure());
  const auto deleted = delete_job(*connection, job_id);
  if (!deleted) return tell(deleted.failure());
  if (global.json) {
    print_json({{"job_id", job_id}, {"deleted", true}});
  } else {
    fmt::print("{} deleted\n", one_line(job_id));
  }
  return kExitSuccess;
}

ExitCode download(const GlobalArguments& global, const std::string& job_id,
                  const std::filesystem::path& out) {
  Interrupts interrupts;
  const auto connection = open(global, interrupts);
  if (!connection) return tell(connection.failure());
  const auto job = get_job(*connection, job_id);
  if (!job) return tell(job.failure());
  if (!is_final(job->state())) {
    return tell({FailureKind::kUsage,
                 fmt::format("job {} is {}; its files are there when it has ended (skinframe watch "
                             "{})",
                             one_line(job_id), state_word(job->state()), one_line(job_id))});
  }
  if (job->files_size() == 0) {
    fmt::print(stderr, "skinframe: job {} left no files: {}", one_line(job_id), end_report(*job));
    return exit_code(job->state(), job->reason());
  }
  const auto files = download_results(*connection, *job, out);
  if (!files) return tell(files.failure());
  Json paths = Json::array();
  for (const auto& path : *files) {
    paths.push_back(path.string());
    if (!global.json) fmt::print("{}\n", path.string());
  }
  if (global.json) print_json({{"job_id", job_id}, {"files", std::move(paths)}});
  return kExitSuccess;
}

}  // namespace skinframe::client
