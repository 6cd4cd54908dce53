// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/agent/work_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <sys/file.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>

namespace skinframe::agent {
namespace {

namespace fs = std::filesystem;

constexpr char kPrefix[] = "agent-";
constexpr std::size_t kMaxResultFiles = 10'000;

Descriptor lock_folder(const fs::path& folder, int flags) {
  Descriptor lock(::open((folder / "lock").c_str(), flags | O_RDWR | O_CLOEXEC, 0600));
  if (lock.get() >= 0 && ::flock(lock.get(), LOCK_EX | LOCK_NB) != 0) return Descriptor();
  return lock;
}

void remove_stale(const fs::path& root) {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(root, error)) {
    const std::string name = entry.path().filename().string();
    if (name.rfind(kPrefix, 0) != 0 || !entry.is_directory(error)) continue;
    // A folder without a lock file belongs to nobody's start (see create); it is empty and costs nothing.
    const Descriptor lock = lock_folder(entry.path(), 0);
    if (lock.get() < 0) continue;
    fs::remove_all(entry.path(), error);
    spdlog::info("removed {}, left by an agent that was killed", entry.path().string());
  }
}

}  // namespace

Result<AgentFolder> AgentFolder::create(const fs::path& root, const std::string& instance_id) {
  std::error_code error;
  fs::create_directories(root, error);
  if (error) return io_error(fmt::format("{}: cannot be made: {}", root.string(), error.message()));
  // Two agents that start at once: neither may take the other's folder, not locked yet, for a stale one.
  const Descriptor starting(::open(root.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (starting.get() < 0 || ::flock(starting.get(), LOCK_EX) != 0) {
    return io_error(fmt::format("{}: cannot be locked: {}", root.string(), std::strerror(errno)));
  }
  remove_stale(root);
  AgentFolder out;
  out.path_ = root / (kPrefix + instance_id);
  fs::create_directory(out.path_, error);
  if (error) return io_error(fmt::format("{}: cannot be made: {}", out.path_.string(), error.message()));
  fs::permissions(out.path_, fs::perms::owner_all, error);  // meshes are customers' property
  out.lock_ = lock_folder(out.path_, O_CREAT);
  if (out.lock_.get() < 0) {
    return io_error(fmt::format("{}: cannot be locked: {}", out.path_.string(), std::strerror(errno)));
  }
  return out;
}

AgentFolder::~AgentFolder() {
  if (lock_.get() < 0) return;
  std::error_code error;
  fs::remove_all(path_, error);
  if (error) spdlog::warn("{}: cannot be removed: {}", path_.string(), error.message());
}

Result<JobFolder> JobFolder::create(const fs::path& agent_folder, const std::string& job_id,
                                    std::int64_t fencing_token) {
  fs::path path = agent_folder / fmt::format("job-{}", fencing_token);
  std::error_code error;
  fs::create_directory(path, error);
  if (error) return io_error(fmt::format("{}: cannot be made: {}", path.string(), error.message()));
  return JobFolder(std::move(path), job_id);
}

JobFolder::~JobFolder() {
  if (path_.empty()) return;
  std::error_code error;
  fs::remove_all(path_, error);
  if (error) spdlog::warn("job={} {}: cannot be removed: {}", job_id_, path_.string(), error.message());
}

Result<std::vector<fs::path>> list_result_files(const fs::path& out) {
  std::vector<fs::path> files;
  std::error_code error;
  if (!fs::exists(out, error)) return files;
  fs::recursive_directory_iterator it(out, error);
  for (; !error && it != fs::recursive_directory_iterator(); it.increment(error)) {
    const fs::file_status status = it->symlink_status();
    const fs::path relative = it->path().lexically_relative(out);
    if (fs::is_directory(status)) continue;
    if (!fs::is_regular_file(status)) {
      return internal_error(fmt::format("result {}: neither a file nor a folder", relative.string()));
    }
    files.push_back(relative);
    if (files.size() > kMaxResultFiles) return internal_error("the job left more than 10000 result files");
  }
  if (error) return io_error(fmt::format("{}: cannot be listed: {}", out.string(), error.message()));
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace skinframe::agent
