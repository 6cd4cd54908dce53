// SPDX-License-Identifier: Apache-2.0
#include "tests/integration/process.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <thread>

namespace skinframe::integration {

namespace fs = std::filesystem;

fs::path binary(const std::string& name) { return fs::path(SKINFRAME_BIN_DIR) / name; }

Process::Process(const std::vector<std::string>& command, const fs::path& output,
                 const std::vector<std::string>& environment)
    : output_(output) {
  const std::string out = output.string() + ".out", err = output.string() + ".err";
  std::vector<char*> arguments;
  for (const auto& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  const pid_t parent = getpid();
  pid_ = fork();
  if (pid_ != 0) return;
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(127);
  const int null = open("/dev/null", O_RDONLY);
  const int o = open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600),
            e = open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  if (null < 0 || o < 0 || e < 0) _exit(127);
  dup2(null, 0);
  dup2(o, 1);
  dup2(e, 2);
  for (const auto& entry : environment) putenv(const_cast<char*>(entry.c_str()));
  execv(arguments[0], arguments.data());
  _exit(127);
}

Process::Process(Process&& other) noexcept
    : pid_(other.pid_), exit_code_(other.exit_code_), output_(std::move(other.output_)) {
  other.pid_ = -1;
}

Process::~Process() {
  if (running()) {
    kill(pid_, SIGKILL);
    wait();
  }
}

bool Process::running() {
  if (pid_ <= 0 || exit_code_ >= 0) return false;
  int status = 0;
  if (waitpid(pid_, &status, WNOHANG) != pid_) return true;
  exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return false;
}

void Process::signal(int number) {
  if (running()) kill(pid_, number);
}

int Process::wait(Seconds at_most) {
  eventually([this] { return !running(); }, at_most);
  return exit_code_;
}

std::string Process::out() const { return read_file(output_.string() + ".out"); }
std::string Process::err() const { return read_file(output_.string() + ".err"); }

Ran run(const std::vector<std::string>& command, const fs::path& scratch, Seconds at_most) {
  static std::atomic<int> counter = 0;
  Process process(command, scratch / ("run-" + std::to_string(counter++)));
  const int code = process.wait(at_most);
  return {code, process.out(), process.err()};
}

bool eventually(const std::function<bool()>& condition, Seconds at_most) {
  const auto end = std::chrono::steady_clock::now() + at_most;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    // Other processes have no clock to inject: the one place where a test waits, and never longer than it has
    // to.
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return true;
}

std::string read_file(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

Scratch::Scratch() {
  std::string pattern = (fs::temp_directory_path() / "skinframe-integration-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) std::abort();
  path_ = pattern;
}

Scratch::~Scratch() {
  if (testing::Test::HasFailure()) {
    std::fprintf(stderr, "files of the failed test are kept in %s\n", path_.c_str());
    return;
  }
  std::error_code ignored;  // a killed process may still hold a file; the folder is a temporary one
  fs::remove_all(path_, ignored);
}

}  // namespace skinframe::integration
