// SPDX-License-Identifier: GPL-3.0-or-later
// A ZIP archive in memory, read entry by entry through minizip. Internal to the room.
//
// Guarantees:
//  1. No memory is taken on the word of a header: the directory is walked entry by entry, what is inflated is
//     counted while it streams, and nothing is kept of it.
//  2. An entry that inflates past a limit, to another length than announced, or to another checksum is an
//     error; so the last chunks given to the taker may be of an entry that is then refused.
//  3. Entry names are compared, never opened: no path is read or written.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "worker/run/result.h"
#include "worker/run/run_context.h"

namespace skinframe {

struct ZipLimits {
  std::uint64_t max_entries = 10'000;
  std::uint64_t max_inflated_bytes = std::uint64_t{1} << 31;  // of all that is read from the archive
  // Inflated per packed bytes of one entry; text of a mesh stays below 60, deflate's own limit is 1032.
  // Counts beyond the first MiB only.
  std::uint64_t max_ratio = 200;
};

class ZipArchive {
 public:
  // The bytes must outlive the archive. kInvalidInput: no archive, too many entries, a name twice, an
  // encrypted entry.
  static Result<ZipArchive> open(std::string_view bytes, const ZipLimits& limits);

  // Names as in an OPC package: letters' case does not count, a leading slash is left out.
  bool contains(std::string_view name) const;

  // Gives the entry's inflated bytes in chunks; stops at the first error, the taker's own included.
  Status stream(std::string_view name, const std::function<Status(std::string_view)>& take,
                RunContext& context);

 private:
  struct Entry {
    std::string name;  // as it is compared
    std::uint64_t packed_bytes = 0;
    std::uint64_t inflated_bytes = 0;
    std::uint64_t place_in_directory = 0;
    std::uint64_t number = 0;
  };
  const Entry* find(std::string_view name) const;

  std::string_view bytes_;
  ZipLimits limits_;
  std::vector<Entry> entries_;
  std::uint64_t inflated_bytes_ = 0;  // so far, over all entries
};

}  // namespace skinframe
