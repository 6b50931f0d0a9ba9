#include "scenes/jsonnet/evaluate.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <mutex>
#include <vector>

#if SHEAVE_HAS_JSONNET
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#if defined(__linux__)
#include <sys/prctl.h>
#endif
#endif

#include <fmt/format.h>

#include "scenes/jsonnet/virtual_machine.h"

namespace sheave::jsonnet {

#if SHEAVE_HAS_JSONNET

namespace {

/// Messages of the child: a kind, a length and the bytes.
enum class Message : char { import_name = 'n', import_text = 't', json = 'j', fault = 'f' };

void send(int pipe, Message kind, std::string_view text) {
  std::string bytes(1, static_cast<char>(kind));
  const std::uint64_t size = text.size();
  bytes.append(reinterpret_cast<const char*>(&size), sizeof size);
  bytes += text;
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t count = ::write(pipe, bytes.data() + done, bytes.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) ::_exit(1);
    done += static_cast<std::size_t>(count);
  }
}

std::string read_all(int pipe, std::size_t most) {
  std::string bytes;
  std::vector<char> block(std::size_t{1} << 16U);
  while (bytes.size() <= most) {
    const ssize_t count = ::read(pipe, block.data(), block.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    bytes.append(block.data(), static_cast<std::size_t>(count));
  }
  return bytes;
}

void limit_resources(const Limits& limits) {
  rlimit cpu{limits.seconds, limits.seconds + 1};
  ::setrlimit(RLIMIT_CPU, &cpu);
  rlimit core{0, 0};
  ::setrlimit(RLIMIT_CORE, &core);
#if !defined(__SANITIZE_ADDRESS__)
  // In addition to the memory of this process, of which the child is a copy.
  std::ifstream statm("/proc/self/statm");
  std::uint64_t pages = 0;
  if (!(statm >> pages)) return;
  const std::uint64_t most =
      pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE)) + limits.memory;
  rlimit memory{most, most};
  ::setrlimit(RLIMIT_AS, &memory);
#endif
}

/// Ends this process when its parent ends: an interrupt of the parent leaves no evaluation behind.
void end_with(pid_t parent) {
#if defined(__linux__)
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
#endif
  if (::getppid() != parent) ::_exit(1);
}

/// The last program that took parameters. A sweep evaluates one program for each of its rows.
class LastFunction {
 public:
  bool is(const std::string& file_name, std::string_view text) {
    const std::lock_guard lock(mutex_);
    return file_name_ == file_name && text_ == text;
  }
  void set(const std::string& file_name, std::string_view text) {
    const std::lock_guard lock(mutex_);
    file_name_ = file_name;
    text_ = text;
  }

 private:
  std::mutex mutex_;
  std::string file_name_;
  std::string text_;
};

[[noreturn]] void evaluate_in_child(int pipe, std::string_view text, const std::string& file_name,
                                    const JsonnetOptions& options, const Limits& limits,
                                    bool known_function) {
  // The child does not inherit the command's signal handlers; it just ends.
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGXCPU, SIGABRT, SIGSEGV}) {
    std::signal(signal, SIG_DFL);
  }
  // Messages of the evaluator's library before it aborts are not useful to users.
  if (::close(STDERR_FILENO) != 0) ::_exit(1);
  limit_resources(limits);
  const Evaluation evaluation =
      run_program(text, file_name, options, limits, known_function, [&](const Source& source) {
        send(pipe, Message::import_name, source.name);
        send(pipe, Message::import_text, source.text);
      });
  send(pipe, evaluation.good ? Message::json : Message::fault, evaluation.text);
  ::_exit(0);
}

SceneError error_at(std::string file, std::string message, FaultCode code = FaultCode::meaning) {
  return {std::move(file), 0, 0, "", std::move(message), {}, {}, code};
}

/// Reads a position in Jsonnet's form: "file:3:5-9" or "file:(3:5)-(4:2)".
bool read_place(const std::string& text, std::size_t at, SceneError& error) {
  const std::size_t start = at < text.size() && text[at] == '(' ? at + 1 : at;
  char* end = nullptr;
  const long line = std::strtol(text.c_str() + start, &end, 10);
  if (line < 1 || *end != ':' || std::isdigit(static_cast<unsigned char>(end[1])) == 0) {
    return false;
  }
  error.line = static_cast<int>(line);
  error.column = static_cast<int>(std::strtol(end + 1, nullptr, 10));
  return true;
}

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

/// Error with the first position in one of the files; in the library only if there is no other.
SceneError error_of(const std::string& told, const std::string& file_name,
                    const std::vector<Source>& sources) {
  SceneError error = error_at(file_name, first_line(told), FaultCode::syntax);
  std::size_t best = std::string::npos;
  for (const Source& source : sources) {
    for (std::size_t at = told.find(source.name + ":"); at != std::string::npos;
         at = told.find(source.name + ":", at + 1)) {
      SceneError place = error;
      if (!read_place(told, at + source.name.size() + 1, place)) continue;
      const bool own = source.name != "sheave.libsonnet";
      if (own ? at < best : best == std::string::npos && error.line == 0) {
        if (own) best = at;
        error.file = source.name;
        error.line = place.line;
        error.column = place.column;
      }
      break;
    }
  }
  for (const char* const prefix : {"RUNTIME ERROR: ", "STATIC ERROR: "}) {
    if (!error.message.starts_with(prefix)) continue;
    error.message = error.message.substr(std::strlen(prefix));
    error.code = prefix[0] == 'R' ? FaultCode::meaning : FaultCode::syntax;
  }
  // "file:1:5-6: message" contains the position twice.
  if (error.message.starts_with(error.file + ":")) {
    const std::size_t colon = error.message.find(": ");
    if (colon != std::string::npos) error.message = error.message.substr(colon + 2);
  }
  return error;
}

struct Ending {
  std::string fault;
  bool ended = false;  ///< whether the child sent its last message
};

/// Imported files and the JSON become part of the outcome.
Ending read_messages(const std::string& bytes, Outcome& outcome) {
  Ending ending;
  for (std::size_t at = 0; at + 1 + sizeof(std::uint64_t) <= bytes.size();) {
    const auto kind = static_cast<Message>(bytes[at]);
    std::uint64_t size = 0;
    std::memcpy(&size, bytes.data() + at + 1, sizeof size);
    at += 1 + sizeof size;
    if (size > bytes.size() - at) break;
    std::string content = bytes.substr(at, size);
    at += size;
    if (kind == Message::import_name) {
      outcome.sources.push_back({std::move(content), {}});
    } else if (kind == Message::import_text) {
      outcome.sources.back().text = std::move(content);
    } else if (kind == Message::json) {
      outcome.json = std::move(content);
    } else if (kind == Message::fault) {
      ending.fault = std::move(content);
    }
    ending.ended = kind == Message::json || kind == Message::fault;
  }
  return ending;
}

/// Why a child has ended without a message.
std::string end_text(int status, const Limits& limits) {
  if (WIFSIGNALED(status) && (WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL)) {
    return fmt::format("the program takes more than {} s to evaluate", limits.seconds);
  }
  return fmt::format(
      "the program cannot be evaluated: it takes more than {} MB of memory, or is "
      "nested too deeply",
      limits.memory >> 20U);
}

}  // namespace

bool is_available() { return true; }

Outcome evaluate(std::string_view text, const std::string& file_name, const JsonnetOptions& options,
                 const Limits& limits) {
  Outcome outcome;
  outcome.sources.push_back({file_name, std::string(text)});
  static LastFunction last_function;
  const bool known_function = last_function.is(file_name, text);
  std::array<int, 2> pipe{};
  if (::pipe2(pipe.data(), O_CLOEXEC) != 0) {
    outcome.errors.push_back(error_at(file_name, "no pipe for Jsonnet", FaultCode::unreadable));
    return outcome;
  }
  const pid_t parent = ::getpid();
  const pid_t child = ::fork();
  const int fork_error = errno;
  if (child == 0) {
    end_with(parent);
    evaluate_in_child(pipe[1], text, file_name, options, limits, known_function);
  }
  ::close(pipe[1]);
  const std::size_t most = 64 * limits.text;
  const std::string bytes = child > 0 ? read_all(pipe[0], most) : std::string();
  ::close(pipe[0]);
  int status = 0;
  while (child > 0 && ::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  const Ending ending = read_messages(bytes, outcome);
  if (child < 0) {
    outcome.errors.push_back(
        error_at(file_name,
                 fmt::format("no process can be started to evaluate the program: {}; allow this "
                             "user more processes (ulimit -u)",
                             std::strerror(fork_error)),
                 FaultCode::unreadable));
  } else if (!ending.ended) {
    outcome.errors.push_back(error_at(file_name, end_text(status, limits), FaultCode::too_large));
  } else if (!ending.fault.empty()) {
    outcome.errors.push_back(error_of(ending.fault, file_name, outcome.sources));
  } else if (!options.parameters.empty() && !known_function) {
    last_function.set(file_name, text);
  }
  return outcome;
}

#else

bool is_available() { return false; }

Outcome evaluate(std::string_view, const std::string& file_name, const JsonnetOptions&,
                 const Limits&) {
  return {{},
          {{file_name,
            0,
            0,
            "",
            "this build cannot read Jsonnet (libjsonnet was not found)",
            {},
            {},
            FaultCode::unreadable}},
          {}};
}

#endif

}  // namespace sheave::jsonnet
