// SPDX-License-Identifier: Apache-2.0
#include "tests/server/app/server_process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <iterator>
#include <utility>

extern char** environ;

namespace skinframe::server {
namespace {

pid_t spawn(std::vector<std::string> arguments, const std::filesystem::path& log) {
  arguments.insert(arguments.begin(), SKINFRAME_SERVER_BINARY);
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600);
  pid_t pid = -1;
  const int error = posix_spawn(&pid, SKINFRAME_SERVER_BINARY, &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  return error == 0 ? pid : -1;
}

int wait_for(pid_t pid) {
  int status = 0;
  while (waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

std::string read_all(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

ServerProcess::~ServerProcess() {
  if (pid_ > 0) stop(SIGKILL);
}

std::string ServerProcess::start(const std::vector<std::string>& extra_arguments) {
  const auto port_file = folder_ / "port";
  std::filesystem::remove(port_file);
  std::vector<std::string> arguments = {"--data",      (folder_ / "data").string(), "--listen", "127.0.0.1:0",
                                        "--port-file", port_file.string()};
  arguments.insert(arguments.end(), extra_arguments.begin(), extra_arguments.end());
  pid_ = spawn(arguments, folder_ / "log");
  if (pid_ < 0) return {};
  const auto give_up = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  while (std::chrono::steady_clock::now() < give_up) {
    if (std::string address = read_all(port_file); !address.empty()) {
      address.pop_back();  // the end of the line
      return address;
    }
    int status = 0;
    if (waitpid(pid_, &status, WNOHANG) == pid_) {
      pid_ = -1;
      return {};
    }
    ::poll(nullptr, 0, 10);  // between two looks
  }
  return {};
}

int ServerProcess::stop(int signal) {
  ::kill(pid_, signal);
  return wait_for(std::exchange(pid_, -1));
}

std::pair<int, std::string> ServerProcess::run(const std::vector<std::string>& arguments,
                                               const std::filesystem::path& folder) {
  const auto log = folder / "run-log";
  std::filesystem::remove(log);
  const pid_t pid = spawn(arguments, log);
  if (pid < 0) return {-1, "cannot start the server"};
  const int code = wait_for(pid);
  return {code, read_all(log)};
}

}  // namespace skinframe::server
