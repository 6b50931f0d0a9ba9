#include "render/child_process.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

// POSIX leaves the declaration of `environ` to the program.
// NOLINTNEXTLINE(readability-redundant-declaration,cppcoreguidelines-avoid-non-const-global-variables)
extern char** environ;

namespace sheave::render {
namespace {

void close_if_open(int& descriptor) {
  if (descriptor >= 0) ::close(std::exchange(descriptor, -1));
}

/// Settings of a spawn; POSIX demands that they are destroyed on every path.
class SpawnSettings {
 public:
  SpawnSettings(int input, int output, int messages) {
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
    if (output >= 0) {
      posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
    } else {
      posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    }
    posix_spawn_file_actions_adddup2(&actions, messages, STDERR_FILENO);
    posix_spawnattr_init(&attributes);
    // The calling program may ignore or block signals; the child starts with the default settings.
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

/// The environment of this process without the variables whose names begin with one of
/// `beginnings`, for exec.
std::vector<char*> environment_without(const std::vector<std::string>& beginnings) {
  std::vector<char*> variables;
  for (char** variable = environ; *variable != nullptr; ++variable) {
    const std::string_view text(*variable);
    const bool hidden =
        std::any_of(beginnings.begin(), beginnings.end(),
                    [&](const std::string& beginning) { return text.starts_with(beginning); });
    if (!hidden) variables.push_back(*variable);
  }
  variables.push_back(nullptr);
  return variables;
}

/// Processor time in user mode and in the kernel that a process has used, in clock ticks; -1 if the
/// system does not tell.
long used_time(int process) {
  std::ifstream file("/proc/" + std::to_string(process) + "/stat");
  const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  // The name, in brackets, may contain any character; the state is the first word after it, utime
  // the 12th.
  std::istringstream words(text.substr(std::min(text.rfind(')'), text.size() - 1) + 1));
  std::string skipped;
  for (int i = 0; i < 11; ++i) words >> skipped;
  long user = 0;
  long system = 0;
  return words >> user >> system ? user + system : -1;
}

/// Watches whether a child makes progress while this process waits for it.
class Watch {
 public:
  Watch(int process, const ChildOptions& options) : process_(process), options_(options) {}
  /// To be called repeatedly; true once the child has used no processor time for as long as the
  /// options allow.
  [[nodiscard]] bool hangs() {
    const long used = used_time(process_);
    if (used != used_) {
      used_ = used;
      since_ = Clock::now();
    }
    const bool hurried = options_.hurry && options_.hurry();
    const double most = hurried ? std::min(options_.stall_seconds, options_.hurried_stall_seconds)
                                : options_.stall_seconds;
    return std::chrono::duration<double>(Clock::now() - since_).count() > most;
  }

 private:
  using Clock = std::chrono::steady_clock;
  int process_;
  const ChildOptions& options_;
  long used_ = -2;
  Clock::time_point since_ = Clock::now();
};

constexpr int longest_poll_ms = 100;
constexpr int first_poll_ms = 1;

/// No message of a program that ends by itself is as long.
constexpr std::size_t most_messages = std::size_t{1} << 24U;

std::size_t file_size_of(int file) {
  // A seek would move the place at which the child writes.
  struct stat status {};
  return file >= 0 && ::fstat(file, &status) == 0 ? static_cast<std::size_t>(status.st_size) : 0;
}

/// How a child has ended by a signal. A child inherits the limit of the file size (`ulimit -f`).
std::string signal_text(int signal) {
  std::string text = "was ended by signal " + std::to_string(signal);
  if (signal == SIGXFSZ) return text + ": File too large; `ulimit -f` limits the size of files";
  const char* const name = ::sigdescr_np(signal);
  return name != nullptr ? text + " (" + name + ")" : text;
}

constexpr const char* endless = "writes without end, and was ended";
constexpr const char* hung = "hangs: it has done nothing for a while, and was ended";
constexpr const char* abandoned = "was ended before it was done, as was asked for";

}  // namespace

ChildProcess::ChildProcess(std::string name, ChildOptions options, int process, int input,
                           int output, int messages)
    : name_(std::move(name)),
      options_(std::move(options)),
      process_(process),
      input_(input),
      output_(output),
      messages_(messages) {}

ChildProcess::ChildProcess(ChildProcess&& other) noexcept
    : name_(std::move(other.name_)),
      options_(std::move(other.options_)),
      process_(std::exchange(other.process_, -1)),
      input_(std::exchange(other.input_, -1)),
      output_(std::exchange(other.output_, -1)),
      messages_(std::exchange(other.messages_, -1)) {}

ChildProcess& ChildProcess::operator=(ChildProcess&& other) noexcept {
  if (this != &other) {
    kill();
    close_if_open(output_);
    close_if_open(messages_);
    name_ = std::move(other.name_);
    options_ = std::move(other.options_);
    process_ = std::exchange(other.process_, -1);
    input_ = std::exchange(other.input_, -1);
    output_ = std::exchange(other.output_, -1);
    messages_ = std::exchange(other.messages_, -1);
  }
  return *this;
}

ChildProcess::~ChildProcess() {
  kill();
  close_if_open(output_);
  close_if_open(messages_);
}

Result<ChildProcess> ChildProcess::start(const std::vector<std::string>& arguments,
                                         ChildOptions options) {
  const std::string& name = arguments.front();
  // A socket rather than a pipe: MSG_NOSIGNAL turns a broken connection into an error without
  // touching the program's handling of SIGPIPE.
  std::array<int, 2> ends{-1, -1};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    return Error{"", "cannot start '" + name + "': no socket: " + std::strerror(errno)};
  }
  // From here on the destructor of `child` closes every open descriptor on every path.
  ChildProcess child(name, std::move(options), -1, ends[0], -1, -1);
  // Files rather than pipes: a full pipe would block the child, and nobody empties pipes while the
  // child is fed.
  child.messages_ = ::memfd_create("messages", MFD_CLOEXEC);
  if (child.options_.keeps_output) child.output_ = ::memfd_create("output", MFD_CLOEXEC);
  if (child.messages_ < 0 || (child.options_.keeps_output && child.output_ < 0)) {
    const Error error{"", "cannot start '" + name + "': no memory file: " + std::strerror(errno)};
    close_if_open(ends[1]);
    return error;
  }
  std::vector<char*> pointers;
  for (const std::string& argument : arguments) {
    // exec promises not to write to the arguments.
    pointers.push_back(const_cast<char*>(argument.c_str()));  // NOLINT(*-pro-type-const-cast)
  }
  pointers.push_back(nullptr);
  std::vector<char*> variables = environment_without(child.options_.hidden_variables);
  int status = 0;
  {
    const SpawnSettings settings(ends[1], child.output_, child.messages_);
    status = ::posix_spawnp(&child.process_, name.c_str(), &settings.actions, &settings.attributes,
                            pointers.data(), variables.data());
  }
  close_if_open(ends[1]);
  if (status != 0) {
    child.process_ = -1;
    const std::string remedy = status == ENOENT ? child.options_.if_missing : std::string();
    return Error{"", "cannot start the program '" + name + "': " + std::strerror(status) +
                         (remedy.empty() ? "" : "; " + remedy)};
  }
  return child;
}

Errors ChildProcess::write(std::span<const std::uint8_t> bytes) {
  std::optional<Watch> watch(std::in_place, process_, options_);
  while (!bytes.empty()) {
    const ssize_t count = ::send(input_, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (count >= 0) {
      bytes = bytes.subspan(static_cast<std::size_t>(count));
      if (count > 0) watch.emplace(process_, options_);
      continue;
    }
    if (errno == EINTR) continue;
    if (errno == EAGAIN || errno == EWOULDBLOCK) {
      pollfd ready{input_, POLLOUT, 0};
      if (const char* const reason = reason_to_end()) return give_up(reason);
      if (::poll(&ready, 1, longest_poll_ms) == 0 && watch->hangs()) return give_up(hung);
      continue;
    }
    const std::string reason = std::strerror(errno);
    const std::string said = last_words();
    return {Error{"", "'" + name_ + "' stopped taking input: " + (said.empty() ? reason : said)}};
  }
  return {};
}

Errors ChildProcess::finish() {
  if (process_ < 0) return {Error{"", "'" + name_ + "' has already ended"}};
  close_input();
  Watch watch(process_, options_);
  int wait_ms = first_poll_ms;
  for (;;) {
    siginfo_t ended{};
    // WNOWAIT leaves the child to be reaped later, so that no other process gets its number before
    // its group has ended.
    const int asked =
        ::waitid(P_PID, static_cast<id_t>(process_), &ended, WEXITED | WNOHANG | WNOWAIT);
    if (asked == 0 && ended.si_pid == process_) break;
    if (asked < 0 && errno != EINTR) {
      process_ = -1;
      return {Error{"", "'" + name_ + "' is lost: " + std::strerror(errno)}};
    }
    if (const char* const reason = reason_to_end()) return give_up(reason);
    if (watch.hangs()) return give_up(hung);
    // The first waits are short, because most children end at once.
    ::poll(nullptr, 0, wait_ms);
    wait_ms = std::min(2 * wait_ms, longest_poll_ms);
  }
  if (!options_.leaves_programs) end_group();
  const int status = reap();
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return {};
  std::string how = WIFEXITED(status) ? "ended with status " + std::to_string(WEXITSTATUS(status))
                                      : signal_text(WTERMSIG(status));
  // After this signal, messages are about anything but the size.
  const bool explained = WIFSIGNALED(status) && WTERMSIG(status) == SIGXFSZ;
  if (const std::string said = last_words(); !said.empty() && !explained) how += ": " + said;
  return {Error{"", "'" + name_ + "' " + how}};
}

const char* ChildProcess::reason_to_end() const {
  if (options_.abandon && options_.abandon()) return abandoned;
  const bool too_much =
      file_size_of(output_) > options_.most_output || file_size_of(messages_) > most_messages;
  return too_much ? endless : nullptr;
}

Errors ChildProcess::give_up(const std::string& why) {
  kill();
  return {Error{"", "'" + name_ + "' " + why}};
}

void ChildProcess::kill() {
  if (process_ >= 0) {
    if (options_.leaves_programs) {
      ::kill(process_, SIGKILL);
    } else {
      end_group();
    }
    static_cast<void>(reap());
  }
  close_input();
}

void ChildProcess::end_group() const { ::kill(-process_, SIGKILL); }

int ChildProcess::reap() {
  int status = 0;
  while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
  }
  process_ = -1;
  return status;
}

void ChildProcess::close_input() { close_if_open(input_); }

std::vector<std::uint8_t> ChildProcess::output() const {
  if (output_ < 0) return {};
  std::vector<std::uint8_t> bytes(file_size_of(output_));
  std::size_t read = 0;
  while (read < bytes.size()) {
    const ssize_t count =
        ::pread(output_, bytes.data() + read, bytes.size() - read, static_cast<off_t>(read));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    read += static_cast<std::size_t>(count);
  }
  bytes.resize(read);
  return bytes;
}

std::string ChildProcess::last_words() const {
  constexpr off_t most = 600;
  if (messages_ < 0) return {};
  const auto size = static_cast<off_t>(file_size_of(messages_));
  std::string text(static_cast<std::size_t>(std::clamp<off_t>(size, 0, most)), '\0');
  const ssize_t count =
      ::pread(messages_, text.data(), text.size(), std::max<off_t>(0, size - most));
  text.resize(static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
  while (!text.empty() && (text.back() == '\n' || text.back() == '\r')) text.pop_back();
  return text;
}

}  // namespace sheave::render
