// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/picture/size_curves.h"

#include <fmt/format.h>

#include <algorithm>

#include "worker/picture/sheet.h"
#include "worker/raster/strokes.h"
#include "worker/raster/text.h"

namespace skinframe::picture {
namespace {

// Okabe and Ito's, told apart by most eyes; the last stage's is the strongest.
constexpr Colour kColours[] = {{150, 154, 160}, {86, 180, 233}, {230, 159, 0}, {0, 114, 178}};
constexpr Colour kLast{0, 114, 178};

Colour colour_of(std::size_t stage, std::size_t count) {
  return stage + 1 == count ? kLast : kColours[std::min<std::size_t>(stage, 2)];
}

struct Axes {
  double left, right, top, bottom;  // in px
  double end_x, end_y;              // both begin at 0
  Eigen::Vector2d px(const Eigen::Vector2d& p) const {
    return {left + p.x() / end_x * (right - left), bottom - p.y() / end_y * (bottom - top)};
  }
};

void draw_axes(Sheet& sheet, const Axes& axes, const std::string& below) {
  Image& image = sheet.image();
  const double text = sheet.text_px();
  const double step_x = tick_step(0, axes.end_x), step_y = tick_step(0, axes.end_y);
  for (int k = 0; k * step_x <= axes.end_x * (1 + 1e-9); ++k) {
    const double x = axes.px({k * step_x, 0}).x();
    fill_rectangle(image, x - 0.5, axes.top, x + 0.5, axes.bottom, kFaint);
    draw_text(image, x, axes.bottom + 1.3 * text, tick_text(k * step_x, step_x), text, kInk, Align::kCentre);
  }
  for (int k = 0; k * step_y <= axes.end_y * (1 + 1e-9); ++k) {
    const double y = axes.px({0, k * step_y}).y();
    fill_rectangle(image, axes.left, y - 0.5, axes.right, y + 0.5, kFaint);
    draw_text(image, axes.left - 0.4 * text, y + 0.35 * text, tick_text(k * step_y, step_y), text, kInk,
              Align::kRight);
  }
  fill_rectangle(image, axes.left, axes.bottom - 0.75, axes.right, axes.bottom + 0.75, kInk);
  draw_text(image, (axes.left + axes.right) / 2, axes.bottom + 2.8 * text, below, text, kInk, Align::kCentre);
}

// Points nearer than a quarter of a pixel to the last one kept say nothing new.
std::vector<Eigen::Vector2d> thinned(const std::vector<Eigen::Vector2d>& points) {
  std::vector<Eigen::Vector2d> kept;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (kept.empty() || i + 1 == points.size() || (points[i] - kept.back()).norm() >= 0.25)
      kept.push_back(points[i]);
  return kept;
}

}  // namespace

std::vector<Eigen::Vector2d> cumulative(std::vector<double> values, double end) {
  std::sort(values.begin(), values.end());
  std::vector<Eigen::Vector2d> corners = {{0, 0}};
  for (std::size_t i = 0; i < values.size();) {
    std::size_t next = i;
    while (next < values.size() && values[next] == values[i]) ++next;
    corners.emplace_back(values[i], double(i));
    corners.emplace_back(values[i], double(next));
    i = next;
  }
  corners.emplace_back(end, double(values.size()));
  return corners;
}

Image curves_picture(const std::vector<StageSizes>& stages, StrutSize size, const std::string& title,
                     int side_px) {
  const bool radius = size == StrutSize::kRadius;
  const auto values = [&](const StageSizes& stage) -> const std::vector<double>& {
    return radius ? stage.radii_mm : stage.lengths_mm;
  };
  double end_x = 0, end_y = 1;
  for (const StageSizes& stage : stages) {
    end_y = std::max(end_y, double(values(stage).size()));
    for (const double v : values(stage)) end_x = std::max(end_x, v);
  }
  end_x = end_x > 0 ? 1.02 * end_x : 1;
  Sheet sheet(side_px, side_px * 3 / 4, title,
              radius ? "number of struts no thicker than" : "number of struts no longer than", false);
  const double text = sheet.text_px();
  const Place body = sheet.body();
  const Axes axes{
      body.x + 3.5 * text, body.x + body.width - text, body.y + text, body.y + body.height - 3 * text, end_x,
      1.05 * end_y};
  draw_axes(sheet, axes, radius ? "radius mm" : "length mm");
  // Earlier curves are wider: where two run together both are seen.
  for (std::size_t k = 0; k < stages.size(); ++k) {
    std::vector<Eigen::Vector2d> points;
    for (const Eigen::Vector2d& corner : cumulative(values(stages[k]), end_x))
      points.push_back(axes.px(corner));
    draw_polyline(sheet.image(), thinned(points), text * (0.16 + 0.11 * double(stages.size() - 1 - k)),
                  colour_of(k, stages.size()));
  }
  double y = axes.bottom - 0.8 * text - 1.5 * text * double(stages.size() - 1);
  for (std::size_t k = 0; k < stages.size(); ++k, y += 1.5 * text) {
    const std::string label = fmt::format("{}: {} struts", stages[k].name, values(stages[k]).size());
    const double x = axes.right - 0.6 * text - text_width_px(label, text);
    fill_rectangle(sheet.image(), x - 1.6 * text, y - text, axes.right, y + 0.4 * text, kWhite);
    fill_rectangle(sheet.image(), x - 1.3 * text, y - 0.5 * text, x - 0.3 * text, y - 0.15 * text,
                   colour_of(k, stages.size()));
    draw_text(sheet.image(), x, y, label, text, kInk);
  }
  return std::move(sheet.image());
}

}  // namespace skinframe::picture
