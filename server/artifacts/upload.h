// SPDX-License-Identifier: Apache-2.0
// One upload: hashes while it writes, and gives the file its name only when size and hash are right and the
// content is durable. When it goes before that, what was written stays for the next one to continue.
#pragma once

#include <openssl/evp.h>

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "absl/status/status.h"
#include "server/artifacts/artifact_store.h"
#include "server/artifacts/file.h"

namespace skinframe::server {

class Upload {
 public:
  ~Upload();
  Upload(const Upload&) = delete;
  Upload& operator=(const Upload&) = delete;

  // INVALID_ARGUMENT: the chunk is over the limit, or goes beyond the size. RESOURCE_EXHAUSTED: no room.
  absl::Status append(std::string_view chunk);

  // DATA_LOSS: the content's hash is another (nothing is kept). INVALID_ARGUMENT: bytes are missing (what
  // came is kept). After OK the artifact is complete and durable.
  absl::Status finish();

 private:
  friend class ArtifactStore;
  Upload(ArtifactStore& store, std::string sha256, std::int64_t size_bytes);
  absl::Status start(std::int64_t offset);
  absl::Status hash_kept_part();
  void discard();

  struct FreeDigest {
    void operator()(EVP_MD_CTX* digest) const { EVP_MD_CTX_free(digest); }
  };

  ArtifactStore& store_;
  const std::string sha256_;
  const std::int64_t size_bytes_;
  std::int64_t written_ = 0;
  File file_;
  std::unique_ptr<EVP_MD_CTX, FreeDigest> digest_;
};

}  // namespace skinframe::server
