// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/run/reserve_blas.h"

#include <sys/mman.h>

#include <cstddef>
#include <vector>

// What OpenBLAS' own routines, and LAPACK's over it, get their buffers from; it keeps what is given back.
extern "C" __attribute__((weak)) void* blas_memory_alloc(int);
extern "C" __attribute__((weak)) void blas_memory_free(void*);

namespace skinframe {
namespace {

constexpr std::size_t kBufferBytes = std::size_t{128} << 20;  // of address space; BUFFER_SIZE on x86-64
constexpr std::size_t kToWorkWith = std::size_t{16} << 20;    // to come to say that memory is short

bool there_is_room(std::size_t bytes) {
  void* room = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  return room != MAP_FAILED && ::munmap(room, bytes) == 0;
}

}  // namespace

bool reserve_blas_buffers(int threads) {
  if (blas_memory_alloc == nullptr || blas_memory_free == nullptr) return true;
  const auto count = static_cast<std::size_t>(threads < 1 ? 1 : threads);
  if (!there_is_room(count * kBufferBytes + kToWorkWith)) return false;
  std::vector<void*> buffers(count);
  for (void*& buffer : buffers) buffer = blas_memory_alloc(0);
  for (void* buffer : buffers) blas_memory_free(buffer);
  return true;
}

}  // namespace skinframe
