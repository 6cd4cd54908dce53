// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/mesh/threemf_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "worker/mesh/text_scanner.h"
#include "worker/mesh/xml_stream.h"

namespace skinframe {
namespace {

constexpr std::string_view kCore = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02";
constexpr std::string_view kCoreDraft = "http://schemas.microsoft.com/3dmanufacturing/2013/01";
constexpr std::string_view kProduction = "http://schemas.microsoft.com/3dmanufacturing/production/2015/06";
constexpr std::string_view kMaterials = "http://schemas.microsoft.com/3dmanufacturing/material/2015/02";
constexpr std::string_view kTriangleSets =
    "http://schemas.microsoft.com/3dmanufacturing/trianglesets/2021/07";
constexpr std::string_view kBeamLattice = "http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02";

constexpr std::string_view kFamily = "http://schemas.microsoft.com/3dmanufacturing/";  // left out of messages

constexpr std::uint64_t kMostObjects = 100'000, kMostReferences = 100'000;

struct Unit {
  std::string_view name;
  double mm;
};
constexpr Unit kUnits[] = {{"micron", 1e-3}, {"millimeter", 1}, {"centimeter", 10},
                           {"inch", 25.4},   {"foot", 304.8},   {"meter", 1000}};

bool is_core(std::string_view uri) { return uri == kCore || uri == kCoreDraft; }

// These change neither the geometry nor what of it is printed, or are read here.
bool may_be_required(std::string_view uri) {
  return is_core(uri) || uri == kProduction || uri == kMaterials || uri == kTriangleSets;
}

enum class Tag {
  kModel,
  kResources,
  kObject,
  kMesh,
  kVertices,
  kVertex,
  kTriangles,
  kTriangle,
  kComponents,
  kComponent,
  kBuild,
  kItem,
  kOther,  // and whatever lies in it
};

struct Known {
  Tag parent;
  std::string_view name;
  Tag tag;
};
constexpr Known kKnown[] = {
    {Tag::kModel, "resources", Tag::kResources},
    {Tag::kModel, "build", Tag::kBuild},
    {Tag::kResources, "object", Tag::kObject},
    {Tag::kObject, "mesh", Tag::kMesh},
    {Tag::kObject, "components", Tag::kComponents},
    {Tag::kMesh, "vertices", Tag::kVertices},
    {Tag::kMesh, "triangles", Tag::kTriangles},
    {Tag::kVertices, "vertex", Tag::kVertex},
    {Tag::kTriangles, "triangle", Tag::kTriangle},
    {Tag::kComponents, "component", Tag::kComponent},
    {Tag::kBuild, "item", Tag::kItem},
};

Tag tag_of(Tag parent, const XmlElement& element) {
  if (!is_core(element.namespace_uri())) return Tag::kOther;
  for (const Known& known : kKnown) {
    if (known.parent == parent && known.name == element.name()) return known.tag;
  }
  return Tag::kOther;
}

Result<std::uint32_t> read_id(const XmlElement& element, std::string_view name, std::uint64_t line) {
  const auto word = element.attribute(name);
  if (!word) return line_error(line, fmt::format("<{}> has no {}", element.name(), name));
  const auto value = parse_integer(trim(*word));
  // Indices and ids are below 2^31 (3MF Core, ST_ResourceID).
  if (!value || *value < 0 || *value >= (std::int64_t{1} << 31))
    return line_error(line, fmt::format("{}={} is no number below 2^31", name, skinframe::quoted(*word)));
  return static_cast<std::uint32_t>(*value);
}

// Twelve numbers, row by row of the 4 x 3 matrix by which 3MF multiplies row vectors from the right.
Result<Placing> read_placing(const XmlElement& element, std::uint64_t line) {
  Placing placing = Placing::Identity();
  const auto text = element.attribute("transform");
  if (!text) return placing;
  std::string_view rest = *text;
  for (int i = 0; i < 12; ++i) {
    const std::string_view word = take_word(rest);
    const auto value = parse_finite(word);
    if (!value)
      return line_error(
          line, fmt::format("a transform has 12 finite numbers, and {} is none", skinframe::quoted(word)));
    placing.matrix()(i % 3, i / 3) = *value;
  }
  if (!trim(rest).empty()) return line_error(line, "a transform has 12 numbers, and more are here");
  if (placing.linear().determinant() == 0) return line_error(line, "a transform flattens its object");
  return placing;
}

}  // namespace

struct ThreeMfReader::State : XmlListener {
  State(const std::string& part, const ReadLimits& most, ThreeMfCounts& all)
      : limits(most), counts(all), xml(part, *this) {}

  const ReadLimits& limits;
  ThreeMfCounts& counts;
  ThreeMfModel model;
  bool is_model = false;
  std::vector<Tag> open;
  std::map<std::string, std::string, std::less<>> namespace_of_prefix;
  std::set<std::uint32_t> ids;
  XmlStream xml;  // last: it calls what stands above

  void declare_prefix(std::string_view prefix, std::string_view uri) override {
    // Those of the model tag count; a document cannot fill the table with others.
    if (open.empty() && namespace_of_prefix.size() < 100) namespace_of_prefix.emplace(prefix, uri);
  }

  Status begin(const XmlElement& element, std::uint64_t line) override {
    if (open.empty()) {
      open.push_back(Tag::kModel);
      return begin_model(element, line);
    }
    const Tag tag = tag_of(open.back(), element);
    open.push_back(tag);
    switch (tag) {
      case Tag::kObject:
        return begin_object(element, line);
      case Tag::kVertex:
        return add_vertex(element, line);
      case Tag::kTriangle:
        return add_triangle(element, line);
      case Tag::kComponent:
        return add_reference(element, line, model.objects.back().components);
      case Tag::kItem:
        return add_reference(element, line, model.build);
      case Tag::kOther:
        if (element.namespace_uri() == kBeamLattice && !model.objects.empty() &&
            element.name() == "beamlattice")
          model.objects.back().has_beams = true;
        return ok_status();
      default:
        return ok_status();
    }
  }

  Status end() override {
    const Tag closed = open.back();
    open.pop_back();
    return closed == Tag::kObject ? check_indices(model.objects.back()) : ok_status();
  }

  Status begin_model(const XmlElement& element, std::uint64_t line) {
    if (element.name() != "model" || !is_core(element.namespace_uri()))
      return line_error(line, fmt::format("a 3MF part begins with <model>, not with <{}>",
                                          skinframe::quoted(element.name())));
    is_model = true;
    model.unit = trim(element.attribute("unit").value_or("millimeter"));
    const auto* unit = std::find_if(std::begin(kUnits), std::end(kUnits),
                                    [&](const Unit& u) { return u.name == model.unit; });
    if (unit == std::end(kUnits))
      return line_error(line, fmt::format("{} is no unit of 3MF", skinframe::quoted(model.unit)));
    model.mm_per_unit = unit->mm;
    std::string_view required = element.attribute("requiredextensions").value_or("");
    for (std::string_view prefix = take_word(required); !prefix.empty(); prefix = take_word(required)) {
      const auto place = namespace_of_prefix.find(prefix);
      std::string_view uri = place == namespace_of_prefix.end() ? prefix : std::string_view(place->second);
      if (!may_be_required(uri)) {
        if (uri.starts_with(kFamily)) uri.remove_prefix(kFamily.size());
        return unsupported(fmt::format(
            "line {}: the file requires the 3MF extension {}, which is not read; export a plain mesh", line,
            skinframe::quoted(uri)));
      }
    }
    return ok_status();
  }

  Status begin_object(const XmlElement& element, std::uint64_t line) {
    const auto id = read_id(element, "id", line);
    if (!id.ok()) return id.error();
    if (!ids.insert(*id).second) return line_error(line, fmt::format("a second object has the id {}", *id));
    if (Status s = check_count(++counts.objects, kMostObjects, "objects"); !s.ok()) return s;
    model.objects.emplace_back();
    model.objects.back().id = *id;
    model.objects.back().type = trim(element.attribute("type").value_or("model"));
    return ok_status();
  }

  Status add_vertex(const XmlElement& element, std::uint64_t line) {
    if (Status s = check_count(++counts.vertices, limits.max_vertices, "vertices"); !s.ok()) return s;
    static constexpr std::string_view kAxes[] = {"x", "y", "z"};
    Eigen::Vector3d p;
    for (int k = 0; k < 3; ++k) {
      const auto word = element.attribute(kAxes[k]);
      const auto value = word ? parse_finite(trim(*word)) : std::nullopt;
      if (!value) {
        return line_error(line, fmt::format("{}={} is not a finite coordinate", kAxes[k],
                                            skinframe::quoted(word.value_or(""))));
      }
      p[k] = *value;
    }
    model.objects.back().vertices.push_back(p);
    return ok_status();
  }

  Status add_triangle(const XmlElement& element, std::uint64_t line) {
    if (Status s = check_count(++counts.triangles, limits.max_triangles, "triangles"); !s.ok()) return s;
    static constexpr std::string_view kNames[] = {"v1", "v2", "v3"};
    std::array<int, 3> triangle{};
    for (int k = 0; k < 3; ++k) {
      const auto index = read_id(element, kNames[k], line);
      if (!index.ok()) return index.error();
      triangle[k] = static_cast<int>(*index);
    }
    model.objects.back().triangles.push_back(triangle);
    return ok_status();
  }

  Status add_reference(const XmlElement& element, std::uint64_t line, std::vector<ThreeMfReference>& list) {
    if (Status s = check_count(++counts.references, kMostReferences, "components and items"); !s.ok())
      return s;
    ThreeMfReference reference;
    const auto object = read_id(element, "objectid", line);
    if (!object.ok()) return object.error();
    const auto placing = read_placing(element, line);
    if (!placing.ok()) return placing.error();
    reference.object = *object;
    reference.placing = *placing;
    reference.part = element.attribute("path", kProduction).value_or("");
    reference.printable = trim(element.attribute("printable").value_or("1")) != "0";
    list.push_back(std::move(reference));
    return ok_status();
  }

  // Triangles may stand ahead of the vertices, so only a whole object can be judged.
  static Status check_indices(const ThreeMfObject& object) {
    const auto count = static_cast<int>(object.vertices.size());
    for (std::size_t t = 0; t < object.triangles.size(); ++t) {
      for (const int v : object.triangles[t]) {
        if (v < count) continue;
        return invalid_input(
            fmt::format("object {}: triangle {}: index {} of {} vertices", object.id, t, v, count));
      }
    }
    return ok_status();
  }
};

ThreeMfReader::ThreeMfReader(const std::string& part_name, const ReadLimits& limits, ThreeMfCounts& counts)
    : state_(std::make_unique<State>(part_name, limits, counts)) {}
ThreeMfReader::~ThreeMfReader() = default;

Status ThreeMfReader::feed(std::string_view chunk) { return state_->xml.feed(chunk); }

Result<ThreeMfModel> ThreeMfReader::finish() {
  if (Status s = state_->xml.finish(); !s.ok()) return s.error();
  SKINFRAME_CHECK(state_->is_model);  // a document that is whole has a root, and the root was judged
  return std::move(state_->model);
}

}  // namespace skinframe
