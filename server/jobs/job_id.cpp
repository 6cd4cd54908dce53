// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/job_id.h"

#include <openssl/evp.h>
#include <openssl/rand.h>

#include <array>
#include <cstdio>
#include <cstdlib>

namespace skinframe::server {
namespace {

[[noreturn]] void die(const char* what) {
  std::fprintf(stderr, "skinframe-server: %s\n", what);
  std::abort();
}

}  // namespace

std::string to_hex(std::string_view bytes) {
  static constexpr char kDigits[] = "0123456789abcdef";
  std::string hex;
  hex.reserve(2 * bytes.size());
  for (const char c : bytes) {
    const auto byte = static_cast<unsigned char>(c);
    hex.push_back(kDigits[byte >> 4]);
    hex.push_back(kDigits[byte & 15]);
  }
  return hex;
}

std::string RandomIds::next() {
  std::array<unsigned char, 16> bits{};
  if (RAND_bytes(bits.data(), static_cast<int>(bits.size())) != 1) die("no random numbers from OpenSSL");
  return to_hex({reinterpret_cast<const char*>(bits.data()), bits.size()});
}

std::string sha256_hex(std::string_view bytes) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int size = 0;
  if (EVP_Digest(bytes.data(), bytes.size(), digest.data(), &size, EVP_sha256(), nullptr) != 1) {
    die("OpenSSL cannot compute a SHA-256");
  }
  return to_hex({reinterpret_cast<const char*>(digest.data()), size});
}

}  // namespace skinframe::server
