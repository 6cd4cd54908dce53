// SPDX-License-Identifier: Apache-2.0
#include "tests/integration/printed_layers.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <string>

namespace skinframe::integration {
namespace {

// Where the print head is, and how much filament it has fed.
struct Head {
  double x = 0, y = 0, z = 0, e = 0;
  bool relative_e = false;
};

// The words of a line behind its command, by letter.
std::map<char, double> words_of(const std::string& line, std::size_t from) {
  std::map<char, double> words;
  for (const char* at = line.c_str() + from; *at != '\0' && *at != ';';) {
    if (*at < 'A' || *at > 'Z') {
      ++at;
      continue;
    }
    char* end = nullptr;
    const double value = std::strtod(at + 1, &end);
    if (end != at + 1) words[*at] = value;
    at = std::max<const char*>(end, at + 1);
  }
  return words;
}

class Lattice {
 public:
  Lattice(const std::vector<PrintedLayer>& layers, const LayerRule& rule) : rule_(rule) {
    double max_x = -std::numeric_limits<double>::infinity(), max_y = max_x;
    min_x_ = min_y_ = std::numeric_limits<double>::infinity();
    for (const PrintedLayer& layer : layers)
      for (const Stroke& s : layer.strokes) {
        min_x_ = std::min({min_x_, s.from_x, s.to_x});
        min_y_ = std::min({min_y_, s.from_y, s.to_y});
        max_x = std::max({max_x, s.from_x, s.to_x});
        max_y = std::max({max_y, s.from_y, s.to_y});
      }
    min_x_ -= rule.width_mm;
    min_y_ -= rule.width_mm;
    nx_ = static_cast<int>((max_x + rule.width_mm - min_x_) / rule.pitch_mm) + 1;
    ny_ = static_cast<int>((max_y + rule.width_mm - min_y_) / rule.pitch_mm) + 1;
  }

  std::vector<char> draw(const PrintedLayer& layer) const {
    std::vector<char> cells(static_cast<std::size_t>(nx_) * ny_, 0);
    const double half = 0.5 * rule_.width_mm;
    for (const Stroke& s : layer.strokes) {
      const double dx = s.to_x - s.from_x, dy = s.to_y - s.from_y;
      const double squared = std::max(dx * dx + dy * dy, 1e-12);
      const int x0 = cell(std::min(s.from_x, s.to_x) - half - min_x_);
      const int x1 = cell(std::max(s.from_x, s.to_x) + half - min_x_);
      const int y0 = cell(std::min(s.from_y, s.to_y) - half - min_y_);
      const int y1 = cell(std::max(s.from_y, s.to_y) + half - min_y_);
      for (int y = y0; y <= y1; ++y)
        for (int x = x0; x <= x1; ++x) {
          const double px = x_of(x) - s.from_x, py = y_of(y) - s.from_y;
          const double t = std::clamp((px * dx + py * dy) / squared, 0.0, 1.0);
          if (std::hypot(px - t * dx, py - t * dy) <= half) cells[index(x, y)] = 1;
        }
    }
    return cells;
  }

  std::vector<std::vector<int>> parts(const std::vector<char>& cells) const {
    std::vector<char> seen(cells.size(), 0);
    std::vector<std::vector<int>> all;
    for (int start = 0; start < static_cast<int>(cells.size()); ++start) {
      if (!cells[start] || seen[start]) continue;
      std::vector<int> part{start};
      seen[start] = 1;
      for (std::size_t k = 0; k < part.size(); ++k)
        around(part[k], 1, [&](int other) {
          if (cells[other] && !seen[other]) {
            seen[other] = 1;
            part.push_back(other);
          }
        });
      all.push_back(std::move(part));
    }
    return all;
  }

  bool touches(const std::vector<int>& part, const std::vector<char>& below) const {
    const double reach = std::max(rule_.reach_mm / rule_.pitch_mm, 1.5);  // cells; a diagonal at least
    bool found = false;
    for (std::size_t k = 0; k < part.size() && !found; ++k)
      around(part[k], static_cast<int>(std::ceil(reach)), [&](int other) {
        found = found || (below[other] && std::hypot(other % nx_ - part[k] % nx_,
                                                     other / nx_ - part[k] / nx_) <= reach + 1e-9);
      });
    return found;
  }

  FloatingPart describe(const std::vector<int>& part, double z) const {
    return {x_of(part.front() % nx_), y_of(part.front() / nx_), z,
            static_cast<double>(part.size()) * rule_.pitch_mm * rule_.pitch_mm};
  }

 private:
  int cell(double at) const { return static_cast<int>(at / rule_.pitch_mm); }
  std::size_t index(int x, int y) const { return static_cast<std::size_t>(y) * nx_ + x; }
  double x_of(int x) const { return min_x_ + (x + 0.5) * rule_.pitch_mm; }
  double y_of(int y) const { return min_y_ + (y + 0.5) * rule_.pitch_mm; }
  template <class Visit>
  void around(int at, int cells, Visit visit) const {
    const int x = at % nx_, y = at / nx_;
    for (int ny = std::max(0, y - cells); ny <= std::min(ny_ - 1, y + cells); ++ny)
      for (int nx = std::max(0, x - cells); nx <= std::min(nx_ - 1, x + cells); ++nx)
        visit(static_cast<int>(index(nx, ny)));
  }

  LayerRule rule_;
  double min_x_, min_y_;
  int nx_, ny_;
};

}  // namespace

std::vector<PrintedLayer> read_layers(std::istream& gcode) {
  std::map<long, PrintedLayer> layers;  // by height in micrometres
  Head head;
  for (std::string line; std::getline(gcode, line);) {
    const std::string command = line.substr(0, line.find_first_of(" ;\r"));
    if (command == "M82" || command == "M83") head.relative_e = command == "M83";
    const bool moves = command == "G0" || command == "G1";
    if (!moves && command != "G92") continue;
    const Head before = head;
    const auto words = words_of(line, command.size());
    const auto take = [&](char letter, double* value) {
      if (const auto at = words.find(letter); at != words.end()) *value = at->second;
    };
    take('X', &head.x);
    take('Y', &head.y);
    take('Z', &head.z);
    double fed = 0;
    if (const auto at = words.find('E'); at != words.end()) {
      fed = head.relative_e ? at->second : at->second - before.e;
      head.e = at->second;
    }
    const bool goes = head.x != before.x || head.y != before.y;
    if (!moves || !(fed > 0) || !goes) continue;
    PrintedLayer& layer = layers[std::lround(head.z * 1000)];
    layer.z_mm = head.z;
    layer.strokes.push_back({before.x, before.y, head.x, head.y});
  }
  std::vector<PrintedLayer> list;
  for (auto& [height, layer] : layers) list.push_back(std::move(layer));
  return list;
}

std::vector<FloatingPart> parts_in_the_air(const std::vector<PrintedLayer>& layers, const LayerRule& rule) {
  std::vector<FloatingPart> floating;
  if (layers.empty()) return floating;
  const Lattice lattice(layers, rule);
  std::vector<char> below = lattice.draw(layers.front());
  for (std::size_t k = 1; k < layers.size(); ++k) {
    std::vector<char> cells = lattice.draw(layers[k]);
    for (const std::vector<int>& part : lattice.parts(cells)) {
      const FloatingPart told = lattice.describe(part, layers[k].z_mm);
      if (told.area_mm2 > rule.least_mm2 && !lattice.touches(part, below)) floating.push_back(told);
    }
    below = std::move(cells);
  }
  return floating;
}

}  // namespace skinframe::integration
