// SPDX-License-Identifier: GPL-3.0-or-later
// OpenBLAS takes a buffer for each thread that calls it at a time, at the first such call, and where it gets
// none it asks again, for ever: a job at its memory limit would spin instead of failing. Who takes them while
// there is room, and gives them back to OpenBLAS, has no such call later.
#pragma once

namespace skinframe {

// For that many threads at a time. False: the process may not take so much memory, and nothing was taken.
// Nothing to do, and true, where BLAS is not OpenBLAS.
bool reserve_blas_buffers(int threads);

}  // namespace skinframe
