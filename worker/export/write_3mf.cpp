// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/export/write_3mf.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>
#include <zip.h>

#include <cerrno>
#include <cmath>
#include <cstring>

namespace skinframe {
namespace {

constexpr std::size_t kChunkBytes = 1 << 20;
constexpr int kDeflateLevel = 1;         // half the time of the default for a tenth more bytes
constexpr uLong kDosDate = 0x21u << 16;  // 1980-01-01, the zero of the format

constexpr const char* kContentTypes =
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
    "<Types xmlns=\"http://schemas.openxmlformats.org/package/2006/content-types\">"
    "<Default Extension=\"rels\" ContentType=\"application/vnd.openxmlformats-package.relationships+xml\"/>"
    "<Default Extension=\"model\" ContentType=\"application/vnd.ms-package.3dmanufacturing-3dmodel+xml\"/>"
    "</Types>\n";
constexpr const char* kRelationships =
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
    "<Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">"
    "<Relationship Target=\"/3D/3dmodel.model\" Id=\"rel0\" "
    "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>\n";

// A package in the making, under a temporary name until it is whole.
class Package {
 public:
  explicit Package(const std::filesystem::path& path)
      : final_(path), temporary_(path.string() + fmt::format(".{}.part", ::getpid())) {
    zip_ = zipOpen64(temporary_.c_str(), APPEND_STATUS_CREATE);
    failed_ = zip_ == nullptr;
  }
  Package(const Package&) = delete;
  Package& operator=(const Package&) = delete;
  ~Package() {
    if (zip_ != nullptr) zipClose(zip_, nullptr);
    if (!moved_) ::unlink(temporary_.c_str());
  }

  void begin(const char* name) {
    zip_fileinfo info{};
    info.dosDate = kDosDate;
    constexpr int kLargeFile = 1;  // the text of a mesh may pass 4 GB
    failed_ = failed_ || zipOpenNewFileInZip64(zip_, name, &info, nullptr, 0, nullptr, 0, nullptr, Z_DEFLATED,
                                               kDeflateLevel, kLargeFile) != ZIP_OK;
  }
  fmt::memory_buffer& text() {
    if (buffer_.size() >= kChunkBytes) flush();
    return buffer_;
  }
  void end() {
    flush();
    failed_ = failed_ || zipCloseFileInZip(zip_) != ZIP_OK;
  }
  Status finish() {
    if (zip_ != nullptr && zipClose(zip_, nullptr) != ZIP_OK) failed_ = true;
    zip_ = nullptr;
    if (failed_) return io_error(fmt::format("{}: cannot be written; is the disk full?", final_.string()));
    const int descriptor = ::open(temporary_.c_str(), O_RDONLY | O_CLOEXEC);
    const bool synced = descriptor >= 0 && ::fsync(descriptor) == 0;
    if (descriptor >= 0) ::close(descriptor);
    if (!synced || ::rename(temporary_.c_str(), final_.c_str()) != 0)
      return io_error(fmt::format("{}: {}", final_.string(), std::strerror(errno)));
    moved_ = true;
    return ok_status();
  }

 private:
  void flush() {
    if (!failed_ && buffer_.size() > 0)
      failed_ = zipWriteInFileInZip(zip_, buffer_.data(), static_cast<unsigned>(buffer_.size())) != ZIP_OK;
    buffer_.clear();
  }

  std::filesystem::path final_, temporary_;
  zipFile zip_ = nullptr;
  fmt::memory_buffer buffer_;
  bool failed_ = false, moved_ = false;
};

template <class... Values>
void put(Package& package, fmt::format_string<Values...> format, Values&&... values) {
  fmt::format_to(std::back_inserter(package.text()), format, std::forward<Values>(values)...);
}

// For attributes and text: markup escaped, what XML 1.0 does not allow left out. Input is UTF-8.
std::string clean(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    if (byte < 0x20) {
      out += ' ';
    } else if (text.compare(i, 3, "\xEF\xBF\xBE") == 0 || text.compare(i, 3, "\xEF\xBF\xBF") == 0) {
      i += 2;
    } else if (byte == '&') {
      out += "&amp;";
    } else if (byte == '<') {
      out += "&lt;";
    } else if (byte == '>') {
      out += "&gt;";
    } else if (byte == '"') {
      out += "&quot;";
    } else {
      out += text[i];
    }
  }
  return out;
}

void begin_model(Package& package, const ThreemfText& text, const char* attributes) {
  package.begin("[Content_Types].xml");
  put(package, "{}", kContentTypes);
  package.end();
  package.begin("_rels/.rels");
  put(package, "{}", kRelationships);
  package.end();
  package.begin("3D/3dmodel.model");
  put(package,
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model unit=\"millimeter\" xml:lang=\"en-US\" "
      "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\"{}>\n"
      "<metadata name=\"Title\">{}</metadata>\n<metadata name=\"Description\">{}</metadata>\n"
      "<metadata name=\"Application\">skinframe {}</metadata>\n<resources>\n"
      "<object id=\"1\" type=\"model\" name=\"{}\"><mesh><vertices>\n",
      attributes, clean(text.title), clean(text.description), SKINFRAME_VERSION, clean(text.object));
}

void put_vertices(Package& package, const std::vector<Eigen::Vector3d>& vertices) {
  for (const auto& v : vertices)
    put(package, "<vertex x=\"{}\" y=\"{}\" z=\"{}\"/>\n", static_cast<float>(v.x()),
        static_cast<float>(v.y()), static_cast<float>(v.z()));
  put(package, "</vertices>");
}

Status end_model(Package& package) {
  put(package, "</mesh></object>\n</resources>\n<build><item objectid=\"1\"/></build>\n</model>\n");
  package.end();
  return package.finish();
}

Status check_finite(const std::vector<Eigen::Vector3d>& vertices) {
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    if (!vertices[v].cast<float>().allFinite())
      return invalid_input(fmt::format("vertex {}: a coordinate is no finite float", v));
  }
  return ok_status();
}

}  // namespace

Status write_3mf(const TriangleMesh& mesh, const ThreemfText& text, const std::filesystem::path& path) {
  if (auto status = check_finite(mesh.vertices); !status) return status;
  Package package(path);
  begin_model(package, text, "");
  put_vertices(package, mesh.vertices);
  put(package, "<triangles>\n");
  for (const auto& [a, b, c] : mesh.triangles)
    put(package, "<triangle v1=\"{}\" v2=\"{}\" v3=\"{}\"/>\n", a, b, c);
  put(package, "</triangles>");
  return end_model(package);
}

Status write_beams_3mf(const Frame& frame, const std::vector<double>& radii_mm, const ThreemfText& text,
                       const std::filesystem::path& path) {
  SKINFRAME_CHECK(radii_mm.size() == frame.struts.size());
  if (auto status = check_finite(frame.nodes_mm); !status) return status;
  Package package(path);
  begin_model(package, text,
              " xmlns:b=\"http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02\" "
              "requiredextensions=\"b\"");
  put_vertices(package, frame.nodes_mm);
  constexpr double kLeastLengthMm = 1e-4;
  const double usual = radii_mm.empty() ? 1.0 : radii_mm.front();
  put(package,
      "<triangles></triangles><b:beamlattice minlength=\"{}\" radius=\"{}\" cap=\"sphere\"><b:beams>\n",
      kLeastLengthMm, usual);
  for (std::size_t j = 0; j < frame.struts.size(); ++j) {
    const auto& [a, b, is_skin] = frame.struts[j];
    if ((frame.nodes_mm[a] - frame.nodes_mm[b]).norm() < kLeastLengthMm)
      continue;  // a beam may not be shorter
    put(package, "<b:beam v1=\"{}\" v2=\"{}\" r1=\"{}\" r2=\"{}\"/>\n", a, b, radii_mm[j], radii_mm[j]);
  }
  put(package, "</b:beams></b:beamlattice>");
  return end_model(package);
}

}  // namespace skinframe
