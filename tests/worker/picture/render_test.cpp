// SPDX-License-Identifier: GPL-3.0-or-later
// From a folder's files to a folder's pictures, and what is refused.
#include "worker/picture/render.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <iterator>
#include <nlohmann/json.hpp>

#include "tests/fixture/temporary_folder.h"
#include "worker/mesh/write_stl.h"
#include "worker/picture/exported_frame.h"

namespace skinframe::picture {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

json small_frame() {
  return json::parse(R"({"nodes": [[0,0,0],[40,0,0],[0,30,0],[10,10,25]],
    "struts": [{"a":0,"b":1,"radius_mm":0.5},{"a":1,"b":2,"radius_mm":0.7},{"a":2,"b":3,"radius_mm":1.5}],
    "supports": {"nodes": [{"at_mm":[10,10,0]}], "struts": [{"a":3,"b":4,"radius_mm":0.5}]},
    "strut_sizes": {"initial":  {"radii_mm":[0.5,0.5,0.5,0.5], "lengths_mm":[40,50,33,28]},
                    "size":     {"radii_mm":[0.5,0.6,0.7,1.5], "lengths_mm":[40,50,33,28]},
                    "topology": {"radii_mm":[0.5,0.7,1.5],     "lengths_mm":[40,50,33]}}})");
}

constexpr const char* kPly =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    "property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 1\n"
    "property list uchar int vertex_indices\nend_header\n0 0 0 255 0 0\n9 0 0 0 255 0\n0 9 9 0 0 255\n3 0 1 "
    "2\n";

class Render : public testing::Test {
 protected:
  Render() {
    write("report.json",
          json{{"mesh", {{"name", "egg.stl"}}}, {"printers", {{{"printer", "p-1"}}, {{"printer", "p-2"}}}}});
    write("p-1/frame.json", small_frame());
    write_text("p-1/deformation-side.ply", kPly);
    write_text("p-1/pinch.ply", kPly);
    const TriangleMesh tetrahedron{{{0, 0, 0}, {40, 0, 0}, {0, 30, 0}, {0, 0, 25}},
                                   {{{0, 2, 1}}, {{0, 1, 3}}, {{0, 3, 2}}, {{1, 2, 3}}}};
    EXPECT_TRUE(write_stl(tetrahedron, path("p-1/skin-frame.stl")).ok());
  }
  fs::path path(const std::string& name) const { return folder_.path() / "result" / name; }
  void write_text(const std::string& name, const std::string& text) const {
    fs::create_directories(path(name).parent_path());
    std::ofstream(path(name)) << text;
  }
  void write(const std::string& name, const json& document) const { write_text(name, document.dump()); }
  RenderRequest request() const {
    RenderRequest request;
    request.directory = folder_.path() / "result";
    request.side_px = 200;
    return request;
  }
  // Names below DIR, or the error.
  static std::vector<std::string> names(const RenderRequest& request) {
    RunContext context;
    const auto written = render(request, context);
    if (!written) return {"error: " + written.error().message};
    std::vector<std::string> out;
    for (const fs::path& file : *written)
      out.push_back(fs::relative(file, request.out.empty() ? request.directory : request.out).string());
    return out;
  }
  std::string refusal(const std::function<void(json&)>& lie) const {
    json frame = small_frame();
    lie(frame);
    write("p-1/frame.json", frame);
    const auto said = names(request());
    return said.size() == 1 ? said[0] : "drawn";
  }
  static std::string bytes(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  test::TemporaryFolder folder_;
};

TEST_F(Render, EachFileBecomesItsPictures) {
  EXPECT_THAT(names(request()), ElementsAre("p-1/frame.png", "p-1/radii.png", "p-1/lengths.png",
                                            "p-1/cutaway.png", "p-1/deformation-side.png", "p-1/pinch.png"));
  for (const char* name : {"p-1/frame.png", "p-1/lengths.png", "p-1/cutaway.png"})
    EXPECT_TRUE(bytes(path(name)).starts_with("\x89PNG")) << name;
}

TEST_F(Render, TheSameFilesGiveTheSameBytesAnywhere) {
  RenderRequest elsewhere = request();
  elsewhere.out = folder_.path() / "pictures";
  const auto here = names(request()), there = names(elsewhere);
  ASSERT_EQ(here, there);
  for (const std::string& name : here) EXPECT_EQ(bytes(path(name)), bytes(elsewhere.out / name)) << name;
}

TEST_F(Render, WhatHasNoFileHasNoPicture) {
  fs::remove(path("p-1/skin-frame.stl"));
  fs::remove(path("p-1/deformation-side.ply"));
  fs::remove(path("p-1/pinch.ply"));
  EXPECT_THAT(names(request()), ElementsAre("p-1/frame.png", "p-1/radii.png", "p-1/lengths.png"));
}

TEST_F(Render, AFrameJobsResultIsDrawnBesideIt) {
  write("report.json", {{"frame", {{"counts", 1}}}});
  write("result.json", small_frame());
  EXPECT_THAT(names(request()), ElementsAre("frame.png", "radii.png", "lengths.png"));
}

TEST_F(Render, OnePrinterMayBeAskedForByName) {
  write("p-2/frame.json", small_frame());
  RenderRequest one = request();
  one.printer = "p-2";
  EXPECT_THAT(names(one), ElementsAre("p-2/frame.png", "p-2/radii.png", "p-2/lengths.png"));
  one.printer = "p-3";
  EXPECT_THAT(names(one),
              ElementsAre(HasSubstr("no printer \"p-3\" with files to draw; there are: p-1, p-2")));
}

TEST_F(Render, WhatIsMissingIsNamed) {
  RenderRequest nowhere = request();
  nowhere.directory = folder_.path() / "no-such";
  EXPECT_THAT(names(nowhere), ElementsAre(HasSubstr("no-such: there is no such folder")));
  fs::remove_all(path("p-1"));
  EXPECT_THAT(names(request()), ElementsAre(HasSubstr("no printer in it has files to draw")));
  fs::remove(path("report.json"));
  EXPECT_THAT(names(request()), ElementsAre(HasSubstr("report.json: there is no such file")));
}

TEST_F(Render, AReportCannotLeadOutOfItsFolder) {
  for (const char* name : {"../p-1", "/tmp", "..", "", "a/b"}) {
    write("report.json", {{"mesh", {{"name", "egg"}}}, {"printers", {{{"printer", name}}}}});
    EXPECT_THAT(names(request()), ElementsAre(HasSubstr("is no name of a printer's folder"))) << name;
  }
}

TEST_F(Render, DefectsOfAFrameAreNamed) {
  EXPECT_THAT(refusal([](json& f) { f["struts"][1]["b"] = 4; }),
              HasSubstr("frame.json: struts[1].b: 4 is not a node"));
  EXPECT_THAT(refusal([](json& f) { f["struts"][0]["a"] = -1; }), HasSubstr("-1 is not a node"));
  EXPECT_THAT(refusal([](json& f) { f["nodes"][2][1] = 1e300; }), HasSubstr("nodes[2]: further out"));
  EXPECT_THAT(refusal([](json& f) { f["nodes"][2] = {1, 2}; }), HasSubstr("frame.json"));
  EXPECT_THAT(refusal([](json& f) { f["struts"][0]["radius_mm"] = -3; }), HasSubstr("-3 is no radius"));
  EXPECT_THAT(refusal([](json& f) { f["struts"] = json::array(); }), HasSubstr("there are none"));
  EXPECT_THAT(refusal([](json& f) { f["struts"] = 7; }), HasSubstr("struts: is no list"));
  EXPECT_THAT(refusal([](json& f) { f["strut_sizes"].erase("size"); }), HasSubstr("size"));
  EXPECT_THAT(refusal([](json& f) { f["strut_sizes"]["size"]["radii_mm"][0] = 1e9; }),
              HasSubstr("1000000000"));
  write_text("p-1/frame.json", "{\"nodes\": [");
  EXPECT_THAT(names(request()), ElementsAre(HasSubstr("not JSON")));
}

TEST_F(Render, MeshesThatAreNoneAndColoursThatAreMissingAreNamed) {
  write_text("p-1/deformation-side.ply",
             "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
             "z\nelement "
             "face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n9 0 0\n0 9 9\n3 0 1 2\n");
  EXPECT_THAT(names(request()), ElementsAre(HasSubstr("deformation-side.ply: its vertices have no colours")));
  write_text("p-1/skin-frame.stl", "solid nothing\nendsolid\n");
  EXPECT_THAT(names(request()), ElementsAre(HasSubstr("skin-frame.stl")));
}

TEST_F(Render, SizesBeyondTheBoundsAreRefused) {
  RenderRequest wide = request();
  for (const int side : {-1, 0, 119, 4097, 1 << 30}) {
    wide.side_px = side;
    EXPECT_THAT(names(wide), ElementsAre(HasSubstr("outside 120..4096"))) << side;
  }
}

TEST_F(Render, AFrameWithoutItsStagesHasOneCurve) {
  json old = small_frame();
  old.erase("strut_sizes");
  write("p-1/frame.json", old);
  const auto frame = read_frame(path("p-1/frame.json"));
  ASSERT_TRUE(frame.ok());
  ASSERT_EQ(frame->stages.size(), 1U);
  EXPECT_EQ(frame->stages[0].radii_mm.size(), 3U);
  EXPECT_NEAR(frame->stages[0].lengths_mm[0], 40, 1e-12);
}

TEST_F(Render, AFolderThatCannotBeWrittenIsNoFaultOfTheInput) {
  write_text("taken", "a file");
  RenderRequest blocked = request();
  blocked.out = path("taken");
  RunContext context;
  const auto written = render(blocked, context);
  ASSERT_FALSE(written.ok());
  EXPECT_EQ(written.error().kind, ErrorKind::kInternal);
  EXPECT_THAT(written.error().message, HasSubstr("taken"));
}

}  // namespace
}  // namespace skinframe::picture
