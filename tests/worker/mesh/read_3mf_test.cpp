// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>

#include "tests/worker/mesh/zip_files.h"

namespace skinframe {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using namespace testing;

MeshFile read_ok(const std::string& bytes) {
  auto file = read_bytes(bytes);
  EXPECT_TRUE(file.ok()) << file.error().message;
  return file.ok() ? std::move(file).value() : MeshFile{};
}

double volume(const std::string& bytes) { return signed_volume(read_ok(bytes).mesh); }

TEST(Read3mf, AMeshIsRead) { expect_tetrahedron(read_bytes(threemf()), "3MF"); }

TEST(Read3mf, AStoredEntryIsReadLikeADeflatedOne) {
  ZipEntry model{"3D/3dmodel.model", model_xml(tetrahedron_object(1), item_xml(1))};
  model.deflated = false;
  expect_tetrahedron(read_bytes(zip({relationships(), model})), "3MF");
}

TEST(Read3mf, PartNamesDoNotKnowCase) {
  expect_tetrahedron(read_bytes(zip({relationships("/3d/3DModel.model"),
                                     {"3D/3dmodel.MODEL", model_xml(tetrahedron_object(1), item_xml(1))}})),
                     "3MF");
}

TEST(Read3mf, EveryUnitComesInMillimetres) {
  const std::pair<std::string, double> units[] = {{"micron", 1e-3}, {"millimeter", 1}, {"centimeter", 10},
                                                  {"inch", 25.4},   {"foot", 304.8},   {"meter", 1000}};
  for (const auto& [unit, mm] : units) {
    const MeshFile file =
        read_ok(package(model_xml(tetrahedron_object(1), item_xml(1), "unit=\"" + unit + "\"")));
    EXPECT_NEAR(bounding_box(file.mesh).extent().maxCoeff(), mm, 1e-9 * mm) << unit;
  }
  EXPECT_THAT(read_ok(package(model_xml(tetrahedron_object(1), item_xml(1), "unit=\"inch\""))).notes,
              Contains("converted inch to mm (times 25.4)"));
  EXPECT_THAT(error_of(package(model_xml(tetrahedron_object(1), item_xml(1), "unit=\"cubit\""))),
              HasSubstr("\"cubit\" is no unit of 3MF"));
}

TEST(Read3mf, NestedComponentsAreMovedByTheirTransformsInTurn) {
  // Row vectors times 4 x 3: the component is doubled and moved by 5 in x, then the item turns x into y.
  const std::string inner = object_xml(
      2, "<components>" + component_xml(1, "transform=\"2 0 0 0 2 0 0 0 2 5 0 0\"") + "</components>");
  const std::string outer = object_xml(3, "<components>" + component_xml(2) + "</components>");
  const MeshFile file = read_ok(package(model_xml(tetrahedron_object(1) + inner + outer,
                                                  item_xml(3, "transform=\"0 1 0 -1 0 0 0 0 1 0 0 7\""))));
  const BoundingBox box = bounding_box(file.mesh);
  EXPECT_TRUE(box.min.isApprox(Eigen::Vector3d(-2, 5, 7)));
  EXPECT_TRUE(box.max.isApprox(Eigen::Vector3d(0, 7, 9)));
  EXPECT_NEAR(signed_volume(file.mesh), 8.0 / 6, 1e-12);
}

TEST(Read3mf, AMirroredObjectKeepsItsMaterialInside) {
  const MeshFile file = read_ok(
      package(model_xml(tetrahedron_object(1), item_xml(1, "transform=\"-1 0 0 0 1 0 0 0 1 0 0 0\""))));
  EXPECT_NEAR(signed_volume(file.mesh), 1.0 / 6, 1e-12);
  EXPECT_THAT(file.notes, Contains("mirrored 1 objects"));
}

TEST(Read3mf, EveryItemOfTheBuildIsReadAndNothingElse) {
  const std::string resources = tetrahedron_object(1) + tetrahedron_object(2) +
                                object_xml(3, tetrahedron_mesh(), "type=\"support\"") + tetrahedron_object(4);
  const MeshFile file = read_ok(
      package(model_xml(resources, item_xml(1) + item_xml(2, "transform=\"1 0 0 0 1 0 0 0 1 9 0 0\"") +
                                       item_xml(3) + item_xml(4, "printable=\"0\""))));
  EXPECT_EQ(file.mesh.triangles.size(), 8u);
  EXPECT_THAT(file.notes, Contains("left out 1 supports that the file brings"));
  EXPECT_THAT(file.notes, Contains("left out 1 items marked as not printable"));
  EXPECT_THAT(file.notes, Contains("put 2 items of the build together"));
}

TEST(Read3mf, ObjectsInOtherPartsAreFoundThere) {
  const std::string root = model_xml(
      object_xml(1, "<components>" + component_xml(7, "p:path=\"/3D/Objects/a.model\"") + "</components>"),
      item_xml(1), "requiredextensions=\"p\"");
  const ZipEntry part{"3D/Objects/a.model", model_xml(tetrahedron_object(7), "")};
  expect_tetrahedron(read_bytes(package(root, {part})), "3MF");
  EXPECT_THAT(error_of(package(root)), HasSubstr("no part \"/3D/Objects/a.model\""));
  EXPECT_THAT(error_of(package(root, {{"3D/Objects/a.model", model_xml(tetrahedron_object(8), "")}})),
              HasSubstr("object 7, which \"/3D/Objects/a.model\" does not have"));
}

TEST(Read3mf, AnExtensionThatChangesWhatIsPrintedIsRefusedWhenRequiredAndToldOfWhenNot) {
  const std::string mesh = tetrahedron_mesh();
  const std::string beams =
      object_xml(1, mesh.substr(0, mesh.size() - 7) + "<b:beamlattice minlength=\"1\" radius=\"1\"/></mesh>");
  const auto refused =
      read_bytes(package(model_xml(beams, item_xml(1), "unit=\"millimeter\" requiredextensions=\"b\"")));
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().kind, ErrorKind::kUnsupported);
  EXPECT_THAT(refused.error().message, HasSubstr("beamlattice/2017"));
  EXPECT_THAT(read_ok(package(model_xml(beams, item_xml(1)))).notes,
              Contains("left out beam lattices: only meshes are read"));
}

TEST(Read3mf, UnknownElementsArePassedOver) {
  const std::string strange = "<b:wall><vertex x=\"9\" y=\"9\" z=\"9\"/><object id=\"1\"/></b:wall>";
  EXPECT_NEAR(volume(package(model_xml(strange + tetrahedron_object(1), item_xml(1)))), 1.0 / 6, 1e-12);
}

}  // namespace
}  // namespace skinframe
