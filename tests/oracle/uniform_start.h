// SPDX-License-Identifier: Apache-2.0
// Where Ipopt starts: one area for all struts, cut to their bounds, about the least that keeps the limits;
// and the displacements in equilibrium with it.
#pragma once

#include "tests/oracle/size_program.h"

namespace oracle {

Start uniform_start(const FrameFile& frame);

}  // namespace oracle
