// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/mesh/write_stl.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <Eigen/Geometry>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <limits>
#include <string>

namespace skinframe {
namespace {

constexpr std::size_t kFacetBytes = 50;
constexpr std::size_t kBufferBytes = kFacetBytes * 20'000;

// An open temporary file that removes itself unless it was moved to its final name.
class PendingFile {
 public:
  explicit PendingFile(const std::filesystem::path& path)
      : final_(path), temporary_(path.string() + fmt::format(".{}.part", ::getpid())) {
    descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
    if (descriptor_ < 0) failed_ = errno;
  }
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;
  ~PendingFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
    if (!moved_) ::unlink(temporary_.c_str());
  }

  void append(const std::string& bytes) {
    std::size_t done = 0;
    while (failed_ == 0 && done < bytes.size()) {
      const ssize_t wrote = ::write(descriptor_, bytes.data() + done, bytes.size() - done);
      if (wrote >= 0)
        done += static_cast<std::size_t>(wrote);
      else if (errno != EINTR)
        failed_ = errno;
    }
  }

  Status finish() {
    if (failed_ == 0 && ::fsync(descriptor_) != 0) failed_ = errno;
    if (descriptor_ >= 0 && ::close(descriptor_) != 0 && failed_ == 0) failed_ = errno;
    descriptor_ = -1;
    if (failed_ == 0 && ::rename(temporary_.c_str(), final_.c_str()) != 0) failed_ = errno;
    if (failed_ != 0) return io_error(fmt::format("{}: {}", final_.string(), std::strerror(failed_)));
    moved_ = true;
    return ok_status();
  }

 private:
  std::filesystem::path final_;
  std::filesystem::path temporary_;
  int descriptor_ = -1;
  int failed_ = 0;  // the first errno
  bool moved_ = false;
};

template <class Value>
void put(std::string& bytes, Value value) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  bytes.append(raw, sizeof value);
}

void put_vector(std::string& bytes, const Eigen::Vector3d& v) {
  for (int k = 0; k < 3; ++k) put(bytes, static_cast<float>(v[k]));
}

Status check(const TriangleMesh& mesh) {
  if (mesh.triangles.size() > std::numeric_limits<std::uint32_t>::max()) {
    return invalid_input(
        fmt::format("{} triangles are more than a binary STL can count", mesh.triangles.size()));
  }
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    if (!(mesh.vertices[v].cwiseAbs().maxCoeff() <= std::numeric_limits<float>::max())) {
      return invalid_input(fmt::format("vertex {}: a coordinate is no finite float", v));
    }
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const int v : mesh.triangles[t]) {
      if (v >= 0 && static_cast<std::size_t>(v) < mesh.vertices.size()) continue;
      return invalid_input(fmt::format("triangle {}: index {} of {} vertices", t, v, mesh.vertices.size()));
    }
  }
  return ok_status();
}

}  // namespace

Status write_stl(const TriangleMesh& mesh, const std::filesystem::path& path) {
  if (Status s = check(mesh); !s.ok()) return s;
  PendingFile file(path);
  std::string bytes("skinframe binary STL, millimetres");  // must not begin with "solid"
  bytes.resize(80, ' ');
  put(bytes, static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const auto& [a, b, c] : mesh.triangles) {
    const Eigen::Vector3d& p = mesh.vertices[a];
    const Eigen::Vector3d normal = (mesh.vertices[b] - p).cross(mesh.vertices[c] - p);
    put_vector(bytes, normal.squaredNorm() > 0 ? normal.normalized() : normal);
    put_vector(bytes, p);
    put_vector(bytes, mesh.vertices[b]);
    put_vector(bytes, mesh.vertices[c]);
    put(bytes, std::uint16_t{0});
    if (bytes.size() >= kBufferBytes) {
      file.append(bytes);
      bytes.clear();
    }
  }
  file.append(bytes);
  return file.finish();
}

}  // namespace skinframe
