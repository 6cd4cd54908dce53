// SPDX-License-Identifier: Apache-2.0
#include "server/api/spec_digest.h"

#include <google/protobuf/io/coded_stream.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>

#include "server/jobs/job_id.h"
#include "skinframe/v1/worker.pb.h"

namespace skinframe::server {
namespace {

// Maps in the order of their keys.
std::string canonical_bytes(const google::protobuf::Message& message) {
  std::string bytes;
  {
    google::protobuf::io::StringOutputStream stream(&bytes);
    google::protobuf::io::CodedOutputStream coded(&stream);
    coded.SetSerializationDeterministic(true);
    message.SerializeToCodedStream(&coded);
  }
  return bytes;
}

}  // namespace

std::string digest_of(const v1::JobSpec& spec) { return sha256_hex(canonical_bytes(spec)); }

std::string reuse_key_of(const JobRecord& record) {
  v1::Assignment asked;
  *asked.mutable_spec() = record.job.spec();
  asked.mutable_spec()->clear_mesh_name();
  asked.mutable_spec()->clear_labels();
  asked.mutable_spec()->clear_priority();
  asked.mutable_spec()->clear_deadline();
  // An absent material is the printer's default: what counts is the profile that was chosen.
  for (auto& printer : *asked.mutable_spec()->mutable_printers()) printer.clear_material_id();
  for (const auto& printer : record.printers) *asked.add_printers() = printer;
  for (const auto& material : record.materials) *asked.add_materials() = material;
  for (const auto& file : record.warm_start_files) *asked.add_warm_start_files() = file;
  return sha256_hex(std::string(SKINFRAME_VERSION) + "\n" + canonical_bytes(asked));
}

}  // namespace skinframe::server
