// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/picture/render.h"

#include <fmt/format.h>

#include <system_error>

#include "worker/mesh/read_mesh.h"
#include "worker/picture/bodies.h"
#include "worker/picture/exported_frame.h"
#include "worker/picture/result_folder.h"
#include "worker/picture/size_curves.h"
#include "worker/raster/write_png.h"

namespace skinframe::picture {
namespace {

namespace fs = std::filesystem;

Result<MeshFile> read_body(const fs::path& path, RunContext& context) {
  auto file = read_mesh(path, ReadLimits{}, context);
  if (!file) return file.error();
  for (const Eigen::Vector3d& v : file->mesh.vertices)
    if (!(v.cwiseAbs().maxCoeff() <= kFurthestMm))
      return invalid_input(
          fmt::format("{}: a vertex lies further out than {:g} mm", path.string(), kFurthestMm));
  return file;
}

// What the file itself says of its colours, as the pipeline writes it: "red is 0.05 mm".
std::string meaning_of_colours(const MeshFile& file) {
  for (const std::string& comment : file.comments)
    if (comment.starts_with("red is ")) return "; " + comment;
  return "";
}

class PrinterPictures {
 public:
  PrinterPictures(const RenderRequest& request, const PrinterFiles& files, RunContext& context)
      : request_(request),
        files_(files),
        context_(context),
        folder_((request.out.empty() ? request.directory : request.out) / files.name) {}

  Status draw(std::vector<fs::path>* written) {
    written_ = written;
    std::error_code error;
    fs::create_directories(folder_, error);
    if (error) return internal_error(fmt::format("{}: {}", folder_.string(), error.message()));
    for (const auto step : {&PrinterPictures::draw_frame, &PrinterPictures::draw_cutaway,
                            &PrinterPictures::draw_deformations, &PrinterPictures::draw_pinch}) {
      if (context_.cancelled()) return cancelled_error();
      if (Status drawn = (this->*step)(); !drawn) return drawn;
    }
    return ok_status();
  }

 private:
  Status keep(const Image& image, const std::string& name) {
    const fs::path path = folder_ / name;
    if (Status written = write_png(image, path); !written) return internal_error(written.error().message);
    written_->push_back(path);
    return ok_status();
  }

  Status draw_frame() {
    if (!files_.frame) return ok_status();
    const auto frame = read_frame(*files_.frame);
    if (!frame) return frame.error();
    const int side = request_.side_px;
    if (Status s = keep(frame_picture(*frame, files_.title, side), "frame.png"); !s) return s;
    if (Status s = keep(curves_picture(frame->stages, StrutSize::kRadius, files_.title, side), "radii.png");
        !s)
      return s;
    return keep(curves_picture(frame->stages, StrutSize::kLength, files_.title, side), "lengths.png");
  }

  Status draw_cutaway() {
    if (!files_.mesh) return ok_status();
    const auto body = read_body(*files_.mesh, context_);
    if (!body) return body.error();
    return keep(cutaway_picture(body->mesh, files_.title, request_.side_px), "cutaway.png");
  }

  Status draw_deformations() {
    for (const Deformation& deformation : files_.deformations) {
      if (context_.cancelled()) return cancelled_error();
      if (Status s = draw_coloured(deformation.path,
                                   "deformation under load case " + deformation.load_case + " (verified)",
                                   "deformation-" + deformation.load_case + ".png");
          !s)
        return s;
    }
    return ok_status();
  }

  Status draw_pinch() {
    if (!files_.pinch) return ok_status();
    return draw_coloured(*files_.pinch, "pinched by two fingers: closing distance (verified)", "pinch.png");
  }

  Status draw_coloured(const fs::path& path, const std::string& below, const std::string& name) {
    const auto body = read_body(path, context_);
    if (!body) return body.error();
    if (body->vertex_colours.size() != body->mesh.vertices.size())
      return invalid_input(
          fmt::format("{}: its vertices have no colours (uchar red, green, blue)", path.string()));
    return keep(coloured_picture(body->mesh, body->vertex_colours, files_.title,
                                 below + meaning_of_colours(*body), request_.side_px),
                name);
  }

  const RenderRequest& request_;
  const PrinterFiles& files_;
  RunContext& context_;
  const fs::path folder_;
  std::vector<fs::path>* written_ = nullptr;
};

}  // namespace

Status RenderRequest::validate() const {
  if (side_px >= kLeastSidePx && side_px <= kMostSidePx) return ok_status();
  return invalid_input(fmt::format("--size: {} px lies outside {}..{}", side_px, kLeastSidePx, kMostSidePx));
}

Result<std::vector<fs::path>> render(const RenderRequest& request, RunContext& context) {
  if (Status valid = request.validate(); !valid) return valid.error();
  const auto printers = find_printers(request.directory, request.printer);
  if (!printers) return printers.error();
  std::vector<fs::path> written;
  for (const PrinterFiles& files : *printers)
    if (Status drawn = PrinterPictures(request, files, context).draw(&written); !drawn) return drawn.error();
  return written;
}

}  // namespace skinframe::picture
