// SPDX-License-Identifier: GPL-3.0-or-later
// Any bytes as the model part of an honest 3MF package: what a fuzzer of whole files does not reach, since it
// does not find the checksum.
#include <zlib.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>

#include "worker/mesh/read_mesh.h"

namespace {

template <class Value>
void put(std::string& bytes, Value value) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  bytes.append(raw, sizeof value);
}

class StoredZip {
 public:
  void add(const std::string& name, const std::string& content) {
    std::string head;
    put(head, std::uint16_t{20});
    put(head, std::uint16_t{0});
    put(head, std::uint16_t{0});
    put(head, std::uint32_t{0});
    put(head, static_cast<std::uint32_t>(crc32(0, reinterpret_cast<const Bytef*>(content.data()),
                                               static_cast<uInt>(content.size()))));
    put(head, static_cast<std::uint32_t>(content.size()));
    put(head, static_cast<std::uint32_t>(content.size()));
    put(head, static_cast<std::uint16_t>(name.size()));
    put(head, std::uint16_t{0});
    directory_.append("PK\x01\x02").append("\x14\x00", 2).append(head).append(10, '\0');
    put(directory_, static_cast<std::uint32_t>(bytes_.size()));
    directory_.append(name);
    bytes_.append("PK\x03\x04").append(head).append(name).append(content);
    ++count_;
  }
  std::string finish() {
    const auto start = static_cast<std::uint32_t>(bytes_.size());
    bytes_.append(directory_).append("PK\x05\x06").append(4, '\0');
    put(bytes_, count_);
    put(bytes_, count_);
    put(bytes_, static_cast<std::uint32_t>(directory_.size()));
    put(bytes_, start);
    put(bytes_, std::uint16_t{0});
    return bytes_;
  }

 private:
  std::string bytes_, directory_;
  std::uint16_t count_ = 0;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace skinframe;
  StoredZip zip;
  zip.add(
      "_rels/.rels",
      "<Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\"><Relationship "
      "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\" "
      "Target=\"/m\"/></Relationships>");
  const std::string content(reinterpret_cast<const char*>(data), size);
  zip.add("m", content);
  zip.add("n", content);  // a part for references to other parts
  ReadLimits limits;
  limits.max_vertices = limits.max_triangles = 100'000;
  RunContext context;
  const auto file = read_mesh_bytes(zip.finish(), limits, context);
  if (!file.ok()) {
    SKINFRAME_CHECK(!file.error().message.empty());
    return 0;
  }
  SKINFRAME_CHECK(file->format == "3MF");
  SKINFRAME_CHECK(!file->mesh.triangles.empty() && file->mesh.triangles.size() <= limits.max_triangles);
  for (const auto& v : file->mesh.vertices) SKINFRAME_CHECK(v.allFinite());
  for (const auto& t : file->mesh.triangles) {
    for (const int v : t) SKINFRAME_CHECK(v >= 0 && static_cast<std::size_t>(v) < file->mesh.vertices.size());
  }
  return 0;
}
