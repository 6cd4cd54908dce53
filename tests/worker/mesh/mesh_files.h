// SPDX-License-Identifier: GPL-3.0-or-later
// Mesh files made in the test: written under a name of the test's own, read back, gone afterwards.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <bit>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "worker/mesh/read_mesh.h"

namespace skinframe::testing {

class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& bytes, const std::string& extension = ".mesh") {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::temp_directory_path() /
            ("skinframe-" + std::string(info->test_suite_name()) + "-" + info->name() + "-" +
             std::to_string(::getpid()) + extension);
    std::ofstream(path_, std::ios::binary) << bytes;
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    std::error_code ignored;  // a file that is gone already is as good
    std::filesystem::remove(path_, ignored);
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

inline Result<MeshFile> read_bytes(const std::string& bytes, const ReadLimits& limits = {},
                                   const std::string& extension = ".mesh") {
  RunContext context;
  return read_mesh(TemporaryFile(bytes, extension).path(), limits, context);
}

inline std::string error_of(const std::string& bytes, const ReadLimits& limits = {}) {
  const Result<MeshFile> file = read_bytes(bytes, limits);
  return file.ok() ? "no error" : file.error().message;
}

template <class Value>
void put(std::string& bytes, Value value, bool big_endian = false) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  for (std::size_t i = 0; i < sizeof value; ++i) bytes.push_back(raw[big_endian ? sizeof value - 1 - i : i]);
}

// A tetrahedron of volume 1/6 with the right angle at the origin.
inline const std::vector<Eigen::Vector3d> kCorners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
inline const std::vector<std::array<int, 3>> kFaces = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};

inline std::string binary_stl(std::string header = "made in a test") {
  header.resize(80, ' ');
  put(header, static_cast<std::uint32_t>(kFaces.size()));
  for (const auto& face : kFaces) {
    for (int k = 0; k < 3; ++k) put(header, 0.0f);
    for (const int v : face) {
      for (int k = 0; k < 3; ++k) put(header, static_cast<float>(kCorners[v][k]));
    }
    put(header, std::uint16_t{0});
  }
  return header;
}

inline std::string number(double x) { return x == 0 ? "0" : "1"; }

inline std::string ascii_stl() {
  std::string text = "solid tetrahedron\n";
  for (const auto& face : kFaces) {
    text += " facet normal 0 0 0\n  outer loop\n";
    for (const int v : face) {
      text += "   vertex " + number(kCorners[v].x()) + " " + number(kCorners[v].y()) + " " +
              number(kCorners[v].z()) + "\n";
    }
    text += "  endloop\n endfacet\n";
  }
  return text + "endsolid tetrahedron\n";
}

inline std::string obj() {
  return "# four corners\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
}

inline std::string off() {
  return "OFF\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
}

inline std::string ascii_ply() {
  return "ply\nformat ascii 1.0\ncomment four corners\nelement vertex 4\nproperty float x\nproperty float "
         "y\nproperty float "
         "z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n0 0 "
         "1\n3 0 2 1\n3 0 1 "
         "3\n3 0 3 2\n3 1 2 3\n";
}

// With a colour at each vertex, an element nobody knows in the middle and a list at each face to read over.
template <class Coordinate>
std::string binary_ply(bool big_endian) {
  const std::string type = sizeof(Coordinate) == 8 ? "double" : "float";
  std::string bytes = std::string("ply\nformat binary_") + (big_endian ? "big" : "little") +
                      "_endian 1.0\nelement vertex 4\nproperty " + type +
                      " x\nproperty uchar red\nproperty " + type + " y\nproperty " + type +
                      " z\nelement wing 2\nproperty list ushort float marks\nproperty short kind\nelement "
                      "face 4\nproperty list "
                      "uchar float weights\nproperty list uchar uint vertex_index\nend_header\n";
  for (const auto& p : kCorners) {
    put(bytes, static_cast<Coordinate>(p.x()), big_endian);
    put(bytes, std::uint8_t{200});
    put(bytes, static_cast<Coordinate>(p.y()), big_endian);
    put(bytes, static_cast<Coordinate>(p.z()), big_endian);
  }
  for (std::uint16_t wing = 0; wing < 2; ++wing) {
    put(bytes, wing, big_endian);
    for (int i = 0; i < wing; ++i) put(bytes, 1.5f, big_endian);
    put(bytes, std::int16_t{-3}, big_endian);
  }
  for (const auto& face : kFaces) {
    put(bytes, std::uint8_t{1});
    put(bytes, 0.25f, big_endian);
    put(bytes, std::uint8_t{3});
    for (const int v : face) put(bytes, static_cast<std::uint32_t>(v), big_endian);
  }
  return bytes;
}

inline void expect_tetrahedron(const Result<MeshFile>& file, const std::string& format) {
  ASSERT_TRUE(file.ok()) << file.error().message;
  EXPECT_EQ(file->format, format);
  EXPECT_EQ(file->mesh.vertices.size(), 4u);
  EXPECT_EQ(file->mesh.triangles.size(), 4u);
  EXPECT_NEAR(signed_volume(file->mesh), 1.0 / 6, 1e-12);
}

}  // namespace skinframe::testing
