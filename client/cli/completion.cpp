// SPDX-License-Identifier: Apache-2.0
#include "client/cli/completion.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

namespace skinframe::client {
namespace {

std::string options_of(const CLI::App& app) {
  std::string words;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames()) words += " --" + name;
  return words;
}

std::string verbs_of(const CLI::App& app) {
  std::string words;
  for (const CLI::App* verb : app.get_subcommands([](const CLI::App*) { return true; }))
    words += " " + verb->get_name();
  return words;
}

// Those that take a value: the word behind them is no verb.
std::string value_options_of(const CLI::App& app) {
  std::string names;
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_items_expected_max() == 0) continue;
    for (const std::string& name : option->get_lnames()) names += (names.empty() ? "--" : "|--") + name;
  }
  return names;
}

}  // namespace

std::string bash_completion(const CLI::App& app) {
  const std::string global = options_of(app);
  std::string cases;
  for (const CLI::App* verb : app.get_subcommands([](const CLI::App*) { return true; }))
    cases += fmt::format("    {}) words=\"{}{}{}\" ;;\n", verb->get_name(), verbs_of(*verb),
                         options_of(*verb), global);
  return fmt::format(
      "# bash completion of skinframe; made by `skinframe completion`\n"
      "_skinframe() {{\n"
      "  local word=\"${{COMP_WORDS[COMP_CWORD]}}\" verb=\"\" words=\"\" i\n"
      "  for ((i = 1; i < COMP_CWORD; ++i)); do\n"
      "    case \"${{COMP_WORDS[i]}}\" in\n"
      "    {}) [[ \"${{COMP_WORDS[i + 1]}}\" == \"=\" ]] && ((++i)); ((++i)) ;;\n"
      "    :) ((++i)) ;;\n"  // readline parts HOST:PORT in three
      "    -*) ;;\n"
      "    *) verb=\"${{COMP_WORDS[i]}}\"; break ;;\n"
      "    esac\n"
      "  done\n"
      "  case \"$verb\" in\n"
      "    \"\") words=\"{}{}\" ;;\n"
      "{}"
      "  esac\n"
      "  mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$word\")\n"
      "}}\n"
      "complete -o default -F _skinframe skinframe\n",
      value_options_of(app), verbs_of(app), global, cases);
}

}  // namespace skinframe::client
