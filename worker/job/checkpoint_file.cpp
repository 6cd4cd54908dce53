// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/job/checkpoint_file.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <system_error>
#include <utility>

#include "worker/run/bytes.h"

namespace skinframe {
namespace {

namespace fs = std::filesystem;

constexpr char kMagic[] = "skinframe checkpoint 1";
constexpr std::size_t kFingerprintBytes = 16;

struct Content {
  std::string magic = kMagic;
  std::string version = SKINFRAME_VERSION;
  std::string job_id;
  std::vector<CheckpointFile::Entry> entries;
};

}  // namespace

template <class Archive>
void pass(Archive& archive, CheckpointFile::Entry& entry) {
  archive(entry.key, entry.stage, entry.bytes);
}

CheckpointFile::CheckpointFile(fs::path work_dir, std::string job_id, EventStream& events,
                               std::chrono::milliseconds least_work)
    : work_dir_(std::move(work_dir)), job_id_(std::move(job_id)), events_(events), least_work_(least_work) {
  read_resume();
}

void CheckpointFile::read_resume() {
  const fs::path path = work_dir_ / "resume";
  std::error_code error;
  const std::uintmax_t size = fs::file_size(path, error);
  if (error) return;  // none
  if (size > kMostCheckpointBytes) return refused("it is too large");
  std::ifstream in(path, std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  const std::string bytes = text.str();
  const std::size_t body = bytes.size() - std::min(bytes.size(), kFingerprintBytes);
  if (bytes.substr(body) != fingerprint(std::string_view(bytes).substr(0, body)))
    return refused("it is damaged");
  Content content;
  ByteReader reader(std::string_view(bytes).substr(0, body));
  reader(content.magic, content.version);
  if (!reader.sound() || content.magic != kMagic) return refused("it is of another format");
  if (content.version != SKINFRAME_VERSION)
    return refused("it is of version " + content.version + ", this is " SKINFRAME_VERSION);
  reader(content.job_id, content.entries);
  if (!reader.complete()) return refused("it is damaged");
  if (content.job_id != job_id_) return refused("it is of another job");
  entries_ = std::move(content.entries);
  for (const Entry& entry : entries_) earlier_[entry.key] = entry.bytes;
}

std::optional<std::string> CheckpointFile::find(const std::string& key) {
  const auto at = earlier_.find(key);
  return at == earlier_.end() ? std::nullopt : std::optional(at->second);
}

void CheckpointFile::keep(const std::string& key, const std::string& stage, std::string bytes) {
  const std::lock_guard lock(mutex_);
  std::erase_if(entries_, [&](const Entry& entry) { return entry.key == key; });
  entries_.push_back({key, stage, std::move(bytes)});
  if (std::chrono::steady_clock::now() - last_ >= least_work_) write(stage);
}

void CheckpointFile::write(const std::string& stage) {
  Content content;
  content.job_id = job_id_;
  content.entries = entries_;
  ByteWriter writer;
  writer(content.magic, content.version, content.job_id, content.entries);
  std::string bytes = writer.take();
  bytes += fingerprint(bytes);
  last_ = std::chrono::steady_clock::now();
  if (bytes.size() > kMostCheckpointBytes) {
    spdlog::warn("job={} a checkpoint of {} bytes is too large and not kept", job_id_, bytes.size());
    return;
  }
  const fs::path temporary = work_dir_ / "checkpoint.tmp";
  std::ofstream out(temporary, std::ios::binary | std::ios::trunc);
  out << bytes;
  out.close();
  std::error_code error;
  if (out) fs::rename(temporary, work_dir_ / "checkpoint", error);
  if (!out || error) {
    spdlog::warn("job={} a checkpoint could not be written", job_id_);  // the job can do without
    return;
  }
  events_.checkpoint(stage);
}

void CheckpointFile::used(const std::string& stage) {
  events_.note("goes on from the checkpoint of an earlier attempt: " + stage + " is done");
}

void CheckpointFile::refused(const std::string& why) {
  spdlog::warn("job={} checkpoint refused: {}", job_id_, why);
  events_.note("the checkpoint of an earlier attempt is not used: " + why + "; starting from the beginning");
}

}  // namespace skinframe
