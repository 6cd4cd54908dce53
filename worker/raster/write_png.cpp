// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/raster/write_png.h"

#include <fmt/format.h>
#include <png.h>

#include <cerrno>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <memory>
#include <system_error>

namespace skinframe {
namespace {

// libpng leaves by longjmp when it fails: nothing with a destructor lives in this function.
bool write_rows(const Image& image, std::FILE* file) {
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
  if (info == nullptr) {
    png_destroy_write_struct(&png, nullptr);
    return false;
  }
  if (setjmp(png_jmpbuf(png)) != 0) {
    png_destroy_write_struct(&png, &info);
    return false;
  }
  png_init_io(png, file);
  png_set_IHDR(png, info, static_cast<png_uint_32>(image.width()), static_cast<png_uint_32>(image.height()),
               8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
  png_set_compression_level(png, 9);
  png_write_info(png, info);
  for (int y = 0; y < image.height(); ++y) png_write_row(png, image.row(y));
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  return true;
}

}  // namespace

Status write_png(const Image& image, const std::filesystem::path& path) {
  const std::filesystem::path beside = path.string() + ".part";
  std::FILE* file = std::fopen(beside.c_str(), "wb");
  if (file == nullptr) return io_error(fmt::format("{}: {}", beside.string(), std::strerror(errno)));
  const bool written = write_rows(image, file);
  std::error_code failure;
  if (std::fclose(file) != 0 || !written) {
    std::filesystem::remove(beside, failure);
    return io_error(fmt::format("{}: cannot be written; is the disk full?", path.string()));
  }
  std::filesystem::rename(beside, path, failure);
  if (failure) return io_error(fmt::format("{}: {}", path.string(), failure.message()));
  return ok_status();
}

}  // namespace skinframe
