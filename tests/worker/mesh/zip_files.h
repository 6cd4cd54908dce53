// SPDX-License-Identifier: GPL-3.0-or-later
// ZIP archives and 3MF packages made in the test, honest and lying ones: each size, checksum and count in a
// header can be told otherwise.
#pragma once

#include <zlib.h>

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tests/worker/mesh/mesh_files.h"

namespace skinframe::testing {

struct ZipEntry {
  std::string name, content;
  bool deflated = true;
  std::optional<std::uint32_t> announced_size, announced_crc;
  std::uint16_t flags = 0;
  std::optional<std::uint16_t> method;
};

inline std::string deflate_raw(const std::string& content) {
  z_stream stream{};
  deflateInit2(&stream, 9, Z_DEFLATED, -MAX_WBITS, 9, Z_DEFAULT_STRATEGY);
  std::string packed(deflateBound(&stream, content.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(content.data()));
  stream.avail_in = static_cast<uInt>(content.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  deflate(&stream, Z_FINISH);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

inline std::string zip(const std::vector<ZipEntry>& entries,
                       std::optional<std::uint16_t> announced_entries = {}) {
  std::string bytes, directory;
  for (const ZipEntry& entry : entries) {
    const std::string packed = entry.deflated ? deflate_raw(entry.content) : entry.content;
    const auto crc = static_cast<std::uint32_t>(crc32(0, reinterpret_cast<const Bytef*>(entry.content.data()),
                                                      static_cast<uInt>(entry.content.size())));
    const auto offset = static_cast<std::uint32_t>(bytes.size());
    std::string both;  // what local header and directory say alike, from the version needed on
    put(both, std::uint16_t{20});
    put(both, entry.flags);
    put(both, entry.method.value_or(entry.deflated ? 8 : 0));
    put(both, std::uint32_t{0});
    put(both, entry.announced_crc.value_or(crc));
    put(both, static_cast<std::uint32_t>(packed.size()));
    put(both, entry.announced_size.value_or(static_cast<std::uint32_t>(entry.content.size())));
    put(both, static_cast<std::uint16_t>(entry.name.size()));
    put(both, std::uint16_t{0});
    bytes += "PK\x03\x04" + both + entry.name + packed;
    directory += "PK\x01\x02";
    put(directory, std::uint16_t{20});
    directory += both;
    put(directory, std::uint16_t{0});
    put(directory, std::uint16_t{0});
    put(directory, std::uint16_t{0});
    put(directory, std::uint32_t{0});
    put(directory, offset);
    directory += entry.name;
  }
  const auto start = static_cast<std::uint32_t>(bytes.size());
  bytes += directory + "PK\x05\x06";
  put(bytes, std::uint32_t{0});
  const auto count = announced_entries.value_or(static_cast<std::uint16_t>(entries.size()));
  put(bytes, count);
  put(bytes, count);
  put(bytes, static_cast<std::uint32_t>(directory.size()));
  put(bytes, start);
  put(bytes, std::uint16_t{0});
  return bytes;
}

inline ZipEntry relationships(const std::string& target = "/3D/3dmodel.model") {
  return {"_rels/.rels",
          "<?xml version=\"1.0\"?><Relationships "
          "xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\"><Relationship Id=\"r\" "
          "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\" Target=\"" +
              target + "\"/></Relationships>"};
}

inline std::string model_xml(const std::string& resources, const std::string& build,
                             const std::string& attributes = "unit=\"millimeter\"") {
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model " + attributes +
         " xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\"\n"
         " xmlns:p=\"http://schemas.microsoft.com/3dmanufacturing/production/2015/06\"\n"
         " xmlns:b=\"http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02\">\n<resources>" +
         resources + "</resources>\n<build>" + build + "</build></model>";
}

inline std::string tetrahedron_mesh() {
  std::string xml = "<mesh><vertices>";
  for (const auto& p : kCorners) {
    xml += "<vertex x=\"" + number(p.x()) + "\" y=\"" + number(p.y()) + "\" z=\"" + number(p.z()) + "\"/>";
  }
  xml += "</vertices><triangles>";
  for (const auto& f : kFaces) {
    xml += "<triangle v1=\"" + std::to_string(f[0]) + "\" v2=\"" + std::to_string(f[1]) + "\" v3=\"" +
           std::to_string(f[2]) + "\"/>";
  }
  return xml + "</triangles></mesh>";
}

inline std::string object_xml(int id, const std::string& content, const std::string& attributes = "") {
  return "<object id=\"" + std::to_string(id) + "\" " + attributes + ">" + content + "</object>";
}

inline std::string tetrahedron_object(int id) { return object_xml(id, tetrahedron_mesh()); }

inline std::string item_xml(int object, const std::string& attributes = "") {
  return "<item objectid=\"" + std::to_string(object) + "\" " + attributes + "/>";
}

inline std::string component_xml(int object, const std::string& attributes = "") {
  return "<component objectid=\"" + std::to_string(object) + "\" " + attributes + "/>";
}

inline std::string package(const std::string& model, std::vector<ZipEntry> more = {}) {
  std::vector<ZipEntry> entries = {relationships(), {"3D/3dmodel.model", model}};
  entries.insert(entries.end(), more.begin(), more.end());
  return zip(entries);
}

inline std::string threemf() { return package(model_xml(tetrahedron_object(1), item_xml(1))); }

}  // namespace skinframe::testing
