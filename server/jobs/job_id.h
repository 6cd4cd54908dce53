// SPDX-License-Identifier: Apache-2.0
// Job ids: 128 random bits as 32 lower-case hexadecimal digits. Nobody can guess another's job, and ids made
// by several servers never meet.
#pragma once

#include <string>
#include <string_view>

namespace skinframe::server {

class IdGenerator {
 public:
  virtual ~IdGenerator() = default;
  virtual std::string next() = 0;  // from any thread
};

// From the operating system's random numbers. Aborts the process when there are none: a predictable id is
// worse.
class RandomIds final : public IdGenerator {
 public:
  std::string next() override;
};

// SHA-256 as 64 lower-case hexadecimal digits.
std::string sha256_hex(std::string_view bytes);

// Lower-case hexadecimal digits of raw bytes.
std::string to_hex(std::string_view bytes);

}  // namespace skinframe::server
