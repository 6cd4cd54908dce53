// SPDX-License-Identifier: Apache-2.0
// How often MUMPS factorised in this process. Ipopt does not tell, so the call is counted on its way.
#pragma once

namespace oracle {

int factorisations();

}  // namespace oracle
