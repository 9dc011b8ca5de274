// Calls the built program the way a user does: arguments, folder and environment in; text, exit
// code and files out.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "support/build_folder.hpp"
#include "support/recording_writer.hpp"

namespace stillpoint::testing {

inline std::filesystem::path program_file() { return build_folder() / "bin/stillpoint"; }

inline std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

struct Outcome {
  int exit_code = -1;  ///< -1 when a signal ended the program
  int signal = 0;
  std::string out;
  std::string err;
};

struct Surroundings {
  std::filesystem::path folder = std::filesystem::temp_directory_path();
  std::filesystem::path program = program_file();
  std::map<std::string, std::string> environment = {};  ///< besides that of the test
};

/// One call of the program. Standard error comes through a pipe, so that a test can wait for a line
/// of it; standard output goes to a file. A program that hangs is killed, and the test fails.
class Program {
 public:
  explicit Program(std::vector<std::string> arguments, const Surroundings& surroundings = {}) {
    std::array<int, 2> pipe{};
    if (::pipe2(pipe.data(), O_CLOEXEC) != 0) fail("no pipe", errno);
    err_ = pipe[0];
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, out_file().c_str(),
                                     O_WRONLY | O_CREAT | O_TRUNC, 0600);
    posix_spawn_file_actions_adddup2(&actions, pipe[1], STDERR_FILENO);
    posix_spawn_file_actions_addchdir_np(&actions, surroundings.folder.c_str());
    arguments.insert(arguments.begin(), surroundings.program.string());
    std::vector<std::string> variables = environment_with(surroundings.environment);
    // As in a terminal: what a shell puts into the background ignores SIGINT, and so its children.
    sigset_t interrupt;
    sigemptyset(&interrupt);
    sigaddset(&interrupt, SIGINT);
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setsigdefault(&attributes, &interrupt);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);
    const int error = ::posix_spawn(&process_, surroundings.program.c_str(), &actions, &attributes,
                                    pointers(arguments).data(), pointers(variables).data());
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    ::close(pipe[1]);
    if (error != 0) fail("cannot start " + surroundings.program.string(), error);
    ended_ = static_cast<int>(::syscall(SYS_pidfd_open, process_, 0));
    if (ended_ < 0) fail("no descriptor of the process", errno);
  }
  ~Program() {
    if (process_ > 0) finish();
    if (err_ >= 0) ::close(err_);
    ::close(ended_);
  }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  /// False when the program ended without having written `text` to standard error.
  bool wait_for(const std::string& text) {
    while (outcome_.err.find(text) == std::string::npos)
      if (!read_more()) return false;
    return true;
  }
  /// The whole line of standard error that holds `text`; empty when the program ended without it.
  std::string wait_for_line(const std::string& text) {
    std::size_t at = std::string::npos, end = std::string::npos;
    while (end == std::string::npos) {
      at = outcome_.err.find(text);
      if (at != std::string::npos) end = outcome_.err.find('\n', at);
      if (end == std::string::npos && !read_more()) return {};
    }
    const std::size_t begin = outcome_.err.rfind('\n', at) + 1;  // npos + 1 is 0
    return outcome_.err.substr(begin, end - begin);
  }
  /// False when the program ended without having written `text` to `file`.
  bool wait_for_text(const std::filesystem::path& file, const std::string& text) {
    while (text_of(file).find(text) == std::string::npos) {
      if (is_ready(ended_, std::chrono::milliseconds(20)) || is_late()) return false;
    }
    return true;
  }
  void send(int signal) const { ::kill(process_, signal); }
  /// Nobody listens to standard error any more.
  void stop_reading() {
    ::close(err_);
    err_ = -1;
  }

  /// Waits for the end.
  Outcome finish() {
    while (read_more()) {
    }
    while (!is_ready(ended_, std::chrono::seconds(1)) && !is_late()) {
    }
    int status = 0;
    while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
    }
    process_ = -1;
    if (WIFEXITED(status)) outcome_.exit_code = WEXITSTATUS(status);
    if (WIFSIGNALED(status)) outcome_.signal = WTERMSIG(status);
    outcome_.out = text_of(out_file());
    // Their exit codes can be taken for those of the program.
    for (const char* report : {"Sanitizer", "runtime error:"})
      EXPECT_EQ(outcome_.err.find(report), std::string::npos) << outcome_.err;
    return outcome_;
  }

 private:
  [[noreturn]] static void fail(const std::string& what, int error) {
    throw std::runtime_error(what + ": " + std::strerror(error));
  }
  static std::vector<std::string> environment_with(const std::map<std::string, std::string>& more) {
    std::vector<std::string> variables;
    for (char** variable = environ; *variable; ++variable) {
      const std::string text = *variable;
      if (!more.contains(text.substr(0, text.find('=')))) variables.push_back(text);
    }
    for (const auto& [name, value] : more) variables.push_back(name + "=" + value);
    return variables;
  }
  static std::vector<char*> pointers(std::vector<std::string>& texts) {
    std::vector<char*> result;
    for (std::string& text : texts) result.push_back(text.data());
    result.push_back(nullptr);
    return result;
  }
  std::filesystem::path out_file() const { return output_.path() / "stdout"; }

  static bool is_ready(int descriptor, std::chrono::milliseconds patience) {
    pollfd wanted{.fd = descriptor, .events = POLLIN, .revents = 0};
    return ::poll(&wanted, 1, static_cast<int>(patience.count())) > 0;
  }
  /// True when the program has had its time, and is killed.
  bool is_late() {
    if (std::chrono::steady_clock::now() < deadline_) return false;
    if (::kill(process_, SIGKILL) == 0) ADD_FAILURE() << "killed: it hung\n" << outcome_.err;
    return true;
  }

  // False at the end of standard error.
  bool read_more() {
    if (err_ < 0) return false;
    while (!is_ready(err_, std::chrono::seconds(1)))
      if (is_late()) return false;
    std::array<char, 4096> bytes{};
    const ssize_t count = ::read(err_, bytes.data(), bytes.size());
    if (count > 0) outcome_.err.append(bytes.data(), static_cast<std::size_t>(count));
    return count > 0 || (count < 0 && errno == EINTR);
  }

  TemporaryFolder output_;
  pid_t process_ = -1;
  int err_ = -1;
  int ended_ = -1;  // a pidfd, ready when the process has ended
  const std::chrono::steady_clock::time_point deadline_ =
      std::chrono::steady_clock::now() + std::chrono::minutes(10);
  Outcome outcome_;
};

inline Outcome call(std::vector<std::string> arguments, const Surroundings& surroundings = {}) {
  return Program(std::move(arguments), surroundings).finish();
}

}  // namespace stillpoint::testing
