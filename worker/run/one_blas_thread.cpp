// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/run/one_blas_thread.h"

extern "C" __attribute__((weak)) void openblas_set_num_threads(int);

namespace skinframe {

void use_one_blas_thread() {
  if (openblas_set_num_threads != nullptr) openblas_set_num_threads(1);
}

}  // namespace skinframe
