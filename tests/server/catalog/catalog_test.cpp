// SPDX-License-Identifier: Apache-2.0
#include "server/catalog/catalog.h"

#include <gtest/gtest.h>

namespace skinframe::server {
namespace {

TEST(Catalog, HasThePrintersOfTable1) {
  const Catalog catalog = built_in_catalog();
  EXPECT_EQ(catalog.printer_ids(), "makerbot-replicator-2, sinterstation-hiq");
  const auto* sls = catalog.find_printer("sinterstation-hiq");
  ASSERT_NE(sls, nullptr);
  EXPECT_EQ(sls->min_radius_mm(), 0.5);
  EXPECT_EQ(sls->tray_x_mm(), 457);
  EXPECT_EQ(sls->process(), v1::PRINT_PROCESS_POWDER);
  const auto* fdm = catalog.find_printer("makerbot-replicator-2");
  ASSERT_NE(fdm, nullptr);
  EXPECT_EQ(fdm->min_radius_mm(), 0.4);
  EXPECT_EQ(fdm->tray_z_mm(), 150);
  EXPECT_EQ(fdm->process(), v1::PRINT_PROCESS_EXTRUSION);
}

TEST(Catalog, EveryPrintersDefaultMaterialIsThere) {
  const Catalog catalog = built_in_catalog();
  for (const auto& printer : catalog.printers()) {
    EXPECT_NE(catalog.find_material(printer.default_material_id()), nullptr) << printer.id();
  }
  EXPECT_EQ(catalog.find_material("pa")->tensile_modulus_mpa(), 1586);
  EXPECT_EQ(catalog.find_material("pla")->density_g_cm3(), 1.24);
}

TEST(Catalog, UnknownIdsAreNull) {
  const Catalog catalog = built_in_catalog();
  EXPECT_EQ(catalog.find_printer("pa"), nullptr);
  EXPECT_EQ(catalog.find_material(""), nullptr);
}

}  // namespace
}  // namespace skinframe::server
