// SPDX-License-Identifier: Apache-2.0
// Options that are not on the command line: from --config FILE, else from the environment. The same rule for
// all programs:
//
//   skinframe-server --keep-jobs-days 7           the command line
//   keep-jobs-days = 7                            a line of the file; # begins a comment
//   SKINFRAME_SERVER_KEEP_JOBS_DAYS=7             the environment: prefix and name, in capitals, _ for -
//
// in this order: the first that has a value gives it. A line that names no option is wrong usage.
#pragma once

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <string>

namespace skinframe {

inline std::string environment_name(const std::string& prefix, const std::string& option) {
  std::string name = prefix + option;
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return c == '-' ? '_' : static_cast<char>(std::toupper(c)); });
  return name;
}

// CLI11's words for wrong usage; of a bad file they are without its name.
inline std::string what_is_wrong(const CLI::App* app, const CLI::Error& error) {
  const bool of_the_file = error.get_name() == "ConfigError";
  if (of_the_file) {
    return "--config " + app->get_config_ptr()->as<std::string>() + ": " + error.what() +
           ": a line is NAME = VALUE with the name of an option, without its dashes\n" +
           "Run with --help for more information.\n";
  }
  return CLI::FailureMessage::simple(app, error);
}

// For an app that has all its options. An option that has a name in the environment already keeps that.
inline void take_from_surroundings(CLI::App& app, const std::string& prefix) {
  for (CLI::Option* option : app.get_options()) {
    const bool has_value_of_its_own = option == app.get_help_ptr() || option->get_lnames().empty() ||
                                      option->get_lnames().front() == "version";
    if (has_value_of_its_own || !option->get_envname().empty()) continue;
    option->envname(environment_name(prefix, option->get_lnames().front()));
  }
  app.set_config("--config", "",
                 "file of these options, a line each: NAME = VALUE; what it leaves out may be in the "
                 "environment, as " +
                     environment_name(prefix, "name"));
  app.allow_config_extras(CLI::config_extras_mode::error);
  app.failure_message(what_is_wrong);
}

}  // namespace skinframe
