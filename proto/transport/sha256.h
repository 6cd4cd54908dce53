// SPDX-License-Identifier: Apache-2.0
// The name of an artifact: SHA-256 of its content, 64 lower-case hexadecimal digits.
#pragma once

#include <cstdint>
#include <istream>
#include <memory>
#include <string>
#include <string_view>

namespace skinframe::transport {

// Throws std::runtime_error without memory or with a broken OpenSSL: nothing that a caller could mend.
class Sha256 {
 public:
  Sha256();
  ~Sha256();
  void add(std::string_view bytes);
  std::string hex();  // once, at the end

 private:
  struct State;
  std::unique_ptr<State> state_;
};

struct FileDigest {
  std::string sha256;
  std::int64_t size_bytes = 0;
};

// From where the stream stands to its end; in.bad() when that was not reached.
FileDigest digest_of(std::istream& in);

}  // namespace skinframe::transport
