// SPDX-License-Identifier: Apache-2.0
#include "server/catalog/catalog.h"

#include <gtest/gtest.h>

namespace skinframe::server {
namespace {

TEST(Catalog, HasThePrintersOfTable1) {
  const Catalog catalog = built_in_catalog();
  const auto* sls = catalog.find_printer("sinterstation-hiq");
  ASSERT_NE(sls, nullptr);
  EXPECT_EQ(sls->min_radius_mm(), 0.5);
  EXPECT_EQ(sls->tray_x_mm(), 457);
  EXPECT_EQ(sls->tray_y_mm(), 380);
  EXPECT_EQ(sls->tray_z_mm(), 330);
  EXPECT_EQ(sls->process(), v1::PRINT_PROCESS_POWDER);
  EXPECT_EQ(sls->default_material_id(), "pa");
  EXPECT_EQ(sls->drain_holes().diameter_mm(), 20);
  EXPECT_EQ(sls->drain_holes().least_count(), 2);
  const auto* fdm = catalog.find_printer("makerbot-replicator-2");
  ASSERT_NE(fdm, nullptr);
  EXPECT_EQ(fdm->min_radius_mm(), 0.4);
  EXPECT_EQ(fdm->tray_x_mm(), 225);
  EXPECT_EQ(fdm->tray_y_mm(), 145);
  EXPECT_EQ(fdm->tray_z_mm(), 150);
  EXPECT_EQ(fdm->process(), v1::PRINT_PROCESS_EXTRUSION);
  EXPECT_TRUE(fdm->printable_length().is_default()) << "nobody measured it";
}

TEST(Catalog, HasTheMaterialsOfTable1) {
  const Catalog catalog = built_in_catalog();
  const auto expect = [&](const char* id, double gamma, double mu, double sigma, double tau, double rho) {
    const auto* m = catalog.find_material(id);
    ASSERT_NE(m, nullptr);
    EXPECT_EQ(m->tensile_modulus_mpa(), gamma);
    EXPECT_EQ(m->shear_modulus_mpa(), mu);
    EXPECT_EQ(m->tensile_strength_mpa(), sigma);
    EXPECT_EQ(m->shear_strength_mpa(), tau);
    EXPECT_EQ(m->slenderness(), 60);
    EXPECT_EQ(m->density_g_cm3(), rho);
  };
  expect("pa", 1586, 1387, 43, 48, 1.15);
  expect("pla", 2673, 1533, 92, 52, 1.24);
}

TEST(Catalog, HasFourMoreOfEachKindAndEveryPrintersDefaultMaterial) {
  const Catalog catalog = built_in_catalog();
  EXPECT_GE(catalog.printers().size(), 6u);
  EXPECT_GE(catalog.materials().size(), 6u);
  for (const auto& printer : catalog.printers()) {
    const std::string& material = printer.default_material_id();
    EXPECT_TRUE(material.empty() || catalog.find_material(material) != nullptr) << printer.id();
  }
}

TEST(Catalog, EveryBuiltInPrinterAndItsDefaultMaterialHaveAllThatAJobNeeds) {
  const Catalog catalog = built_in_catalog();
  for (const auto& printer : catalog.printers()) {
    EXPECT_EQ(missing_for_a_job(printer), "") << printer.id();
    const auto* material = catalog.find_material(printer.default_material_id());
    EXPECT_EQ(material == nullptr ? "" : missing_for_a_job(*material), "") << printer.id();
  }
}

TEST(Catalog, FourMaterialsBesideThePapersAreKnownWellEnoughForAJob) {
  const Catalog catalog = built_in_catalog();
  int known = 0;
  for (const auto& material : catalog.materials()) known += missing_for_a_job(material).empty();
  EXPECT_GE(known, 2 + 4);
  EXPECT_EQ(missing_for_a_job(*catalog.find_material("formlabs-durable")),
            "shear_modulus_mpa, density_g_cm3");
}

TEST(Catalog, AShearModulusThatWasComputedIsThatOfAnIsotropicSolid) {
  // 0 <= nu <= 0.5 of a plastic bounds G between E / 3 and E / 2; a typing error falls outside. The paper's own are as printed.
  const Catalog catalog = built_in_catalog();
  for (const auto& material : catalog.materials()) {
    if (!material.has_shear_modulus_mpa() || material.id() == "pa" || material.id() == "pla") continue;
    EXPECT_GE(material.shear_modulus_mpa(), material.tensile_modulus_mpa() / 3) << material.id();
    EXPECT_LE(material.shear_modulus_mpa(), material.tensile_modulus_mpa() / 2) << material.id();
  }
}

TEST(Catalog, WhatAJobNeedsAndTheProfileDoesNotKnowIsNamed) {
  const Catalog catalog = built_in_catalog();
  v1::PrinterProfile printer = *catalog.find_printer("makerbot-replicator-2");
  printer.clear_tray_z_mm();
  printer.clear_printable_length();
  EXPECT_EQ(missing_for_a_job(printer), "tray_z_mm, printable_length");
  printer.set_process(v1::PRINT_PROCESS_POWDER);
  EXPECT_EQ(missing_for_a_job(printer), "tray_z_mm") << "powder carries every strut";
  EXPECT_EQ(missing_for_a_job(*catalog.find_material("petg")), "shear_modulus_mpa");
  EXPECT_EQ(missing_for_a_job(*catalog.find_material("pa")), "");
}

TEST(Catalog, UnknownIdsAreNull) {
  const Catalog catalog = built_in_catalog();
  EXPECT_EQ(catalog.find_printer("pa"), nullptr);
  EXPECT_EQ(catalog.find_material(""), nullptr);
}

}  // namespace
}  // namespace skinframe::server
