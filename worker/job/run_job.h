// SPDX-License-Identifier: GPL-3.0-or-later
// `skinframe-worker run-job WORKDIR`: one job, in a process of its own, as README.md of this folder
// describes.
#pragma once

#include <filesystem>

namespace skinframe {

// Takes SIGTERM as the wish to end: call it before any other thread of ours starts. Events go to stdout, log
// lines to stderr. Returns the process's exit code: 0 once outcome.json stands, whatever it says; 1 when it
// cannot be written.
int run_job(const std::filesystem::path& work_dir);

}  // namespace skinframe
