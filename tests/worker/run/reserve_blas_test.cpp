// SPDX-License-Identifier: GPL-3.0-or-later
// A process at its memory limit: in children, since a limit is for good.
#include "worker/run/reserve_blas.h"

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstddef>
#include <functional>

// As OpenBLAS' own routines and LAPACK's get their buffers; null where BLAS is another.
extern "C" __attribute__((weak)) void* blas_memory_alloc(int);

namespace skinframe {
namespace {

constexpr unsigned kSeconds = 20;  // whoever asks for memory for ever is ended by then
constexpr int kCallers = 4;

bool each_caller_has_a_buffer() {
  bool all = true;
  for (int i = 0; i < kCallers; ++i) all = blas_memory_alloc(0) != nullptr && all;
  return all;
}

void limit_address_space(std::size_t bytes) {
  const rlimit limit{bytes, bytes};
  if (::setrlimit(RLIMIT_AS, &limit) != 0) ::_exit(97);
}

int exit_code_of(const std::function<bool()>& holds) {
  const pid_t child = ::fork();
  if (child == 0) {
    ::alarm(kSeconds);
    ::_exit(holds() ? 0 : 1);
  }
  int status = 0;
  EXPECT_EQ(::waitpid(child, &status, 0), child);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

TEST(ReserveBlas, ManyCallersAtATimeHaveTheirBuffersInAProcessThatMayTakeNoMore) {
  if (blas_memory_alloc == nullptr) GTEST_SKIP() << "BLAS is not OpenBLAS";
  EXPECT_EQ(exit_code_of([] {
              if (!reserve_blas_buffers(kCallers)) return false;
              limit_address_space(1);  // what there is stays; nothing comes
              const void* more = ::mmap(nullptr, 4096, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
              return more == MAP_FAILED && each_caller_has_a_buffer();
            }),
            0);
}

TEST(ReserveBlas, SaysNoWhereThereIsNoRoomInsteadOfAskingForEver) {
  if (blas_memory_alloc == nullptr) GTEST_SKIP() << "BLAS is not OpenBLAS";
  EXPECT_EQ(exit_code_of([] {
              limit_address_space(1);
              return !reserve_blas_buffers(1);
            }),
            0);
}

}  // namespace
}  // namespace skinframe
