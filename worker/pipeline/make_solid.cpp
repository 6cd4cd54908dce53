// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/pipeline/make_solid.h"

#include <fmt/format.h>

#include "worker/pipeline/write_results.h"

namespace skinframe {

Status make_solid(const PreparedSolid& prepared, const Skin& skin, const PrinterRequest& printer,
                  const JobOptions& options, const std::filesystem::path& folder, PrinterReport* report,
                  const RunContext& context) {
  const Solid& solid = prepared.solid;
  report->is_solid = true;
  report->termination = "SOLID";
  report->detail = report->termination_detail = fmt::format(
      "the body is thinner than two skins ({:.3g} mm) everywhere, so it is printed solid and nothing is "
      "saved; a "
      "larger --size would leave room for a frame",
      2.0 * skin.thickness_mm);
  report->warnings = {report->detail};  // what concerns frames and cavities does not concern it

  Statistics& s = report->statistics;
  s.solid_volume_mm3 = s.skin_volume_mm3 = s.total_volume_mm3 = solid.volume_mm3();
  s.ratio = 1.0;
  if (prepared.contact.hull.size() >= 3)
    s.balance_margin_mm = s.printed_balance_margin_mm =
        signed_margin_mm(prepared.contact.hull, solid.centroid_mm().head<2>());
  switch (decide_balance(options.balance, prepared.contact)) {
    case BalanceState::kEnforced:
      s.balance = "holds";
      break;
    case BalanceState::kNotStanding:
      s.balance = "not_standing";
      break;
    case BalanceState::kOff:
      s.balance = "off";
      break;
  }
  if (s.balance == "holds" && !(s.balance_margin_mm && *s.balance_margin_mm >= 0.0)) {
    report->is_solid = false;
    report->reason = Reason::kInfeasible;
    report->detail =
        "balance cannot hold: the body is thin everywhere, so it is solid, and the solid does not stand on "
        "its base "
        "contact; see --up and --balance";
    return ok_status();
  }
  if (options.verify)
    s.not_verified =
        "the body is printed solid, and the valid model is one of a skin with struts; nothing speaks for it "
        "but its being the solid itself";
  MergedPrint print;
  PrintableMesh& printable = print.closed;
  printable.mesh = solid.mesh();
  printable.volume_mm3 = solid.volume_mm3();
  printable.voxel_mm = skin.voxel_mm;
  return write_printable(print, prepared, printer, folder, report, context);
}

}  // namespace skinframe
