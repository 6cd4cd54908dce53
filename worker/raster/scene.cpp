// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/raster/scene.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "worker/run/result.h"

namespace skinframe {
namespace {

constexpr int kSamples = 2;  // along each side of a pixel
constexpr float kNothing = -std::numeric_limits<float>::infinity();
constexpr std::int64_t kGrid = 256;  // steps of a rounded corner to a sample
constexpr double kFurthestPx = 1e6;  // corners further out are drawn in to here, so that products fit
constexpr double kCrease = 0.85;     // cosine: a corner is smooth where its faces lean no more than this

// A key light from the upper left before the object, a weaker one from the right, and what comes from
// everywhere.
double brightness(const Eigen::Vector3d& normal) {
  static const Eigen::Vector3d key = Eigen::Vector3d(-0.45, 0.65, 0.8).normalized();
  static const Eigen::Vector3d fill = Eigen::Vector3d(0.8, 0.1, 0.6).normalized();
  return std::min(1.0, 0.5 + 0.5 * std::max(0.0, normal.dot(key)) + 0.18 * std::max(0.0, normal.dot(fill)));
}

std::uint8_t to_byte(double value) { return static_cast<std::uint8_t>(std::clamp(value, 0.0, 255.0) + 0.5); }

}  // namespace

struct Scene::Corner {
  Eigen::Vector3d seen;    // x, y in samples, depth in mm
  Eigen::Vector3d normal;  // in the view's axes
  Colour colour;
};

Scene::Scene(int width_px, int height_px, const Camera& camera, std::optional<CutPlane> cut)
    : width_(kSamples * width_px),
      height_(kSamples * height_px),
      camera_(camera.scaled(kSamples)),
      cut_(cut) {
  SKINFRAME_CHECK(width_px >= 1 && height_px >= 1 && width_ <= kMaxSidePx && height_ <= kMaxSidePx);
  const std::size_t samples = std::size_t(width_) * std::size_t(height_);
  depth_mm_.assign(samples, kNothing);
  lit_.assign(samples, {0, 0, 0, 0});
  if (!cut_) return;
  cut_seen_ = camera_.axes * cut_->normal;
  SKINFRAME_CHECK(cut_seen_.z() > 0.01);
  exits_.assign(samples, 0);
}

double Scene::cut_depth_mm(int x, int y) const {
  const double right = (x + 0.5 - camera_.shift_px.x()) / camera_.px_per_mm;
  const double up = (camera_.shift_px.y() - y - 0.5) / camera_.px_per_mm;
  return (cut_->offset_mm - cut_seen_.x() * right - cut_seen_.y() * up) / cut_seen_.z();
}

void Scene::put(std::size_t sample, double depth_mm, const Eigen::Vector3d& normal, const Colour& colour) {
  put_lit(sample, depth_mm, brightness(normal), colour);
}

void Scene::put_lit(std::size_t sample, double depth_mm, double light, const Colour& colour) {
  const auto depth = static_cast<float>(depth_mm);
  if (!(depth > depth_mm_[sample])) return;
  depth_mm_[sample] = depth;
  lit_[sample] = {to_byte(colour[0] * light), to_byte(colour[1] * light), to_byte(colour[2] * light), 255};
}

void Scene::add_triangle(const Corner (&corners)[3], Colour front, Colour back, bool by_corner) {
  std::int64_t x[3], y[3];
  for (int k = 0; k < 3; ++k) {
    x[k] = std::llround(std::clamp(corners[k].seen.x(), -kFurthestPx, kFurthestPx) * kGrid);
    y[k] = std::llround(std::clamp(corners[k].seen.y(), -kFurthestPx, kFurthestPx) * kGrid);
  }
  std::int64_t area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
  if (area == 0) return;
  const bool faces_viewer = area < 0;  // y runs down
  int order[3] = {0, 1, 2};
  if (faces_viewer) {
    std::swap(order[1], order[2]);
    area = -area;
  }
  const auto floor_sample = [](std::int64_t v) { return v >> 8; };
  const int left = static_cast<int>(std::max<std::int64_t>(0, floor_sample(std::min({x[0], x[1], x[2]}))));
  const int right =
      static_cast<int>(std::min<std::int64_t>(width_ - 1, floor_sample(std::max({x[0], x[1], x[2]}))));
  const int top = static_cast<int>(std::max<std::int64_t>(0, floor_sample(std::min({y[0], y[1], y[2]}))));
  const int bottom =
      static_cast<int>(std::min<std::int64_t>(height_ - 1, floor_sample(std::max({y[0], y[1], y[2]}))));

  // Edge k runs opposite of corner k; a sample on it counts when it is a top or a left one.
  std::int64_t step_x[3], step_y[3], start[3], bias[3];
  for (int k = 0; k < 3; ++k) {
    const int a = order[(k + 1) % 3], b = order[(k + 2) % 3];
    const std::int64_t dx = x[b] - x[a], dy = y[b] - y[a];
    step_x[k] = -dy * kGrid;
    step_y[k] = dx * kGrid;
    start[k] = dx * (top * kGrid + kGrid / 2 - y[a]) - dy * (left * kGrid + kGrid / 2 - x[a]);
    bias[k] = dy < 0 || (dy == 0 && dx > 0) ? 0 : -1;
  }
  for (int row = top; row <= bottom; ++row) {
    std::int64_t edge[3] = {start[0], start[1], start[2]};
    for (int column = left; column <= right; ++column) {
      if (edge[0] + bias[0] >= 0 && edge[1] + bias[1] >= 0 && edge[2] + bias[2] >= 0) {
        double share[3];
        for (int k = 0; k < 3; ++k) share[order[k]] = double(edge[k]) / double(area);
        double depth = 0;
        for (int k = 0; k < 3; ++k) depth += share[k] * corners[k].seen.z();
        const std::size_t sample = std::size_t(row) * std::size_t(width_) + std::size_t(column);
        bool kept = true;
        if (cut_) {
          kept = depth <= cut_depth_mm(column, row);
          std::int16_t& exits = exits_[sample];
          if (kept && exits < 32767 && exits > -32767) exits = std::int16_t(exits + (faces_viewer ? -1 : 1));
        }
        if (kept && depth > depth_mm_[sample]) {
          Eigen::Vector3d normal = Eigen::Vector3d::Zero();
          for (int k = 0; k < 3; ++k) normal += share[k] * corners[k].normal;
          normal.normalize();
          if (normal.z() < 0) normal = -normal;
          Colour colour = faces_viewer ? front : back;
          if (by_corner)
            for (int c = 0; c < 3; ++c)
              colour[c] = to_byte(share[0] * corners[0].colour[c] + share[1] * corners[1].colour[c] +
                                  share[2] * corners[2].colour[c]);
          put(sample, depth, normal, colour);
        }
      }
      for (int k = 0; k < 3; ++k) edge[k] += step_x[k];
    }
    for (int k = 0; k < 3; ++k) start[k] += step_y[k];
  }
}

void Scene::add(const TriangleMesh& mesh, const std::vector<Colour>* vertex_colours, Colour front,
                Colour back) {
  std::vector<Eigen::Vector3d> normals(mesh.vertices.size(), Eigen::Vector3d::Zero());
  const auto twice_area = [&](const std::array<int, 3>& t) -> Eigen::Vector3d {
    return (mesh.vertices[t[1]] - mesh.vertices[t[0]]).cross(mesh.vertices[t[2]] - mesh.vertices[t[0]]);
  };
  for (const auto& t : mesh.triangles)
    for (const int v : t) normals[v] += twice_area(t);
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3d flat = twice_area(t).normalized();
    Corner corners[3];
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d smooth = normals[t[k]].normalized();
      corners[k] = {camera_.project(mesh.vertices[t[k]]),
                    camera_.axes * (smooth.dot(flat) > kCrease ? smooth : flat),
                    vertex_colours != nullptr ? (*vertex_colours)[t[k]] : front};
    }
    add_triangle(corners, front, back, vertex_colours != nullptr);
  }
}

void Scene::add_mesh(const TriangleMesh& mesh, Colour front, Colour back) { add(mesh, nullptr, front, back); }

void Scene::add_mesh(const TriangleMesh& mesh, const std::vector<Colour>& vertex_colours) {
  SKINFRAME_CHECK(vertex_colours.size() == mesh.vertices.size());
  add(mesh, &vertex_colours, kWhite, kWhite);
}

void Scene::close_cut(Colour colour) {
  if (!cut_) return;
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x) {
      const std::size_t sample = std::size_t(y) * std::size_t(width_) + std::size_t(x);
      if (exits_[sample] > 0) put_lit(sample, cut_depth_mm(x, y), 1, colour);
    }
}

double Scene::covered_share() const {
  return double(std::count_if(lit_.begin(), lit_.end(), [](const auto& s) { return s[3] != 0; })) /
         double(lit_.size());
}

// Mean amount by which the surroundings stand before this sample, in [0, 1]. Opposite neighbours are taken
// together: a plane, however slanted, does not darken itself.
double Scene::darkness(int x, int y) const {
  static constexpr int kTowards[8][2] = {{4, 0}, {4, 2}, {3, 3}, {2, 4}, {0, 4}, {-2, 4}, {-3, 3}, {-4, 2}};
  const float here = depth_mm_[std::size_t(y) * std::size_t(width_) + std::size_t(x)];
  const int side = std::max(width_, height_);
  double sum = 0;
  int rings = 0;
  for (const int radius : {side / 400, side / 160, side / 64}) {
    const int step = std::max(1, radius / 4);
    const double range_mm = 4 * step / camera_.px_per_mm;
    const auto before = [&](int dx, int dy) {
      const int nx = x + dx * step, ny = y + dy * step;
      if (nx < 0 || ny < 0 || nx >= width_ || ny >= height_) return 0.0;
      const float there = depth_mm_[std::size_t(ny) * std::size_t(width_) + std::size_t(nx)];
      if (there == kNothing) return -range_mm;
      return std::clamp<double>(double(there) - double(here), -range_mm, range_mm);
    };
    for (const auto& d : kTowards) sum += std::max(0.0, before(d[0], d[1]) + before(-d[0], -d[1])) / range_mm;
    ++rings;
  }
  return std::min(1.0, sum / (8.0 * rings));
}

Image Scene::picture(Colour background, double darkest) const {
  Image image(width_ / kSamples, height_ / kSamples, background);
  for (int py = 0; py < image.height(); ++py)
    for (int px = 0; px < image.width(); ++px) {
      double sum[3] = {0, 0, 0};
      int covered = 0;
      for (int k = 0; k < kSamples * kSamples; ++k) {
        const int x = kSamples * px + k % kSamples, y = kSamples * py + k / kSamples;
        const auto& lit = lit_[std::size_t(y) * std::size_t(width_) + std::size_t(x)];
        if (lit[3] == 0) continue;
        ++covered;
        const double light = 1 - darkest * darkness(x, y);
        for (int c = 0; c < 3; ++c) sum[c] += light * lit[c];
      }
      if (covered == 0) continue;
      const Colour mean = {to_byte(sum[0] / covered), to_byte(sum[1] / covered), to_byte(sum[2] / covered)};
      image.blend(px, py, mean, double(covered) / (kSamples * kSamples));
    }
  return image;
}

}  // namespace skinframe
