// SPDX-License-Identifier: Apache-2.0
#include "proto/transport/upload_stream.h"

#include <string>

namespace skinframe::transport {
namespace {

constexpr std::size_t kChunkBytes = 256 * 1024;

}  // namespace

grpc::Status send_rest(v1::ArtifactService::StubInterface& stub, grpc::ClientContext& context,
                       const FileDigest& file, std::int64_t offset, std::istream& in) {
  v1::UploadArtifactResponse response;
  const auto writer = stub.Upload(&context, &response);
  v1::UploadArtifactRequest part;
  part.mutable_header()->set_sha256(file.sha256);
  part.mutable_header()->set_size_bytes(file.size_bytes);
  part.mutable_header()->set_offset(offset);
  std::string buffer(kChunkBytes, '\0');
  for (bool open = writer->Write(part); open && in;) {
    in.read(buffer.data(), static_cast<std::streamsize>(buffer.size()));
    if (in.gcount() == 0) break;
    part.set_chunk(buffer.data(), static_cast<std::size_t>(in.gcount()));
    open = writer->Write(part);
  }
  writer->WritesDone();
  return writer->Finish();
}

}  // namespace skinframe::transport
