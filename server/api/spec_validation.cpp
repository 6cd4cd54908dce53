// SPDX-License-Identifier: Apache-2.0
#include "server/api/spec_validation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "server/artifacts/artifact_store.h"

namespace skinframe::server {
namespace {

constexpr std::size_t kLargestSpecBytes = 64 * 1024;
constexpr int kMostPrinters = 16;
constexpr int kMostLoads = 64;
constexpr int kMostLabels = 16;
constexpr std::size_t kLongestName = 255;
constexpr std::size_t kLongestJobId = 64;
constexpr double kFarthestPoint_mm = 10'000;
constexpr double kLargestForce_n = 1e6;
constexpr std::int64_t kLongestDeadline_s = 365LL * 24 * 3600;

template <class... Args>
absl::Status invalid(fmt::format_string<Args...> format, Args&&... args) {
  return absl::InvalidArgumentError(fmt::format(format, std::forward<Args>(args)...));
}

bool made_of(std::string_view text, std::string_view extra, bool upper_case) {
  return std::all_of(text.begin(), text.end(), [&](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || (upper_case && c >= 'A' && c <= 'Z') ||
           extra.find(c) != std::string_view::npos;
  });
}

// True also refuses what is not a number.
bool outside(double value, double low, double high) { return !(value >= low && value <= high); }

absl::Status check_input(const v1::JobSpec& spec) {
  switch (spec.input_case()) {
    case v1::JobSpec::kMeshSha256:
      if (!is_sha256(spec.mesh_sha256()))
        return invalid("spec.mesh_sha256 must be 64 lower-case hexadecimal digits");
      break;
    case v1::JobSpec::kFrameProblemSha256:
      if (!is_sha256(spec.frame_problem_sha256()))
        return invalid("spec.frame_problem_sha256 must be 64 lower-case hexadecimal digits");
      break;
    case v1::JobSpec::INPUT_NOT_SET:
      return invalid("spec.mesh_sha256 is missing, and so is spec.frame_problem_sha256");
  }
  if (spec.mesh_name().size() > kLongestName) {
    return invalid("spec.mesh_name has {} bytes, at most {} are allowed", spec.mesh_name().size(),
                   kLongestName);
  }
  return absl::OkStatus();
}

// Whether the profiles say all that a job needs: null in a profile file means "not known".
absl::Status check_known(const v1::PrinterRequest& wanted, const Catalog& catalog) {
  const v1::PrinterProfile& printer = *catalog.find_printer(wanted.printer_id());
  constexpr char kRemedy[] =
      "put a profile of that id with the number and its source into the server's --profiles folder";
  if (const std::string missing = missing_for_a_job(printer); !missing.empty())
    return invalid("printer \"{}\": a job needs {}, which its profile does not know; {}", printer.id(),
                   missing, kRemedy);
  const std::string& id = wanted.material_id().empty() ? printer.default_material_id() : wanted.material_id();
  if (id.empty())
    return invalid("printer \"{}\" has no default material; name one: {}", printer.id(),
                   catalog.material_ids());
  if (const std::string missing = missing_for_a_job(*catalog.find_material(id)); !missing.empty())
    return invalid("material \"{}\": a job needs {}, which its profile does not know; {}", id, missing,
                   kRemedy);
  return absl::OkStatus();
}

absl::Status check_printers(const v1::JobSpec& spec, const Catalog& catalog) {
  if (spec.printers_size() < 1 || spec.printers_size() > kMostPrinters) {
    return invalid("spec.printers has {} entries, must have 1 .. {}; known: {}", spec.printers_size(),
                   kMostPrinters, catalog.printer_ids());
  }
  std::set<std::string> seen;
  for (const v1::PrinterRequest& printer : spec.printers()) {
    if (catalog.find_printer(printer.printer_id()) == nullptr) {
      return invalid("unknown printer \"{}\"; known: {}", printer.printer_id(), catalog.printer_ids());
    }
    if (!printer.material_id().empty() && catalog.find_material(printer.material_id()) == nullptr) {
      return invalid("unknown material \"{}\"; known: {}", printer.material_id(), catalog.material_ids());
    }
    if (!seen.insert(printer.printer_id()).second) {
      return invalid("printer \"{}\" is named twice", printer.printer_id());
    }
    if (auto status = check_known(printer, catalog); !status.ok()) return status;
  }
  return absl::OkStatus();
}

// The problem file carries all that these would say, and what it says would be contradicted in silence.
absl::Status check_frame_problem_stands_alone(const v1::JobSpec& spec) {
  constexpr char kWhy[] = "a frame problem carries its own material, bounds, loads and stages";
  if (spec.printers_size() > 0)
    return invalid("spec.printers names \"{}\", but {}", spec.printers(0).printer_id(), kWhy);
  if (spec.loads_size() > 0) return invalid("spec.loads[0] is there, but {}", kWhy);
  const v1::JobOptions& options = spec.options();
  std::vector<const google::protobuf::FieldDescriptor*> set;
  options.GetReflection()->ListFields(options, &set);
  if (!set.empty()) return invalid("options.{} is there, but {}", set.front()->name(), kWhy);
  if (!spec.warm_start_job_id().empty())
    return invalid("spec.warm_start_job_id is there, but a warm start is of jobs of one mesh");
  return absl::OkStatus();
}

absl::Status check_vector(const std::string& field, const v1::Vec3& vector, double limit,
                          std::string_view unit) {
  if (outside(vector.x(), -limit, limit) || outside(vector.y(), -limit, limit) ||
      outside(vector.z(), -limit, limit)) {
    return invalid("{} is ({}, {}, {}), each component must be within -{} .. {} {}", field, vector.x(),
                   vector.y(), vector.z(), limit, limit, unit);
  }
  return absl::OkStatus();
}

absl::Status check_load(const v1::Load& load, int index) {
  const std::string field = fmt::format("spec.loads[{}]", index);
  if (load.name().empty() || load.name().size() > 32 || !made_of(load.name(), "-", false)) {
    return invalid("{}.name is \"{}\", must be 1 .. 32 of [a-z0-9-]", field, load.name());
  }
  switch (load.where_case()) {
    case v1::Load::kPlace:
      if (load.place() == v1::PLACE_UNSPECIFIED || !v1::Place_IsValid(load.place())) {
        return invalid("{}.place must be top, bottom, left, right, front or back", field);
      }
      break;
    case v1::Load::kPointMm:
      if (auto status = check_vector(field + ".point_mm", load.point_mm(), kFarthestPoint_mm, "mm");
          !status.ok()) {
        return status;
      }
      break;
    case v1::Load::WHERE_NOT_SET:
      return invalid("{} needs a place or a point_mm", field);
  }
  if (!load.has_force_n()) return invalid("{}.force_n is missing", field);
  if (auto status = check_vector(field + ".force_n", load.force_n(), kLargestForce_n, "N"); !status.ok())
    return status;
  if (outside(load.radius_mm(), 0, 1000)) {
    return invalid("{}.radius_mm is {}, must be within 0 .. 1000 (0: the default of 5)", field,
                   load.radius_mm());
  }
  return absl::OkStatus();
}

absl::Status check_loads(const v1::JobSpec& spec) {
  if (spec.loads_size() > kMostLoads) {
    return invalid("spec.loads has {} entries, at most {} are allowed", spec.loads_size(), kMostLoads);
  }
  for (int i = 0; i < spec.loads_size(); ++i) {
    if (auto status = check_load(spec.loads(i), i); !status.ok()) return status;
  }
  return absl::OkStatus();
}

absl::Status check_range(const char* field, bool present, double value, double low, double high) {
  if (!present || !outside(value, low, high)) return absl::OkStatus();
  return invalid("options.{} is {}, must be within {} .. {}", field, value, low, high);
}

absl::Status check_enum(const char* field, bool known, int value, const char* valid) {
  if (known) return absl::OkStatus();
  return invalid("options.{} is {}, must be one of {}", field, value, valid);
}

absl::Status check_options(const v1::JobOptions& o) {
  const absl::Status all[] = {
      check_enum("up", v1::Axis_IsValid(o.up()), o.up(), "x, y, z"),
      check_enum("balance", v1::Balance_IsValid(o.balance()), o.balance(), "auto, require, off"),
      check_enum("smooth", v1::Smooth_IsValid(o.smooth()), o.smooth(), "auto, on, off"),
      check_enum("orient", v1::Orient_IsValid(o.orient()), o.orient(), "keep, best"),
      check_enum("order", v1::StageOrder_IsValid(o.order()), o.order(), "tight, paper"),
      check_enum("verify", v1::Verify_IsValid(o.verify()), o.verify(), "on, off"),
      check_range("size_mm", o.has_size_mm(), o.size_mm(), 1, 2000),
      check_range("skin_nodes", o.has_skin_nodes(), o.skin_nodes(), 12, 20000),
      check_range("internal_nodes", o.has_internal_nodes(), o.internal_nodes(), 0, 20000),
      check_range("voxel_mm", o.has_voxel_mm(), o.voxel_mm(), 0.02, 5),
      check_range("displacement_limit_mm", o.has_displacement_limit_mm(), o.displacement_limit_mm(), 0.001,
                  100),
  };
  for (const absl::Status& status : all) {
    if (!status.ok()) return status;
  }
  return absl::OkStatus();
}

absl::Status check_labels(const v1::JobSpec& spec) {
  if (spec.labels_size() > kMostLabels) {
    return invalid("spec.labels has {} entries, at most {} are allowed", spec.labels_size(), kMostLabels);
  }
  for (const auto& [key, value] : spec.labels()) {
    if (key.empty() || key.size() > 63 || !made_of(key, "._-", false)) {
      return invalid("label key \"{}\" must be 1 .. 63 of [a-z0-9._-]", key);
    }
    if (value.size() > kLongestName) {
      return invalid("the value of label \"{}\" has {} bytes, at most {} are allowed", key, value.size(),
                     kLongestName);
    }
  }
  return absl::OkStatus();
}

absl::Status check_schedule(const v1::JobSpec& spec) {
  if (spec.priority() < -100 || spec.priority() > 100) {
    return invalid("spec.priority is {}, must be within -100 .. 100", spec.priority());
  }
  if (!spec.has_deadline()) return absl::OkStatus();
  const auto& deadline = spec.deadline();
  const bool positive = deadline.seconds() > 0 || (deadline.seconds() == 0 && deadline.nanos() >= 1'000'000);
  if (!positive || deadline.seconds() > kLongestDeadline_s || deadline.nanos() < 0 ||
      deadline.nanos() > 999'999'999) {
    return invalid("spec.deadline must be within 0.001 s .. {} s", kLongestDeadline_s);
  }
  return absl::OkStatus();
}

}  // namespace

absl::Status validate_spec(const v1::JobSpec& spec, const Catalog& catalog) {
  // First: fields that this version does not know are stored with the rest, and have no bound of their own.
  if (const std::size_t bytes = spec.ByteSizeLong(); bytes > kLargestSpecBytes) {
    return invalid("spec has {} bytes, at most {} are allowed", bytes, kLargestSpecBytes);
  }
  if (auto status = check_input(spec); !status.ok()) return status;
  if (spec.has_frame_problem_sha256()) {
    if (auto status = check_frame_problem_stands_alone(spec); !status.ok()) return status;
  } else {
    if (auto status = check_printers(spec, catalog); !status.ok()) return status;
    if (auto status = check_loads(spec); !status.ok()) return status;
    if (auto status = check_options(spec.options()); !status.ok()) return status;
  }
  if (auto status = check_labels(spec); !status.ok()) return status;
  if (auto status = check_schedule(spec); !status.ok()) return status;
  if (spec.warm_start_job_id().size() > kLongestJobId)
    return invalid("spec.warm_start_job_id has {} bytes, at most {} are allowed",
                   spec.warm_start_job_id().size(), kLongestJobId);
  return absl::OkStatus();
}

const std::string& input_sha256(const v1::JobSpec& spec) {
  return spec.has_frame_problem_sha256() ? spec.frame_problem_sha256() : spec.mesh_sha256();
}

const char* input_word(const v1::JobSpec& spec) {
  return spec.has_frame_problem_sha256() ? "frame problem" : "mesh";
}

std::vector<std::string> checks_that_hold(const v1::JobSpec& spec) {
  const char* input = input_word(spec);
  std::vector<std::string> checks = {fmt::format("the {} is uploaded", input)};
  if (!spec.warm_start_job_id().empty())
    checks.push_back(fmt::format("job {} is of the same mesh, succeeded, and its files are there",
                                 spec.warm_start_job_id()));
  for (const v1::PrinterRequest& printer : spec.printers()) {
    checks.push_back(fmt::format("printer {} and its material are known", printer.printer_id()));
  }
  if (spec.loads_size() > 0) checks.push_back(fmt::format("{} load(s) are within range", spec.loads_size()));
  checks.push_back("all options are within range and built in this version");
  return checks;
}

absl::Status validate_request_id(std::string_view request_id) {
  if (request_id.size() <= 64 && made_of(request_id, "._-", true)) return absl::OkStatus();
  return invalid("request_id must be 1 .. 64 of [A-Za-z0-9._-], or empty");
}

}  // namespace skinframe::server
