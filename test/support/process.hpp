#pragma once

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "support/command_line.hpp"
#include "support/temporary_file.hpp"

namespace hybrid_sphere::testing {

/// A program that runs beside the test, with its output in files.
class Process {
 public:
  /// @param words    the program and its arguments; a program without a slash is looked for in PATH
  /// @param prepare  called in the new process before the program begins
  explicit Process(
      std::vector<std::string> words, const std::function<void()>& prepare = [] {}) {
    static int count = 0;
    const std::string name = "process_" + std::to_string(count++);
    out_ = std::make_unique<TemporaryFile>(name + "_out");
    err_ = std::make_unique<TemporaryFile>(name + "_err");
    pid_ = fork();
    if (pid_ != 0) return;
    dup2(open("/dev/null", O_RDONLY), STDIN_FILENO);
    dup2(open(out_->path().c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0600), STDOUT_FILENO);
    dup2(open(err_->path().c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0600), STDERR_FILENO);
    for (int file = STDERR_FILENO + 1; file < 20; ++file) close(file);
    prepare();
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    execvp(argv[0], argv.data());
    _exit(127);
  }
  ~Process() {
    if (pid_ > 0) kill(pid_, SIGKILL);
    wait();
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  pid_t pid() const { return pid_; }
  bool has_ended() {
    if (pid_ <= 0) return true;
    if (waitpid(pid_, &status_, WNOHANG) != pid_) return false;
    pid_ = 0;
    return true;
  }
  /// Waits for its end.
  CommandResult wait() {
    if (pid_ > 0) waitpid(pid_, &status_, 0);
    pid_ = 0;
    const int code = WIFEXITED(status_) ? WEXITSTATUS(status_) : 128 + WTERMSIG(status_);
    return {code, out_->text(), err_->text()};
  }

 private:
  std::unique_ptr<TemporaryFile> out_;
  std::unique_ptr<TemporaryFile> err_;
  pid_t pid_ = 0;
  int status_ = 0;
};

}  // namespace hybrid_sphere::testing
