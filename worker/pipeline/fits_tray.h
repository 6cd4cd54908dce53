// SPDX-License-Identifier: GPL-3.0-or-later
// Whether a solid goes into a printer's tray.
#pragma once

#include "worker/pipeline/request.h"
#include "worker/run/result.h"
#include "worker/solid/solid.h"

namespace skinframe {

// The box of the solid against the tray, axis by axis: upright as it is placed, turned by 90 degrees about z
// where that fits better, and in no other way. kDoesNotFit names the excess of every axis in mm and the
// largest
// --size that fits.
Status fits_tray(const Solid& solid, const PrinterProfile& printer);

}  // namespace skinframe
