#include "tests/command/piped_process.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <stdexcept>
#include <utility>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

namespace sheave::test {

PipedProcess::PipedProcess(const std::vector<std::string>& arguments)
    : err_(::memfd_create("test", MFD_CLOEXEC)) {
  // A command that has ended must not take the test with it.
  ::signal(SIGPIPE, SIG_IGN);
  std::array<int, 2> in{};
  std::array<int, 2> out{};
  if (err_ < 0 || ::pipe2(in.data(), O_CLOEXEC) != 0 || ::pipe2(out.data(), O_CLOEXEC) != 0) {
    throw std::runtime_error("no pipes");
  }
  std::vector<std::string> words{SHEAVE_COMMAND};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  process_ = ::fork();
  if (process_ < 0) throw std::runtime_error("fork");
  if (process_ == 0) {
    ::dup2(in[0], STDIN_FILENO);
    ::dup2(out[1], STDOUT_FILENO);
    ::dup2(err_, STDERR_FILENO);
    ::signal(SIGPIPE, SIG_DFL);
    ::execv(SHEAVE_COMMAND, pointers.data());
    ::_exit(127);
  }
  ::close(in[0]);
  ::close(out[1]);
  in_ = in[1];
  out_ = out[0];
}

PipedProcess::~PipedProcess() {
  close_input();
  close_output();
  if (process_ > 0) {
    ::kill(process_, SIGKILL);
    ::waitpid(process_, nullptr, 0);
  }
  ::close(err_);
}

bool PipedProcess::write(const std::string& text) const {
  std::size_t done = 0;
  while (done < text.size()) {
    const ssize_t count = ::write(in_, text.data() + done, text.size() - done);
    if (count < 0 && errno != EINTR) return false;
    if (count > 0) done += static_cast<std::size_t>(count);
  }
  return true;
}

std::string PipedProcess::read_line() {
  for (;;) {
    const std::size_t end = buffer_.find('\n');
    if (end != std::string::npos) {
      std::string line = buffer_.substr(0, end);
      buffer_.erase(0, end + 1);
      return line;
    }
    std::array<char, 4096> block{};
    const ssize_t count = ::read(out_, block.data(), block.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return {};
    buffer_.append(block.data(), static_cast<std::size_t>(count));
  }
}

std::string PipedProcess::read_rest() {
  std::array<char, 65536> block{};
  for (;;) {
    const ssize_t count = ::read(out_, block.data(), block.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return std::exchange(buffer_, {});
    buffer_.append(block.data(), static_cast<std::size_t>(count));
  }
}

void PipedProcess::close_input() {
  if (in_ >= 0) ::close(std::exchange(in_, -1));
}

void PipedProcess::close_output() {
  if (out_ >= 0) ::close(std::exchange(out_, -1));
}

void PipedProcess::send(int signal) const { ::kill(process_, signal); }

bool PipedProcess::running() const {
  siginfo_t info{};
  const int result =
      ::waitid(P_PID, static_cast<id_t>(process_), &info, WEXITED | WNOHANG | WNOWAIT);
  return result == 0 && info.si_pid == 0;
}

ProcessResult PipedProcess::wait() {
  ProcessResult result;
  int status = 0;
  while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
  }
  process_ = -1;
  if (WIFEXITED(status)) result.exit_code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) result.signal = WTERMSIG(status);
  result.err.resize(static_cast<std::size_t>(::lseek(err_, 0, SEEK_END)));
  const ssize_t count = ::pread(err_, result.err.data(), result.err.size(), 0);
  result.err.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
  return result;
}

}  // namespace sheave::test
