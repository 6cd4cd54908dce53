// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "worker/profile/import_profile.h"

namespace skinframe {
namespace {

using nlohmann::json;

constexpr std::size_t kMostBytes = std::size_t{8} << 20;

struct Refusal {
  std::string message;
};

bool is_given(const json& object, const char* key) { return object.contains(key) && !object[key].is_null(); }

std::string text(const json& object, const char* key) {
  if (!is_given(object, key)) return "";
  if (!object[key].is_string()) throw Refusal{fmt::format("{}: is not a text", key)};
  return object[key].get<std::string>().substr(0, 200);
}

std::optional<double> number(const json& object, const char* key, double least, double most) {
  if (!is_given(object, key)) return std::nullopt;
  const double x = object[key].is_number() ? object[key].get<double>() : -1;
  if (!(x >= least && x <= most))
    throw Refusal{fmt::format("{}: is no number within {:g} .. {:g}", key, least, most)};
  return x;
}

std::string label(const json& filament) {
  const json vendor = filament.value("vendor", json());
  const std::string maker = vendor.is_object() ? text(vendor, "name") : "";
  std::string name = text(filament, "name");
  if (name.empty()) name = text(filament, "material");
  return maker.empty() || name.empty() ? maker + name : maker + " " + name;
}

bool is_wanted(const json& filament, const std::string& preset) {
  if (!filament.is_object()) return false;
  const json id = filament.value("id", json());
  return (id.is_number_integer() && id.dump() == preset) || text(filament, "name") == preset ||
         label(filament) == preset;
}

const json& choose(const json& content, const std::string& preset) {
  if (content.is_object()) return content;
  if (!content.is_array() || content.empty()) throw Refusal{"is no filament of Spoolman, nor a list of them"};
  if (preset.empty() && content.size() == 1) return content[0];
  if (preset.empty())
    throw Refusal{
        fmt::format("{} filaments are in it; choose one with --preset, by id or name", content.size())};
  for (const json& filament : content)
    if (is_wanted(filament, preset)) return filament;
  throw Refusal{fmt::format("no filament of id or name \"{}\" is in it", preset)};
}

ProfileDraft draft_of(const json& filament, const std::string& file) {
  if (!filament.is_object()) throw Refusal{"is no filament of Spoolman"};
  ProfileDraft draft = ProfileDraft::material();
  const std::string name = label(filament);
  if (name.empty()) throw Refusal{"name: is missing, and so is material"};
  draft.name(name);
  const auto density = number(filament, "density", 1e-3, 100);
  if (density) draft.set("density_g_cm3", *density, fmt::format("Spoolman filament in {}: density", file));
  const auto price = number(filament, "price", 0, 1e9);
  const auto weight = number(filament, "weight", 1, 1e6);  // g, net, of a full spool
  if (price && weight)
    draft.set("price_per_kg", *price / *weight * 1000,
              fmt::format("Spoolman filament in {}: price {:g} for weight {:g} g", file, *price, *weight));
  else if (price)
    draft.note("price: left out, since the spool's weight is not given");
  return draft;
}

}  // namespace

Result<ProfileDraft> import_spoolman(const std::filesystem::path& file, const std::string& preset) {
  const auto content = read_json_file(file, kMostBytes);
  if (!content) return content.error();
  try {
    return draft_of(choose(*content, preset), file.filename().string());
  } catch (const Refusal& refusal) {
    return invalid_input(fmt::format("{}: {}", file.string(), refusal.message));
  }
}

}  // namespace skinframe
