// SPDX-License-Identifier: GPL-3.0-or-later
// OpenBLAS adds in an order that depends on its threads: with one, results are the same bits however many cores
// there are. (Between kinds of processors last digits still differ: OpenBLAS has kernels for each.) For the
// whole process; nothing where BLAS is not OpenBLAS. Whoever calls BLAS, CHOLMOD or LAPACK asks for it before.
#pragma once

namespace skinframe {

void use_one_blas_thread();

}  // namespace skinframe
