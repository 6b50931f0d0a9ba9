#pragma once
// Runs the sheave command as a child process and looks at what it did.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace sheave::test {

/// How a process ended and what it said.
struct ProcessResult {
  int exit_code = -1;  ///< -1 if a signal ended it
  int signal = 0;      ///< that ended it, or 0
  std::string out;
  std::string err;
};

/// How to start a process.
struct ProcessOptions {
  std::string input{};                     ///< its standard input
  std::vector<std::string> environment{};  ///< added: "NAME=value"
  bool closed_stdout = false;              ///< its standard output is a pipe that nobody reads
  std::string stdout_path{};               ///< its standard output goes to this file instead
  bool terminal_stderr = false;            ///< its standard error is a terminal
  std::int64_t file_size_limit = -1;       ///< bytes that a file of it may have; -1: no limit
  std::int64_t stack_limit = -1;           ///< bytes of its stack; -1: as that of the test
};

/// The command, running.
class Process {
 public:
  /// Starts `sheave` with these arguments.
  explicit Process(const std::vector<std::string>& arguments, const ProcessOptions& options = {});
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  void send(int signal) const;
  /// Whether it has not ended yet.
  [[nodiscard]] bool running() const;
  /// Waits until a condition holds, however long that takes on a busy machine; false if the process
  /// ended before.
  bool wait_until(const std::function<bool()>& condition) const;
  /// Waits until its standard error, a terminal, has shown this text; false if it ended without.
  bool wait_for_terminal(const std::string& text);
  /// Waits for its end.
  ProcessResult wait();

 private:
  /// Reads what there is, at least something; false if there is no more to come.
  bool read_terminal();
  void drain_terminal();

  int process_ = -1;
  int out_ = -1;
  int err_ = -1;
  int terminal_ = -1;
  std::string shown_;  // on the terminal
};

/// Runs `sheave` to its end.
[[nodiscard]] ProcessResult run_sheave(const std::vector<std::string>& arguments,
                                       const ProcessOptions& options = {});

/// A new folder that is removed at the end of the test.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  [[nodiscard]] std::string path(const std::string& name) const { return (path_ / name).string(); }
  /// Writes a file and returns its path.
  std::string write(const std::string& name, const std::string& content) const;
  /// Names of all entries, hidden ones too, in order.
  [[nodiscard]] std::vector<std::string> entries() const;

 private:
  std::filesystem::path path_;
};

[[nodiscard]] std::string read_file(const std::string& path);
[[nodiscard]] std::vector<std::string> split(const std::string& text, char separator);

}  // namespace sheave::test
