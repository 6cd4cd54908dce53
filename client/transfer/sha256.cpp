// SPDX-License-Identifier: Apache-2.0
#include "client/transfer/sha256.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <stdexcept>

namespace skinframe::client {

struct Sha256::State {
  EVP_MD_CTX* context = EVP_MD_CTX_new();
  ~State() { EVP_MD_CTX_free(context); }
};

namespace {

// Fails only without memory or with a broken OpenSSL: nothing that a caller could mend.
void must(bool ok) {
  if (!ok) throw std::runtime_error("OpenSSL cannot compute a SHA-256");
}

}  // namespace

Sha256::Sha256() : state_(std::make_unique<State>()) {
  must(state_->context != nullptr && EVP_DigestInit_ex(state_->context, EVP_sha256(), nullptr) == 1);
}
Sha256::~Sha256() = default;

void Sha256::add(std::string_view bytes) {
  must(EVP_DigestUpdate(state_->context, bytes.data(), bytes.size()) == 1);
}

std::string Sha256::hex() {
  std::array<unsigned char, 32> raw{};
  must(EVP_DigestFinal_ex(state_->context, raw.data(), nullptr) == 1);
  std::string out;
  for (const unsigned char byte : raw) out += fmt::format("{:02x}", byte);
  return out;
}

Result<FileDigest> digest_input_file(const std::filesystem::path& path) {
  const auto unreadable = [&](const std::string& why) {
    return Failure{FailureKind::kInput, fmt::format("{}: {}", path.string(), why)};
  };
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (status.type() == std::filesystem::file_type::not_found) return unreadable("there is no such file");
  if (error) return unreadable("cannot be read: " + error.message());
  if (!std::filesystem::is_regular_file(status))
    return unreadable("is not a file; give a mesh (STL, OBJ, PLY, OFF) or a frame problem (JSON)");
  std::ifstream in(path, std::ios::binary);
  if (!in) return unreadable(fmt::format("cannot be read: {}", std::strerror(errno)));
  Sha256 hash;
  FileDigest out;
  std::string buffer(256 * 1024, '\0');
  while (in) {
    in.read(buffer.data(), static_cast<std::streamsize>(buffer.size()));
    hash.add({buffer.data(), static_cast<std::size_t>(in.gcount())});
    out.size_bytes += in.gcount();
  }
  if (in.bad()) return unreadable("cannot be read to its end");
  if (out.size_bytes == 0)
    return unreadable("is empty; give a mesh (STL, OBJ, PLY, OFF) or a frame problem (JSON)");
  out.sha256 = hash.hex();
  return out;
}

}  // namespace skinframe::client
