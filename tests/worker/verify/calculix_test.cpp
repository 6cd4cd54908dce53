// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/worker/verify/calculix_agreement.h"

namespace skinframe::test {
namespace {

INSTANTIATE_TEST_SUITE_P(Samples, CalculixAgreement,
                         testing::Values(CalculixBody{"hanging-ball", {}}, CalculixBody{"bracket", {}}),
                         short_name);

}  // namespace
}  // namespace skinframe::test
