// SPDX-License-Identifier: GPL-3.0-or-later
// The job process without agent, client and server around it: what tests/sanitize.sh builds under sanitizers,
// half the worker's files. Argument: the job's folder (worker/job/README.md).
#include <cstdio>

#include "worker/job/run_job.h"
#include "worker/run/one_blas_thread.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: skinframe_sanitize_job WORKDIR\n", stderr);
    return 2;
  }
  skinframe::use_one_blas_thread();
  return skinframe::run_job(argv[1]);
}
