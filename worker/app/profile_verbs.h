// SPDX-License-Identifier: GPL-3.0-or-later
// The verbs about printers and materials that need no server: calibrate, printers import, materials import.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

namespace skinframe {

class ProfileVerbs {
 public:
  // Adds the verbs to the program's command line. The app must outlive this.
  explicit ProfileVerbs(CLI::App& app);

  // Runs the verb that the command line named; its exit code, or nothing when it named none.
  std::optional<int> run();

 private:
  int run_calibrate() const;
  int run_import(bool is_printer) const;

  CLI::App* calibrate_ = nullptr;
  CLI::App* import_printer_ = nullptr;
  CLI::App* import_material_ = nullptr;
  std::string file_, out_, preset_, id_;
  bool json_ = false;
};

}  // namespace skinframe
