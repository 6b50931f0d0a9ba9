#include "render/child_process.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

// POSIX leaves the declaration to the program.
// NOLINTNEXTLINE(readability-redundant-declaration,cppcoreguidelines-avoid-non-const-global-variables)
extern char** environ;

namespace sheave::render {
namespace {

void close_if_open(int& descriptor) {
  if (descriptor >= 0) ::close(std::exchange(descriptor, -1));
}

/// Spawn settings that must be destroyed whatever happens.
class SpawnSettings {
 public:
  SpawnSettings(int input, int messages) {
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, messages, STDERR_FILENO);
    posix_spawnattr_init(&attributes);
    // The caller may ignore or block signals; the child starts with the usual ones.
    sigset_t all;
    sigfillset(&all);
    sigset_t none;
    sigemptyset(&none);
    posix_spawnattr_setsigdefault(&attributes, &all);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setpgroup(&attributes, 0);
    posix_spawnattr_setflags(
        &attributes,
        static_cast<short>(POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETPGROUP));
  }
  ~SpawnSettings() {
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
  }
  SpawnSettings(const SpawnSettings&) = delete;
  SpawnSettings& operator=(const SpawnSettings&) = delete;

  posix_spawn_file_actions_t actions{};
  posix_spawnattr_t attributes{};
};

}  // namespace

ChildProcess::ChildProcess(std::string name, int process, int input, int messages)
    : name_(std::move(name)), process_(process), input_(input), messages_(messages) {}

ChildProcess::ChildProcess(ChildProcess&& other) noexcept
    : name_(std::move(other.name_)),
      process_(std::exchange(other.process_, -1)),
      input_(std::exchange(other.input_, -1)),
      messages_(std::exchange(other.messages_, -1)) {}

ChildProcess& ChildProcess::operator=(ChildProcess&& other) noexcept {
  if (this != &other) {
    kill();
    name_ = std::move(other.name_);
    process_ = std::exchange(other.process_, -1);
    input_ = std::exchange(other.input_, -1);
    messages_ = std::exchange(other.messages_, -1);
  }
  return *this;
}

ChildProcess::~ChildProcess() { kill(); }

Result<ChildProcess> ChildProcess::start(const std::vector<std::string>& arguments) {
  const std::string& name = arguments.front();
  // A socket rather than a pipe: MSG_NOSIGNAL turns a broken connection into an error without
  // touching the program's handling of SIGPIPE.
  std::array<int, 2> ends{-1, -1};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    return Error{"", "cannot start '" + name + "': no socket: " + std::strerror(errno)};
  }
  // A file rather than a pipe for its messages: nobody has to empty it while frames are written.
  int messages = ::memfd_create("messages", MFD_CLOEXEC);
  if (messages < 0) {
    const Error error{"", "cannot start '" + name + "': no memory file: " + std::strerror(errno)};
    for (int& end : ends) close_if_open(end);
    return error;
  }
  std::vector<char*> pointers;
  for (const std::string& argument : arguments) {
    // exec promises not to write.
    pointers.push_back(const_cast<char*>(argument.c_str()));  // NOLINT(*-pro-type-const-cast)
  }
  pointers.push_back(nullptr);
  pid_t process = -1;
  int status = 0;
  {
    const SpawnSettings settings(ends[1], messages);
    status = ::posix_spawnp(&process, name.c_str(), &settings.actions, &settings.attributes,
                            pointers.data(), environ);
  }
  close_if_open(ends[1]);
  if (status != 0) {
    close_if_open(ends[0]);
    close_if_open(messages);
    return Error{"", "cannot start the program '" + name + "': " + std::strerror(status)};
  }
  return ChildProcess(name, process, ends[0], messages);
}

Errors ChildProcess::write(std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::send(input_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (count < 0) {
      if (errno == EINTR) continue;
      const std::string reason = std::strerror(errno);
      const std::string said = last_words();
      return {Error{"", "'" + name_ + "' stopped taking input: " + (said.empty() ? reason : said)}};
    }
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
  return {};
}

Errors ChildProcess::finish() {
  if (process_ < 0) return {Error{"", "'" + name_ + "' has already ended"}};
  close_if_open(input_);
  int status = 0;
  while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
  }
  process_ = -1;
  const std::string said = last_words();
  close_files();
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return {};
  std::string how = WIFEXITED(status) ? "ended with status " + std::to_string(WEXITSTATUS(status))
                                      : "was ended by signal " + std::to_string(WTERMSIG(status));
  if (!said.empty()) how += ": " + said;
  return {Error{"", "'" + name_ + "' " + how}};
}

void ChildProcess::kill() {
  if (process_ >= 0) {
    ::kill(process_, SIGKILL);
    while (::waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
    }
    process_ = -1;
  }
  close_files();
}

void ChildProcess::close_files() {
  close_if_open(input_);
  close_if_open(messages_);
}

std::string ChildProcess::last_words() const {
  constexpr off_t most = 600;
  if (messages_ < 0) return {};
  const off_t size = ::lseek(messages_, 0, SEEK_END);
  std::string text(static_cast<std::size_t>(std::clamp<off_t>(size, 0, most)), '\0');
  const ssize_t count =
      ::pread(messages_, text.data(), text.size(), std::max<off_t>(0, size - most));
  text.resize(static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
  while (!text.empty() && (text.back() == '\n' || text.back() == '\r')) text.pop_back();
  return text;
}

}  // namespace sheave::render
