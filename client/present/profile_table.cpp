// SPDX-License-Identifier: Apache-2.0
#include "client/present/profile_table.h"

#include <fmt/format.h>
#include <google/protobuf/descriptor.h>

#include <algorithm>
#include <vector>

#include "client/present/json.h"
#include "client/present/table.h"
#include "client/present/words.h"

namespace skinframe::client {
namespace {

using google::protobuf::FieldDescriptor;

// The sources of one profile, numbered in the order in which they are asked for.
class Sources {
 public:
  template <class Profile>
  std::string mark(const Profile& profile, const std::string& field) {
    const auto own = profile.sources().find(field);
    return number(own != profile.sources().end() ? own->second : profile.source());
  }
  std::string number(const std::string& text) {
    if (text.empty()) return "";
    const auto at = std::find(texts_.begin(), texts_.end(), text);
    const auto index = at - texts_.begin();
    if (at == texts_.end()) texts_.push_back(text);
    return fmt::format("[{}]", index + 1);
  }
  std::string list() const {
    std::string out = texts_.empty() ? "" : "sources\n";
    for (std::size_t i = 0; i < texts_.size(); ++i)
      out += fmt::format("[{}] {}\n", i + 1, one_line(texts_[i]));
    return out;
  }

 private:
  std::vector<std::string> texts_;
};

// The numbers of a profile, known or not, by their field names.
template <class Profile>
void add_numbers(const Profile& profile, std::vector<Row>& rows, Sources& sources) {
  const auto& reflection = *profile.GetReflection();
  for (int i = 0; i < profile.GetDescriptor()->field_count(); ++i) {
    const FieldDescriptor& field = *profile.GetDescriptor()->field(i);
    if (field.cpp_type() != FieldDescriptor::CPPTYPE_DOUBLE) continue;
    const bool known = reflection.HasField(profile, &field);
    rows.push_back({field.name(), or_dash(known, reflection.GetDouble(profile, &field), "{}"),
                    known ? sources.mark(profile, field.name()) : ""});
  }
}

template <class Profile>
nlohmann::ordered_json fields_with_nulls(const Profile& profile) {
  nlohmann::ordered_json known = to_json(profile), out;
  for (int i = 0; i < profile.GetDescriptor()->field_count(); ++i) {
    const std::string& name = profile.GetDescriptor()->field(i)->name();
    out[name] = known.contains(name) ? std::move(known[name]) : nlohmann::ordered_json(nullptr);
  }
  return out;
}

}  // namespace

std::string printer_list(const v1::ListPrintersResponse& printers) {
  std::vector<Row> rows = {{"printer", "process", "material", "name", "radius mm", "tray mm"}};
  for (const v1::PrinterProfile& p : printers.printers()) {
    rows.push_back({one_line(p.id()), process_word(p.process()),
                    p.default_material_id().empty() ? "-" : one_line(p.default_material_id()),
                    one_line(p.display_name()), or_dash(p.has_min_radius_mm(), p.min_radius_mm(), "{}"),
                    or_dash(p.has_tray_x_mm(), p.tray_x_mm(), "{}") + "x" +
                        or_dash(p.has_tray_y_mm(), p.tray_y_mm(), "{}") + "x" +
                        or_dash(p.has_tray_z_mm(), p.tray_z_mm(), "{}")});
  }
  return table(rows, 4);
}

std::string material_list(const v1::ListMaterialsResponse& materials) {
  std::vector<Row> rows = {{"material", "name", "tensile modulus MPa", "shear modulus MPa",
                            "tensile strength MPa", "shear strength MPa", "slenderness", "density g/cm3",
                            "price/kg"}};
  for (const v1::MaterialProfile& m : materials.materials()) {
    rows.push_back({one_line(m.id()), one_line(m.display_name()),
                    or_dash(m.has_tensile_modulus_mpa(), m.tensile_modulus_mpa(), "{}"),
                    or_dash(m.has_shear_modulus_mpa(), m.shear_modulus_mpa(), "{}"),
                    or_dash(m.has_tensile_strength_mpa(), m.tensile_strength_mpa(), "{}"),
                    or_dash(m.has_shear_strength_mpa(), m.shear_strength_mpa(), "{}"),
                    or_dash(m.has_slenderness(), m.slenderness(), "{}"),
                    or_dash(m.has_density_g_cm3(), m.density_g_cm3(), "{}"),
                    or_dash(m.has_price_per_kg(), m.price_per_kg(), "{:.2f}")});
  }
  return table(rows, 2);
}

std::string profile_sheet(const v1::PrinterProfile& printer) {
  Sources sources;
  std::vector<Row> rows = {
      {"printer", one_line(printer.id()), ""},
      {"name", one_line(printer.display_name()), ""},
      {"process", process_word(printer.process()), ""},
      {"default material",
       printer.default_material_id().empty() ? "-" : one_line(printer.default_material_id()), ""},
      {"layers grow",
       printer.build_direction() == v1::BUILD_DIRECTION_HANGING ? "down, the part hangs" : "up", ""}};
  add_numbers(printer, rows, sources);
  rows.push_back({"drain holes",
                  printer.has_drain_holes()
                      ? fmt::format("{} mm{}, {} at least", printer.drain_holes().diameter_mm(),
                                    printer.drain_holes().has_least_diameter_mm()
                                        ? fmt::format(" (down to {} where there is no room)",
                                                      printer.drain_holes().least_diameter_mm())
                                        : "",
                                    printer.drain_holes().least_count())
                      : "-",
                  printer.has_drain_holes() ? sources.mark(printer, "drain_holes") : ""});
  const auto& curve = printer.printable_length();
  rows.push_back({"printable length",
                  !printer.has_printable_length() ? "-"
                  : curve.is_default()            ? "a default, not measured"
                                                  : "measured",
                  sources.number(curve.source())});
  for (const auto& point : curve.points())
    rows.push_back({fmt::format("  {} degrees from the vertical", point.angle_deg()),
                    point.has_length_mm() ? fmt::format("{} mm", point.length_mm()) : "no limit", ""});
  return table(rows, 3) + sources.list();
}

std::string profile_sheet(const v1::MaterialProfile& material) {
  Sources sources;
  std::vector<Row> rows = {{"material", one_line(material.id()), ""},
                           {"name", one_line(material.display_name()), ""}};
  add_numbers(material, rows, sources);
  return table(rows, 3) + sources.list();
}

nlohmann::ordered_json profile_file(const v1::PrinterProfile& printer) {
  return {{"printer", fields_with_nulls(printer)}};
}
nlohmann::ordered_json profile_file(const v1::MaterialProfile& material) {
  return {{"material", fields_with_nulls(material)}};
}

}  // namespace skinframe::client
