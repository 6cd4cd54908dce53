// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>
#include <set>

#include "server/catalog/built_in_profiles.h"
#include "server/catalog/catalog.h"
#include "server/catalog/profile_file.h"

namespace skinframe::server {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostFiles = 1000;

// Profiles by kind and id; a later one takes the place of an earlier one.
class Collection {
 public:
  void put(const ProfileFile& file) {
    if (const auto* printer = std::get_if<v1::PrinterProfile>(&file.profile))
      printers_[printer->id()] = {*printer, file.default_material_place};
    else
      materials_[file.id()] = std::get<v1::MaterialProfile>(file.profile);
  }

  absl::StatusOr<Catalog> catalog() const {
    std::vector<v1::PrinterProfile> printers;
    for (const auto& [id, printer] : printers_) {
      const std::string& material = printer.profile.default_material_id();
      if (!material.empty() && !materials_.contains(material))
        return absl::InvalidArgumentError(
            fmt::format("{}: printer.default_material_id: there is no material \"{}\"; add its file, or null",
                        printer.default_material_place, material));
      printers.push_back(printer.profile);
    }
    std::vector<v1::MaterialProfile> materials;
    for (const auto& [id, material] : materials_) materials.push_back(material);
    return Catalog(std::move(printers), std::move(materials));
  }

 private:
  struct Printer {
    v1::PrinterProfile profile;
    std::string default_material_place;
  };
  std::map<std::string, Printer> printers_;
  std::map<std::string, v1::MaterialProfile> materials_;
};

Collection built_in() {
  Collection all;
  for (const BuiltInProfile& each : built_in_profiles()) {
    const auto parsed = parse_profile(each.text, std::string(each.name));
    if (!parsed.ok()) {  // a defect of this program, which its own tests find
      fmt::print(stderr, "built-in profile {}\n", std::string(parsed.status().message()));
      std::abort();
    }
    all.put(*parsed);
  }
  return all;
}

absl::StatusOr<std::vector<fs::path>> json_files(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> files;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    const fs::path& path = at->path();
    if (path.extension() != ".json" || path.filename().string().starts_with('.')) continue;
    if (files.size() == kMostFiles)
      return absl::InvalidArgumentError(
          fmt::format("{}: more than {} profiles", folder.string(), kMostFiles));
    files.push_back(path);
  }
  if (error) return absl::NotFoundError(fmt::format("profiles {}: {}", folder.string(), error.message()));
  std::sort(files.begin(), files.end());
  return files;
}

absl::StatusOr<std::string> read_bounded(const fs::path& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error))  // a pipe would never end
    return absl::InvalidArgumentError(fmt::format("{}:1: not a regular file", path.string()));
  std::ifstream in(path, std::ios::binary);
  std::string text(kLargestProfileBytes + 1, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (in.bad() || !in.is_open())
    return absl::InvalidArgumentError(fmt::format("{}:1: cannot be read", path.string()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  return text;
}

}  // namespace

Catalog built_in_catalog() { return *built_in().catalog(); }

absl::StatusOr<Catalog> load_catalog(const fs::path& folder) {
  const auto files = json_files(folder);
  if (!files.ok()) return files.status();
  Collection all = built_in();
  std::map<std::pair<std::size_t, std::string>, std::string> seen;  // by kind and id: the file
  for (const fs::path& path : *files) {
    const auto text = read_bounded(path);
    if (!text.ok()) return text.status();
    const auto parsed = parse_profile(*text, path.string());
    if (!parsed.ok()) return parsed.status();
    const auto [before, is_new] = seen.try_emplace({parsed->profile.index(), parsed->id()}, path.string());
    if (!is_new)
      return absl::InvalidArgumentError(
          fmt::format("{}:1: id: \"{}\" is that of {} too", path.string(), parsed->id(), before->second));
    all.put(*parsed);
  }
  return all.catalog();
}

}  // namespace skinframe::server
