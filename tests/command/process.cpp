#include "tests/command/process.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace sheave::test {
namespace {

[[noreturn]] void fail(const char* what) { throw std::runtime_error(what); }

/// A file without a name.
int scratch_file(const std::string& content = {}) {
  const int file = ::memfd_create("test", MFD_CLOEXEC);
  if (file < 0) fail("memfd_create");
  if (::write(file, content.data(), content.size()) != static_cast<ssize_t>(content.size())) {
    fail("write");
  }
  ::lseek(file, 0, SEEK_SET);
  return file;
}

std::string content_of(int file) {
  std::string text(static_cast<std::size_t>(::lseek(file, 0, SEEK_END)), '\0');
  if (::pread(file, text.data(), text.size(), 0) != static_cast<ssize_t>(text.size())) {
    fail("pread");
  }
  return text;
}

int output_file(const ProcessOptions& options) {
  if (options.closed_stdout) {
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) fail("pipe");
    ::close(ends[0]);
    return ends[1];
  }
  if (!options.stdout_path.empty()) {
    const int file = ::open(options.stdout_path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
    if (file < 0) fail("open");
    return file;
  }
  return scratch_file();
}

}  // namespace

Process::Process(const std::vector<std::string>& arguments, const ProcessOptions& options)
    : out_(output_file(options)) {
  const int in = scratch_file(options.input);
  if (options.terminal_stderr) {
    terminal_ = ::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
    if (terminal_ < 0 || ::grantpt(terminal_) != 0 || ::unlockpt(terminal_) != 0) fail("pty");
    err_ = ::open(::ptsname(terminal_), O_RDWR | O_NOCTTY | O_CLOEXEC);
  } else {
    err_ = scratch_file();
  }
  std::vector<std::string> words{SHEAVE_COMMAND};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  process_ = ::fork();
  if (process_ < 0) fail("fork");
  if (process_ == 0) {
    ::dup2(in, STDIN_FILENO);
    ::dup2(out_, STDOUT_FILENO);
    ::dup2(err_, STDERR_FILENO);
    ::signal(SIGPIPE, SIG_DFL);
    for (const std::string& variable : options.environment) {
      ::putenv(const_cast<char*>(variable.c_str()));  // NOLINT(*-const-cast): exec follows
    }
    const auto limit = [](auto resource, std::int64_t bytes) {
      if (bytes < 0) return;
      const rlimit both{static_cast<rlim_t>(bytes), static_cast<rlim_t>(bytes)};
      ::setrlimit(resource, &both);
    };
    limit(RLIMIT_FSIZE, options.file_size_limit);
    limit(RLIMIT_STACK, options.stack_limit);
    ::execv(SHEAVE_COMMAND, pointers.data());
    ::_exit(127);
  }
  ::close(in);
}

Process::~Process() {
  if (process_ > 0) {
    ::kill(process_, SIGKILL);
    ::waitpid(process_, nullptr, 0);
  }
  for (const int file : {out_, err_, terminal_}) {
    if (file >= 0) ::close(file);
  }
}

void Process::send(int signal) const { ::kill(process_, signal); }

bool Process::running() const {
  siginfo_t info{};
  // Leaves the process to be waited for.
  const int result =
      ::waitid(P_PID, static_cast<id_t>(process_), &info, WEXITED | WNOHANG | WNOWAIT);
  return result == 0 && info.si_pid == 0;
}

bool Process::wait_until(const std::function<bool()>& condition) const {
  while (!condition()) {
    if (!running()) return condition();
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return true;
}

bool Process::read_terminal() {
  std::array<char, 4096> block{};
  for (;;) {
    const ssize_t count = ::read(terminal_, block.data(), block.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    shown_.append(block.data(), static_cast<std::size_t>(count));
    return true;
  }
}

bool Process::wait_for_terminal(const std::string& text) {
  // With our end of the other side closed, reading ends when the child does.
  ::close(std::exchange(err_, -1));
  while (shown_.find(text) == std::string::npos) {
    if (!read_terminal()) return false;
  }
  return true;
}

void Process::drain_terminal() {
  if (err_ >= 0) ::close(std::exchange(err_, -1));
  while (read_terminal()) {
  }
}

ProcessResult Process::wait() {
  ProcessResult result;
  if (terminal_ >= 0) drain_terminal();
  int status = 0;
  while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
  }
  process_ = -1;
  if (WIFEXITED(status)) result.exit_code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) result.signal = WTERMSIG(status);
  if (::lseek(out_, 0, SEEK_CUR) >= 0 && (::fcntl(out_, F_GETFL) & O_ACCMODE) == O_RDWR) {
    result.out = content_of(out_);
  }
  result.err = terminal_ < 0 ? content_of(err_) : shown_;
  return result;
}

ProcessResult run_sheave(const std::vector<std::string>& arguments, const ProcessOptions& options) {
  return Process(arguments, options).wait();
}

TemporaryFolder::TemporaryFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "sheave-test.XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) fail("mkdtemp");
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code code;
  std::filesystem::permissions(path_, std::filesystem::perms::owner_all, code);
  std::filesystem::remove_all(path_, code);
}

std::string TemporaryFolder::write(const std::string& name, const std::string& content) const {
  std::ofstream(path_ / name, std::ios::binary) << content;
  return path(name);
}

std::vector<std::string> TemporaryFolder::entries() const {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(path_)) {
    names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::string read_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  while (begin < text.size()) {
    const std::size_t end = std::min(text.find(separator, begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

}  // namespace sheave::test
