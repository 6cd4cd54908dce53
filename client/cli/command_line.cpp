// SPDX-License-Identifier: Apache-2.0
#include "client/cli/command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <functional>
#include <string_view>

#include "client/cli/completion.h"
#include "client/cli/doctor.h"
#include "client/cli/follow.h"
#include "client/cli/sibling.h"
#include "client/cli/verbs.h"
#include "proto/command_line/surroundings.h"

namespace skinframe::client {
namespace {

constexpr char kExamples[] =
    "Examples:\n"
    "  skinframe run fish.obj --printer sinterstation-hiq --size 200 --out fish\n"
    "  skinframe submit fish.obj --printer sinterstation-hiq --server farm:7350 --watch --out fish\n"
    "  skinframe sample --list\n"
    "  skinframe check fish\n"
    "\n"
    "Exit codes: 0 done, 2 wrong usage, 3 file unusable, 4 infeasible, 5 failed, 6 cancelled, 7 server "
    "unreachable,\n"
    "8 only some printers, 9 unknown job. SKINFRAME_SERVER names the server, SKINFRAME_WORKER the worker "
    "program.";

class CommandLine {
 public:
  CommandLine() {
    app_.name("skinframe");
    app_.set_version_flag("--version", "skinframe " SKINFRAME_VERSION);
    app_.footer(kExamples);
    app_.require_subcommand(0, 1);
    app_.add_option("--server", global_.server.address, "Server, HOST:PORT")
        ->envname("SKINFRAME_SERVER")
        ->capture_default_str();
    app_.add_option("--tls-ca", global_.server.tls_ca, "PEM file of the certificate authority; turns TLS on");
    app_.add_option("--tls-cert", global_.server.tls_cert,
                    "PEM certificate chain by which the server knows you");
    app_.add_option("--tls-key", global_.server.tls_key, "PEM private key of that certificate");
    app_.add_option("--token", global_.server.token,
                    "By which the server knows you; better by the environment")
        ->envname("SKINFRAME_TOKEN");
    app_.add_flag("--json", global_.json, "Data as JSON on stdout");
    take_from_surroundings(app_, "SKINFRAME_");
    add_run();
    add_submit();
    add_watch();
    add_job_verb("get", "Show one job", "  skinframe get JOB --json", get);
    add_list();
    add_job_verb("cancel", "Ask for a job's end", "  skinframe cancel JOB", cancel);
    add_download();
    add_job_verb("delete", "Forget a job that has ended", "  skinframe delete JOB", remove);
    add_profiles(
        "printers", "The printers that the server knows; one whole with its sources; import of one",
        "  skinframe printers\n"
        "  skinframe printers show makerbot-replicator-2\n"
        "  skinframe printers show makerbot-replicator-2 --json > mine.json   a profile file to edit\n"
        "  skinframe printers import bundle.ini --preset \"Original Prusa i3 MK3\" > mk3.json\n"
        "  skinframe printers import ultimaker_s5.def.json > s5.json\n",
        printers);
    add_profiles("materials",
                 "The materials that the server knows; one whole with its sources; import of one",
                 "  skinframe materials --json\n"
                 "  skinframe materials show pla\n"
                 "  skinframe materials import spoolman-filament.json > my-petg.json\n",
                 materials);
    verb("doctor",
         "Looks at everything between this program and a finished job: server, versions, clocks, disks, "
         "profiles, workers",
         "  skinframe doctor\n  skinframe doctor --server farm:7350 --tls-ca ca.pem --json\n"
         "Each line is ok, a note, or WRONG. Exit codes: 0 nothing is wrong, 7 no server answers, 2 it "
         "refuses the\n"
         "caller, 5 something else is wrong.",
         [this] { return doctor(global_); });
    verb("completion", "What makes a shell complete this program's words",
         "  source <(skinframe completion)                                   in this bash, or in ~/.bashrc\n"
         "  skinframe completion > /etc/bash_completion.d/skinframe          for everybody",
         [this] {
           fmt::print("{}", bash_completion(app_));
           return kExitSuccess;
         });
    add_local("sample", "Write a body that ships with the program (runs here)",
              "  skinframe sample --list\n  skinframe sample hanging-ball --out ball.stl");
    add_local("check", "Re-check every claim of a result from its files alone (runs here)",
              "  skinframe check fish");
    add_local(
        "render", "Pictures of a result from its files alone, without a display (runs here)",
        "  skinframe render fish                              every picture, into fish/PRINTER/\n"
        "  skinframe render fish --printer sinterstation-hiq  of one printer only\n"
        "  skinframe render fish --out pictures --size 600    into pictures/PRINTER/, 600 px wide\n"
        "  skinframe render fish --json                       {\"files\": [..]}\n"
        "PNG files; their names are printed. frame.png: the struts by radius, supports in red.\n"
        "cutaway.png: the printed solid cut through its middle. radii.png, lengths.png: how many struts\n"
        "are no thicker, no longer than so much, before and after each stage of the optimiser.\n"
        "deformation-NAME.png: the surface under a load case; pinch.png: how far two fingers press it\n"
        "together, by place; both where the result is verified, of the .ply files of these names. A result "
        "of\n"
        "`submit FRAME.json` has the struts and the curves.\n"
        "--size is the width in pixels, 120 to 4096 (1000). Exit codes: 0 drawn, 2 wrong usage, 3 no\n"
        "result in DIR, 5 the pictures cannot be written.");
    add_local("solve-frame", "The optimiser alone, on a frame problem file (runs here)",
              "  skinframe solve-frame problem.json --out result.json");
    add_local(
        "calibrate", "A printer's longest printable strut by angle, from printed test struts (runs here)",
        "  skinframe calibrate points.csv\n"
        "  skinframe calibrate points.csv --json                curve and residuals as JSON\n"
        "  skinframe calibrate points.csv --out fragment.json   \"printable_length\" of a profile file\n"
        "points.csv has a line a test strut: angle_deg,length_mm: its angle from the vertical (0 stands\n"
        "upright, 90 lies flat) and the longest one of that angle that printed well. The curve is the\n"
        "nearest that never rises with the angle; nothing is said of struts flatter than the flattest\n"
        "that was printed: for a profile print flat ones too, bridges at 90 degrees.");
  }

  int run_words(int argc, char** argv) {
    if (argc < 2) {
      fmt::print(stderr, "{}", app_.help());
      return kExitUsage;
    }
    try {
      app_.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
      return app_.exit(error) == 0 ? kExitSuccess : kExitUsage;  // whatever CLI11 numbers it
    }
    if (!action_) {
      fmt::print(stderr, "skinframe: no verb is given; `skinframe --help` lists them\n");
      return kExitUsage;
    }
    return action_();
  }

 private:
  using Action = std::function<ExitCode()>;

  CLI::App& verb(const char* name, const char* description, const std::string& examples, Action action) {
    CLI::App& sub = *app_.add_subcommand(name, description);
    sub.fallthrough();  // the global options, after the verb as well
    sub.footer("Examples:\n" + examples);
    sub.callback([this, action = std::move(action)] { action_ = action; });
    return sub;
  }

  void add_job_verb(const char* name, const char* description, const std::string& examples,
                    ExitCode (*action)(const GlobalArguments&, const std::string&)) {
    verb(name, description, examples, [this, action] { return action(global_, job_id_); })
        .add_option("JOB", job_id_, "Job id")
        ->required();
  }

  void add_profiles(const char* name, const char* description, const std::string& examples,
                    ExitCode (*action)(const GlobalArguments&, const std::string&)) {
    CLI::App& sub =
        verb(name, description,
             examples +
                 "`import` runs here: from PrusaSlicer .ini, Cura .def.json or Spoolman JSON to a "
                 "profile file on\nstdout, null where the file does not say; for the server's "
                 "--profiles folder.",
             [this, action] { return action(global_, profile_id_); });
    sub.require_subcommand(0, 1);
    CLI::App& show = *sub.add_subcommand("show", "One whole, with its sources; --json: as a profile file");
    show.fallthrough();
    show.add_option("ID", profile_id_, "Its id")->required();
    CLI::App& import =
        *sub.add_subcommand("import", "A profile file from another program's file (runs here)");
    import.allow_extras();
    import.footer(
        "Usage: import FILE [--preset NAME] [--id ID] [--out FILE]\n"
        "  --preset   which one, where the file has several; without it they are listed\n"
        "  --id       of the profile (default: made of its name)\n"
        "  --out      file to write (default: stdout)\n"
        "Examples:\n" +
        examples);
  }

  void add_run() {
    CLI::App& sub =
        verb("run", "One command: starts a server and a worker here, runs the job, stops them",
             "  skinframe run fish.obj --printer sinterstation-hiq --size 200 --out fish\n"
             "  skinframe run fish.obj --printer sinterstation-hiq --printer makerbot-replicator-2 \\\n"
             "      --size 140 --load side:top:20,0,0 --out fish\n"
             "  skinframe run fish/sinterstation-hiq/frame.json --out again      the optimiser alone",
             [this] { return run(global_, run_); });
    add_job_options(sub, run_.job);
    sub.add_option("--out", run_.out, "Folder for the results")->required();
    sub.add_option("--data", run_.data,
                   "Folder of the embedded server, kept afterwards (default: temporary)");
    sub.add_option("--profiles", run_.profiles,
                   "Folder of printer and material profiles of your own (*.json)");
  }

  void add_submit() {
    CLI::App& sub = verb(
        "submit", "Upload a mesh or a frame problem and submit a job; prints the job's id",
        "  skinframe submit fish.obj --printer sinterstation-hiq --size 200\n"
        "  skinframe submit fish.obj --printer sinterstation-hiq --watch --out fish\n"
        "  skinframe submit fish.obj --printer sinterstation-hiq --load pinch:0,-30,80:0,10,0 \\\n"
        "      --load pinch:0,30,80:0,-10,0 --label order=4711 --deadline 15m\n"
        "  skinframe submit fish.obj --printer sinterstation-hiq --load side:top:25,0,0 --warm-start JOB\n"
        "  skinframe submit problem.json --watch --out solved",
        [this] {
          if (!submit_.out.empty() && !submit_.watch) {
            return tell({FailureKind::kUsage,
                         "--out needs --watch; or fetch the files later with `skinframe download`"});
          }
          return submit(global_, submit_);
        });
    add_job_options(sub, submit_.job);
    sub.add_option("--request-id", submit_.job.request_id,
                   "Your own id of this submission: sent twice it makes one job (default: random)");
    sub.add_flag("--validate-only", submit_.job.validate_only,
                 "Check everything that can be checked; make no job");
    sub.add_flag("--watch", submit_.watch, "Stay until the end; Ctrl-C cancels the job");
    sub.add_option("--out", submit_.out, "With --watch: folder for the results");
  }

  void add_watch() {
    CLI::App& sub = verb("watch", "A job's events, one a line, until its end; Ctrl-C only detaches",
                         "  skinframe watch JOB\n  skinframe watch JOB --from 17 --json",
                         [this] { return watch(global_, job_id_, from_); });
    sub.add_option("JOB", job_id_, "Job id")->required();
    sub.add_option("--from", from_, "Only events after this sequence number (0: all)")
        ->check(CLI::NonNegativeNumber);
  }

  void add_list() {
    CLI::App& sub =
        verb("list", "Jobs, newest first",
             "  skinframe list --state running --state queued\n  skinframe list --label order=4711 --json",
             [this] { return list(global_, list_); });
    sub.add_option("--state", list_.states, "queued, running, succeeded, failed or cancelled; repeatable")
        ->allow_extra_args(false);
    sub.add_option("--label", list_.labels, "KEY=VALUE; repeatable, all must match")->allow_extra_args(false);
    sub.add_option("--limit", list_.limit, "At most so many")
        ->check(CLI::Range(1, 1'000'000))
        ->capture_default_str();
  }

  void add_download() {
    CLI::App& sub =
        verb("download", "Fetch a job's files; each is checked against its hash",
             "  skinframe download JOB --out fish", [this] { return download(global_, job_id_, out_); });
    sub.add_option("JOB", job_id_, "Job id")->required();
    sub.add_option("--out", out_, "Folder for the files")->required();
  }

  // Only for the help: called, these verbs never come here (see local_verb).
  void add_local(const char* name, const char* description, const std::string& examples) {
    CLI::App& sub = verb(name, description, examples, [] { return kExitUsage; });
    sub.allow_extras();
  }

  CLI::App app_{"Skin-frame structures: prints a thin skin on an optimised frame instead of a solid."};
  GlobalArguments global_;
  RunArguments run_;
  SubmitArguments submit_;
  ListArguments list_;
  std::string job_id_, profile_id_;
  std::filesystem::path out_;
  std::int64_t from_ = 0;
  Action action_;
};

}  // namespace

int skinframe_main(int argc, char** argv) {
  const std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
  if (const auto verb = local_verb(words)) return tell(become_worker(verb->words));
  return CommandLine().run_words(argc, argv);
}

}  // namespace skinframe::client
