// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/mesh/zip_archive.h"

#include <fmt/format.h>
#include <unzip.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <set>
#include <type_traits>

#include "worker/mesh/text_scanner.h"

namespace skinframe {
namespace {

constexpr std::size_t kChunkBytes = std::size_t{1} << 18;
constexpr std::uint64_t kRatioFreeBytes = std::uint64_t{1} << 20;
constexpr std::size_t kLongestName = 512;
constexpr unsigned long kStored = 0, kDeflated = Z_DEFLATED, kEncryptedFlag = 1;

// minizip's window on the bytes: what its functions know as a file.
struct MemoryFile {
  std::string_view bytes;
  std::uint64_t position = 0;
};

MemoryFile* file_of(void* stream) { return static_cast<MemoryFile*>(stream); }

void* open_memory(void* file, const void*, int) { return file; }

uLong read_memory(void*, void* stream, void* buffer, uLong size) {
  MemoryFile& file = *file_of(stream);
  const std::uint64_t left = file.bytes.size() - file.position;
  const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(size, left));
  if (count > 0) std::memcpy(buffer, file.bytes.data() + file.position, count);
  file.position += count;
  return count;
}

uLong refuse_to_write(void*, void*, const void*, uLong) { return 0; }

ZPOS64_T tell_memory(void*, void* stream) { return file_of(stream)->position; }

long seek_memory(void*, void* stream, ZPOS64_T offset, int origin) {
  MemoryFile& file = *file_of(stream);
  const std::uint64_t base = origin == ZLIB_FILEFUNC_SEEK_SET   ? 0
                             : origin == ZLIB_FILEFUNC_SEEK_CUR ? file.position
                                                                : file.bytes.size();
  if (offset > file.bytes.size() - base) return -1;
  file.position = base + offset;
  return 0;
}

int close_memory(void*, void*) { return 0; }
int no_error(void*, void*) { return 0; }

struct Closer {
  void operator()(void* file) const { unzClose(file); }
};
using Reader = std::unique_ptr<std::remove_pointer_t<unzFile>, Closer>;

Reader open_reader(MemoryFile& file) {
  zlib_filefunc64_def functions{open_memory, read_memory,  refuse_to_write, tell_memory,
                                seek_memory, close_memory, no_error,        &file};
  return Reader(unzOpen2_64(nullptr, &functions));
}

std::string comparable(std::string_view name) {
  if (name.starts_with('/')) name.remove_prefix(1);
  std::string lowered(name);
  for (char& c : lowered) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return lowered;
}

Error broken_archive(std::string_view what) {
  return invalid_input(fmt::format("the ZIP archive is broken: {} (truncated; export it again)", what));
}

}  // namespace

Result<ZipArchive> ZipArchive::open(std::string_view bytes, const ZipLimits& limits) {
  MemoryFile file{bytes};
  const Reader reader = open_reader(file);
  if (!reader) return broken_archive("it has no directory at its end");
  unz_global_info64 global{};
  if (unzGetGlobalInfo64(reader.get(), &global) != UNZ_OK)
    return broken_archive("its directory is unreadable");
  if (global.number_entry > limits.max_entries) {
    return invalid_input(fmt::format("the ZIP archive announces {} entries, more than the limit of {}",
                                     global.number_entry, limits.max_entries));
  }
  ZipArchive archive;
  archive.bytes_ = bytes;
  archive.limits_ = limits;
  std::set<std::string> names;
  int step = global.number_entry > 0 ? unzGoToFirstFile(reader.get()) : UNZ_END_OF_LIST_OF_FILE;
  for (; step == UNZ_OK; step = unzGoToNextFile(reader.get())) {
    if (archive.entries_.size() >= limits.max_entries)
      return invalid_input(fmt::format("the ZIP archive has more than {} entries", limits.max_entries));
    char name[kLongestName + 1] = {};
    unz_file_info64 info{};
    if (unzGetCurrentFileInfo64(reader.get(), &info, name, kLongestName, nullptr, 0, nullptr, 0) != UNZ_OK)
      return broken_archive("an entry of its directory is unreadable");
    if (info.size_filename > kLongestName)
      return invalid_input(fmt::format("the ZIP archive has a name of {} bytes", info.size_filename));
    if ((info.flag & kEncryptedFlag) != 0)
      return unsupported(
          fmt::format("the entry {} is encrypted; export without a password", skinframe::quoted(name)));
    unz64_file_pos place{};
    if (unzGetFilePos64(reader.get(), &place) != UNZ_OK)
      return broken_archive("an entry of its directory has no place");
    Entry entry{comparable({name, info.size_filename}), info.compressed_size, info.uncompressed_size,
                place.pos_in_zip_directory, place.num_of_file};
    // Which of two entries of a name is meant differs from reader to reader: a way to show one mesh to one
    // program and another to the next.
    if (!names.insert(entry.name).second)
      return invalid_input(
          fmt::format("the ZIP archive has two entries named {}", skinframe::quoted(entry.name)));
    archive.entries_.push_back(std::move(entry));
  }
  if (step != UNZ_END_OF_LIST_OF_FILE) return broken_archive("its directory ends early");
  return archive;
}

const ZipArchive::Entry* ZipArchive::find(std::string_view name) const {
  const std::string wanted = comparable(name);
  const auto place =
      std::find_if(entries_.begin(), entries_.end(), [&](const Entry& e) { return e.name == wanted; });
  return place == entries_.end() ? nullptr : &*place;
}

bool ZipArchive::contains(std::string_view name) const { return find(name) != nullptr; }

Status ZipArchive::stream(std::string_view name, const std::function<Status(std::string_view)>& take,
                          RunContext& context) {
  const Entry* entry = find(name);
  if (entry == nullptr)
    return invalid_input(fmt::format("the archive has no entry {}", skinframe::quoted(name)));
  const auto broken = [&](std::string_view what) {
    return invalid_input(fmt::format("the entry {} is broken: {} (truncated; export it again)",
                                     skinframe::quoted(name), what));
  };
  MemoryFile file{bytes_};
  const Reader reader = open_reader(file);
  const unz64_file_pos place{entry->place_in_directory, entry->number};
  if (!reader || unzGoToFilePos64(reader.get(), &place) != UNZ_OK) return broken("it has no place");
  unz_file_info64 info{};
  if (unzGetCurrentFileInfo64(reader.get(), &info, nullptr, 0, nullptr, 0, nullptr, 0) != UNZ_OK)
    return broken("its header is unreadable");
  if (info.compression_method != kStored && info.compression_method != kDeflated) {
    return unsupported(fmt::format("the entry {} is packed by method {}; only stored and deflated are read",
                                   skinframe::quoted(name), info.compression_method));
  }
  if (unzOpenCurrentFile(reader.get()) != UNZ_OK) return broken("its two headers do not agree");
  std::vector<char> chunk(kChunkBytes);
  std::uint64_t inflated = 0;
  while (true) {
    if (context.cancelled()) return cancelled_error();
    const int got = unzReadCurrentFile(reader.get(), chunk.data(), static_cast<unsigned>(chunk.size()));
    if (got < 0) return broken(fmt::format("it cannot be inflated beyond byte {}", inflated));
    if (got == 0) break;
    inflated += static_cast<std::uint64_t>(got);
    inflated_bytes_ += static_cast<std::uint64_t>(got);
    if (inflated_bytes_ > limits_.max_inflated_bytes) {
      return invalid_input(
          fmt::format("the archive inflates to more than the limit of {} bytes", limits_.max_inflated_bytes));
    }
    if (inflated > kRatioFreeBytes && inflated / limits_.max_ratio > entry->packed_bytes) {
      return invalid_input(
          fmt::format("the entry {} inflates to more than {} times its {} bytes: no mesh does",
                      skinframe::quoted(name), limits_.max_ratio, entry->packed_bytes));
    }
    if (Status s = take({chunk.data(), static_cast<std::size_t>(got)}); !s.ok()) return s;
  }
  if (inflated != entry->inflated_bytes) {
    return broken(fmt::format("{} bytes are announced and {} are there", entry->inflated_bytes, inflated));
  }
  // minizip compares the checksum here, when all was read.
  if (unzCloseCurrentFile(reader.get()) != UNZ_OK) return broken("its checksum does not agree");
  return ok_status();
}

}  // namespace skinframe
