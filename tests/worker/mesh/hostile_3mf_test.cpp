// SPDX-License-Identifier: GPL-3.0-or-later
// A 3MF package is an archive of XML of references: each of the three has its own ways to say much with few
// bytes. All end in a sentence, in little time and memory.
#include <gmock/gmock.h>
#include <sys/resource.h>

#include <random>

#include "tests/worker/mesh/zip_files.h"

namespace skinframe {
namespace {

using ::testing::HasSubstr;
using namespace testing;

std::size_t peak_memory_mib() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) / 1024;
}

std::string model() { return model_xml(tetrahedron_object(1), item_xml(1)); }

TEST(Hostile3mf, CutAnywhereOrChangedAnywhereGivesAnErrorOrAMesh) {
  const std::string whole = threemf();
  std::mt19937 random(3);
  for (std::size_t place = 0; place < whole.size(); ++place) {
    // The archive's last two bytes are the length of a comment: without them nothing is missing.
    const std::string cut = whole.substr(0, place);
    EXPECT_TRUE(!read_bytes(cut).ok() || place + 3 >= whole.size()) << place;
    std::string bytes = whole;
    bytes[place] = static_cast<char>(random());
    const auto file = read_bytes(bytes);
    if (!file.ok()) continue;
    for (const auto& t : file->mesh.triangles) {
      for (const int v : t) ASSERT_LT(v, static_cast<int>(file->mesh.vertices.size()));
    }
  }
}

TEST(Hostile3mf, ABombIsRefusedWhileItInflates) {
  const std::string bomb = package(model() + std::string(std::size_t{64} << 20, ' '));
  ASSERT_LT(bomb.size(), std::size_t{1} << 20);
  const std::size_t before = peak_memory_mib();
  EXPECT_THAT(error_of(bomb), HasSubstr("inflates to more than 200 times"));
  EXPECT_LT(peak_memory_mib(), before + 50);
}

TEST(Hostile3mf, SizesAndChecksumsThatLieAreRefused) {
  ZipEntry entry{"3D/3dmodel.model", model()};
  entry.announced_size = 0xFFFFFF00u;
  EXPECT_THAT(error_of(zip({relationships(), entry})), HasSubstr("bytes are announced"));
  entry.announced_size = 40;
  EXPECT_FALSE(read_bytes(zip({relationships(), entry})).ok());
  entry.announced_size.reset();
  entry.announced_crc = 1;
  EXPECT_THAT(error_of(zip({relationships(), entry})), HasSubstr("checksum does not agree"));
}

TEST(Hostile3mf, CountsOfEntriesThatLieAreRefused) {
  const std::vector<ZipEntry> entries = {relationships(), {"3D/3dmodel.model", model()}};
  EXPECT_THAT(error_of(zip(entries, 60000)), HasSubstr("announces 60000 entries"));
  EXPECT_FALSE(read_bytes(zip(entries, 9000)).ok());
  EXPECT_FALSE(read_bytes(zip({}, {})).ok());
  std::vector<ZipEntry> many = entries;
  for (int i = 0; i < 10'000; ++i) many.push_back({std::to_string(i), "", false});
  EXPECT_THAT(error_of(zip(many)), HasSubstr("more than the limit of 10000"));
}

TEST(Hostile3mf, OneNameTwiceEncryptionAndForeignPackingAreRefusedByName) {
  EXPECT_THAT(error_of(package(model(), {{"3d/3DMODEL.model", model()}})), HasSubstr("two entries named"));
  ZipEntry entry{"3D/3dmodel.model", model()};
  entry.flags = 1;
  EXPECT_THAT(error_of(zip({relationships(), entry})), HasSubstr("encrypted"));
  entry.flags = 0;
  entry.method = 12;
  EXPECT_THAT(error_of(zip({relationships(), entry})), HasSubstr("packed by method 12"));
}

TEST(Hostile3mf, AMissingModelIsNamed) {
  EXPECT_THAT(error_of(zip({{"readme.txt", "hello"}})), HasSubstr("no 3MF package"));
  EXPECT_THAT(error_of(zip({relationships()})), HasSubstr("no model part \"/3D/3dmodel.model\""));
  EXPECT_THAT(error_of(zip({relationships("../../etc/passwd")})),
              HasSubstr("no model part \"../../etc/passwd\""));
  EXPECT_THAT(error_of(zip({{"_rels/.rels", "<Relationships/>"}})), HasSubstr("names no model part"));
  EXPECT_THAT(error_of(package("<html/>")), HasSubstr("begins with <model>"));
  EXPECT_THAT(error_of(package("{}")), HasSubstr("3dmodel.model: line 1"));
}

TEST(Hostile3mf, EntitiesAreNeverDefined) {
  std::string laughs = "<?xml version=\"1.0\"?><!DOCTYPE model [<!ENTITY a \"ha\">";
  for (char c = 'b'; c <= 'j'; ++c) {
    laughs.append("<!ENTITY ").append(1, c).append(" \"");
    for (int i = 0; i < 10; ++i) laughs.append("&").append(1, static_cast<char>(c - 1)).append(";");
    laughs += "\">";
  }
  EXPECT_THAT(error_of(package(laughs.append("]><model>&j;</model>"))), HasSubstr("(DTD) is not allowed"));
  EXPECT_THAT(error_of(package("<!DOCTYPE model SYSTEM \"file:///etc/passwd\"><model/>")),
              HasSubstr("(DTD) is not allowed"));
}

TEST(Hostile3mf, TagsWithoutEndAndNamesWithoutNumberTakeLittleMemory) {
  std::mt19937 random(9);
  const auto noise = [&](std::size_t length) {
    std::string letters(length, 'a');
    for (char& c : letters) c = static_cast<char>('a' + random() % 26);
    return letters;
  };
  const std::string long_tag = package(model_xml("<object id=\"" + noise(10'000'000), ""));
  std::string names;
  for (int i = 0; i < 200'000; ++i) names.append("<").append(noise(8)).append("/>");
  const std::string many_names = package(model_xml(names, ""));
  const std::size_t before = peak_memory_mib();
  EXPECT_THAT(error_of(long_tag), HasSubstr("more than 8 MiB to parse"));
  EXPECT_THAT(error_of(many_names), HasSubstr("more than 8 MiB to parse"));
  EXPECT_LT(peak_memory_mib(), before + 80);
}

TEST(Hostile3mf, NestingIsBounded) {
  std::string deep;
  for (int i = 0; i < 100'000; ++i) deep += "<a>";
  EXPECT_THAT(error_of(package(model_xml(deep, ""))), HasSubstr("nested more than 64 deep"));
}

TEST(Hostile3mf, AComponentOfItselfIsRefused) {
  const auto group = [](int id, int of) {
    return object_xml(id, "<components>" + component_xml(of) + "</components>");
  };
  EXPECT_THAT(error_of(package(model_xml(group(1, 1), item_xml(1)))), HasSubstr("component of itself"));
  EXPECT_THAT(error_of(package(model_xml(group(1, 2) + group(2, 3) + group(3, 1), item_xml(2)))),
              HasSubstr("component of itself"));
}

TEST(Hostile3mf, InstancesAreCountedBeforeTheyAreMade) {
  // Each object is twice the one before: 2^30 tetrahedra, and without a mesh 2^30 times nothing.
  for (const std::string& first : {tetrahedron_object(1), object_xml(1, "")}) {
    std::string resources = first;
    for (int id = 2; id <= 31; ++id) {
      resources +=
          object_xml(id, "<components>" + component_xml(id - 1) + component_xml(id - 1) + "</components>");
    }
    EXPECT_THAT(error_of(package(model_xml(resources, item_xml(31)))),
                HasSubstr("are more than the limit of"));
  }
}

TEST(Hostile3mf, AChainOfComponentsIsBoundedHoweverItIsBuilt) {
  // Objects that the build asks for on their own have been measured when the next one hangs them below
  // itself.
  std::string resources = tetrahedron_object(1), build;
  for (int id = 2; id <= 1000; ++id) {
    resources += object_xml(id, "<components>" + component_xml(id - 1) + "</components>");
    build += item_xml(id);
  }
  EXPECT_THAT(error_of(package(model_xml(resources, build))), HasSubstr("nested more than 32 deep"));
}

TEST(Hostile3mf, NumbersThatAreNoneAreNamedByTheirLine) {
  const auto with = [](const std::string& vertex, const std::string& triangle, const std::string& item) {
    return error_of(
        package(model_xml(object_xml(5, "<mesh><vertices><vertex x=\"0\" y=\"0\" z=\"0\"/>" + vertex +
                                            "</vertices><triangles>" + triangle + "</triangles></mesh>"),
                          item)));
  };
  EXPECT_THAT(with("<vertex x=\"nan\" y=\"0\" z=\"0\"/>", "", ""),
              HasSubstr("line 5: x=\"nan\" is not a finite"));
  EXPECT_THAT(with("<vertex x=\"1e999\" y=\"0\" z=\"0\"/>", "", ""), HasSubstr("not a finite coordinate"));
  EXPECT_THAT(with("<vertex y=\"0\" z=\"0\"/>", "", ""), HasSubstr("x=\"\" is not a finite coordinate"));
  EXPECT_THAT(with("", "<triangle v1=\"0\" v2=\"0\" v3=\"9000\"/>", ""),
              HasSubstr("object 5: triangle 0: index 9000 of 1 vertices"));
  EXPECT_THAT(with("", "<triangle v1=\"0\" v2=\"-1\" v3=\"0\"/>", ""), HasSubstr("no number below 2^31"));
  EXPECT_THAT(with("", "", item_xml(6)), HasSubstr("object 6, which"));
  EXPECT_THAT(with("", "", item_xml(5, "transform=\"1 0 0 0 1 0 0 0 inf 0 0 0\"")),
              HasSubstr("12 finite numbers"));
  EXPECT_THAT(with("", "", item_xml(5, "transform=\"1 0 0 0 1 0 0 0 0 0 0 0\"")), HasSubstr("flattens"));
  EXPECT_THAT(with("", "", item_xml(5)), HasSubstr("no triangle to be printed"));
}

}  // namespace
}  // namespace skinframe
