// SPDX-License-Identifier: GPL-3.0-or-later
// 3MF: a ZIP package (OPC) whose relationships name a model part; the build of that part, with every
// component in its place, is the mesh. In mm.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "worker/mesh/mesh_formats.h"
#include "worker/mesh/text_scanner.h"
#include "worker/mesh/threemf_model.h"
#include "worker/mesh/xml_stream.h"
#include "worker/mesh/zip_archive.h"

namespace skinframe {
namespace {

constexpr std::string_view kRelationships = "_rels/.rels";
constexpr std::string_view kRelationshipsNamespace =
    "http://schemas.openxmlformats.org/package/2006/relationships";
constexpr std::string_view kModelRelationship =
    "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel";

constexpr int kDeepestComponents = 32;
// Of objects placed by the build: 2^31 copies of an empty object take time, though no memory.
constexpr std::uint64_t kMostInstances = 100'000;
constexpr std::uint64_t kMostParts = 1000;

// The target of the package's one relationship to a model.
class RelationshipReader : public XmlListener {
 public:
  void declare_prefix(std::string_view, std::string_view) override {}
  Status begin(const XmlElement& element, std::uint64_t) override {
    if (element.namespace_uri() != kRelationshipsNamespace || element.name() != "Relationship" || target)
      return ok_status();
    if (trim(element.attribute("Type").value_or("")) == kModelRelationship)
      target = std::string(trim(element.attribute("Target").value_or("")));
    return ok_status();
  }
  Status end() override { return ok_status(); }

  std::optional<std::string> target;
};

Result<std::string> find_model_part(ZipArchive& archive, RunContext& context) {
  if (!archive.contains(kRelationships)) {
    return invalid_input(fmt::format(
        "the ZIP archive is no 3MF package: it has no {}; export the mesh as 3MF, STL, OBJ, PLY or OFF",
        kRelationships));
  }
  RelationshipReader reader;
  XmlStream xml{std::string(kRelationships), reader};
  if (Status s = archive.stream(
          kRelationships, [&](std::string_view chunk) { return xml.feed(chunk); }, context);
      !s.ok()) {
    return s.error();
  }
  if (Status s = xml.finish(); !s.ok()) return s.error();
  if (!reader.target) return invalid_input("the 3MF package names no model part in its relationships");
  if (!archive.contains(*reader.target)) {
    return invalid_input(fmt::format("the 3MF package has no model part {}, which its relationships name",
                                     skinframe::quoted(*reader.target)));
  }
  return *reader.target;
}

// Parts by name and the objects in them by id.
class Package {
 public:
  Package(ZipArchive& archive, const ReadRequest& request) : archive_(archive), request_(request) {}

  // The root part and, when a reference of it names them, others; they may name none in turn (Production
  // Extension, 2.1).
  Status read(const std::string& root) {
    root_ = root;
    if (Status s = read_part(root); !s.ok()) return s;
    std::set<std::string> wanted;
    const auto collect = [&](const std::vector<ThreeMfReference>& references) {
      for (const auto& r : references)
        if (!r.part.empty()) wanted.insert(r.part);
    };
    collect(parts_.at(root).build);
    for (const ThreeMfObject& object : parts_.at(root).objects) collect(object.components);
    if (Status s = check_count(wanted.size(), kMostParts, "model parts"); !s.ok()) return s;
    for (const std::string& part : wanted) {
      if (part == root) continue;
      if (!archive_.contains(part)) {
        return invalid_input(fmt::format("the 3MF package has no part {}, which {} refers to",
                                         skinframe::quoted(part), skinframe::quoted(root)));
      }
      if (Status s = read_part(part); !s.ok()) return s;
      const ThreeMfModel& model = parts_.at(part);
      if (model.mm_per_unit != parts_.at(root).mm_per_unit) {
        return unsupported(fmt::format("the part {} is in {}s and the root part in {}s",
                                       skinframe::quoted(part), model.unit, parts_.at(root).unit));
      }
      for (const ThreeMfObject& object : model.objects) {
        for (const ThreeMfReference& r : object.components) {
          if (!r.part.empty() && r.part != part)
            return unsupported(
                fmt::format("the part {} refers to the part {}; only the root part may refer "
                            "to others",
                            skinframe::quoted(part), skinframe::quoted(r.part)));
        }
      }
    }
    return ok_status();
  }

  const ThreeMfModel& root() const { return parts_.at(root_); }

  // The object of a reference that stands in `part`, with the part it lies in.
  Result<std::pair<const ThreeMfObject*, std::string>> find(const ThreeMfReference& reference,
                                                            const std::string& part) const {
    const std::string& where = reference.part.empty() ? part : reference.part;
    const auto index = index_.find({where, reference.object});
    if (index == index_.end()) {
      return invalid_input(fmt::format("{} refers to object {}, which {} does not have",
                                       skinframe::quoted(part), reference.object, skinframe::quoted(where)));
    }
    return std::pair(&parts_.at(where).objects[index->second], where);
  }

 private:
  Status read_part(const std::string& name) {
    ThreeMfReader reader(name, request_.limits, counts_);
    if (Status s = archive_.stream(
            name, [&](std::string_view chunk) { return reader.feed(chunk); }, request_.context);
        !s.ok()) {
      return s;
    }
    auto model = reader.finish();
    if (!model.ok()) return model.error();
    for (std::size_t i = 0; i < model->objects.size(); ++i) index_[{name, model->objects[i].id}] = i;
    parts_.emplace(name, std::move(model).value());
    return ok_status();
  }

  ZipArchive& archive_;
  const ReadRequest& request_;
  std::string root_;
  ThreeMfCounts counts_;
  std::map<std::string, ThreeMfModel> parts_;
  std::map<std::pair<std::string, std::uint32_t>, std::size_t> index_;
};

// What an object comes to with all its components.
struct Extent {
  std::uint64_t vertices = 0, triangles = 0, instances = 0;
  int height = 0;  // of the tree of components
};

// Walks the objects twice: first counts, once an object, then copies, once an instance.
class Assembly {
 public:
  Assembly(const Package& package, const ReadRequest& request) : package_(package), request_(request) {}

  Result<Extent> measure(const ThreeMfReference& reference, const std::string& part, int depth) {
    if (depth > kDeepestComponents) return too_deep();
    const auto found = package_.find(reference, part);
    if (!found.ok()) return found.error();
    const auto& [object, where] = *found;
    const auto known = extents_.find(object);
    if (known != extents_.end()) return known->second;
    if (!on_the_way_.insert(object).second)
      return invalid_input(fmt::format("object {} is a component of itself", object->id));
    Extent extent{object->vertices.size(), object->triangles.size(), 1, 1};
    for (const ThreeMfReference& component : object->components) {
      const auto part_of_it = measure(component, where, depth + 1);
      if (!part_of_it.ok()) return part_of_it.error();
      extent.vertices += part_of_it->vertices;
      extent.triangles += part_of_it->triangles;
      extent.instances += part_of_it->instances;
      extent.height = std::max(extent.height, part_of_it->height + 1);
      // What was measured before may hang below anything: the depth above says nothing of it.
      if (extent.height > kDeepestComponents) return too_deep();
      // Checked at each step, so that no sum can run over.
      if (Status s = check(extent); !s.ok()) return s.error();
    }
    on_the_way_.erase(object);
    beams_ = beams_ || object->has_beams;
    extents_.emplace(object, extent);
    return extent;
  }

  Status check(const Extent& extent) const {
    if (Status s = check_count(extent.triangles, request_.limits.max_triangles, "triangles"); !s.ok())
      return s;
    if (Status s = check_count(extent.vertices, request_.limits.max_vertices, "vertices"); !s.ok()) return s;
    return check_count(extent.instances, kMostInstances, "instances of objects");
  }

  Status place(const ThreeMfReference& reference, const std::string& part, const Placing& outer,
               TriangleMesh& mesh) {
    if (request_.context.cancelled()) return cancelled_error();
    const auto found = package_.find(reference, part);
    if (!found.ok()) return found.error();
    const auto& [object, where] = *found;
    const Placing placing = outer * reference.placing;
    const int first = static_cast<int>(mesh.vertices.size());
    for (const Eigen::Vector3d& v : object->vertices) {
      const Eigen::Vector3d p = placing * v;
      if (!p.allFinite())
        return invalid_input(fmt::format("object {}: a transform leads beyond all numbers", object->id));
      mesh.vertices.push_back(p);
    }
    // A reflection turns triangles over: turned back, the material stays inside.
    const bool mirrored = placing.linear().determinant() < 0;
    mirrored_ += mirrored && !object->triangles.empty();
    for (const auto& [a, b, c] : object->triangles) {
      mesh.triangles.push_back({first + a, first + (mirrored ? c : b), first + (mirrored ? b : c)});
    }
    for (const ThreeMfReference& component : object->components) {
      if (Status s = place(component, where, placing, mesh); !s.ok()) return s;
    }
    return ok_status();
  }

  bool has_beams() const { return beams_; }
  std::size_t mirrored() const { return mirrored_; }

 private:
  static Error too_deep() {
    return invalid_input(fmt::format("components are nested more than {} deep", kDeepestComponents));
  }

  const Package& package_;
  const ReadRequest& request_;
  std::map<const ThreeMfObject*, Extent> extents_;
  std::set<const ThreeMfObject*> on_the_way_;
  bool beams_ = false;
  std::size_t mirrored_ = 0;
};

}  // namespace

Result<MeshFile> read_3mf(const ReadRequest& request) {
  auto archive = ZipArchive::open(request.bytes, ZipLimits{});
  if (!archive.ok()) return archive.error();
  const auto root = find_model_part(archive.value(), request.context);
  if (!root.ok()) return root.error();
  Package package(archive.value(), request);
  if (Status s = package.read(*root); !s.ok()) return s.error();

  MeshFile file;
  file.format = "3MF";
  const ThreeMfModel& model = package.root();
  Assembly assembly(package, request);
  std::vector<const ThreeMfReference*> printed;
  std::size_t supports = 0, unprinted = 0;
  Extent all;
  for (const ThreeMfReference& item : model.build) {
    const auto found = package.find(item, *root);
    if (!found.ok()) return found.error();
    const std::string& type = found->first->type;
    if (!item.printable) {
      ++unprinted;
    } else if (type == "support" || type == "solidsupport") {
      ++supports;
    } else if (type == "model" || type == "surface") {
      const auto extent = assembly.measure(item, *root, 0);
      if (!extent.ok()) return extent.error();
      all.vertices += extent->vertices;
      all.triangles += extent->triangles;
      all.instances += extent->instances;
      if (Status s = assembly.check(all); !s.ok()) return s.error();
      printed.push_back(&item);
    } else {
      return invalid_input(fmt::format("the build has object {} of type {}, which is not for printing",
                                       item.object, skinframe::quoted(type)));
    }
  }
  if (all.triangles == 0) {
    return invalid_input(
        fmt::format("the 3MF file holds no triangle to be printed ({} objects, {} items of the build)",
                    model.objects.size(), model.build.size()));
  }
  file.mesh.vertices.reserve(all.vertices);
  file.mesh.triangles.reserve(all.triangles);
  Placing to_mm = Placing::Identity();
  to_mm.linear() *= model.mm_per_unit;
  for (const ThreeMfReference* item : printed) {
    if (Status s = assembly.place(*item, *root, to_mm, file.mesh); !s.ok()) return s.error();
  }
  drop_unused_vertices(file.mesh);

  if (model.unit != "millimeter")
    file.notes.push_back(fmt::format("converted {} to mm (times {:g})", model.unit, model.mm_per_unit));
  if (printed.size() > 1)
    file.notes.push_back(fmt::format("put {} items of the build together", printed.size()));
  if (assembly.mirrored() > 0) file.notes.push_back(fmt::format("mirrored {} objects", assembly.mirrored()));
  if (supports > 0) file.notes.push_back(fmt::format("left out {} supports that the file brings", supports));
  if (unprinted > 0)
    file.notes.push_back(fmt::format("left out {} items marked as not printable", unprinted));
  if (assembly.has_beams()) file.notes.push_back("left out beam lattices: only meshes are read");
  return file;
}

}  // namespace skinframe
