// SPDX-License-Identifier: Apache-2.0
#include "client/cli/sibling.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

namespace skinframe::client {
namespace {

Result<std::filesystem::path> runnable(const std::filesystem::path& path, const char* remedy) {
  if (::access(path.c_str(), X_OK) == 0) return path;
  return Failure{FailureKind::kLocal, fmt::format("{}: there is no such program to run ({}); {}",
                                                  path.string(), std::strerror(errno), remedy)};
}

std::filesystem::path beside_us(const char* name) {
  std::error_code error;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", error);
  return self.parent_path() / name;
}

}  // namespace

Result<std::filesystem::path> worker_program() {
  const char* named = std::getenv("SKINFRAME_WORKER");
  if (named != nullptr && *named != '\0')
    return runnable(named, "SKINFRAME_WORKER must name skinframe-worker");
  return runnable(beside_us("skinframe-worker"),
                  "install skinframe-worker there, or name it with SKINFRAME_WORKER");
}

Result<std::filesystem::path> server_program() {
  return runnable(beside_us("skinframe-server"), "install skinframe-server there");
}

Failure become_worker(const std::vector<std::string>& words) {
  const auto program = worker_program();
  if (!program) return program.failure();
  std::vector<char*> arguments = {const_cast<char*>(program->c_str())};
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  ::execv(program->c_str(), arguments.data());
  return {FailureKind::kLocal, fmt::format("{}: cannot be run: {}", program->string(), std::strerror(errno))};
}

}  // namespace skinframe::client
