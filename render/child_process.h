#pragma once
// A program fed through its standard input, started without a shell.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/result.h"
#include "engine/work_limit.h"

namespace sheave::render {

/// Options for starting a child and waiting for it.
struct ChildOptions {
  /// Time limit [s]: a child that during this time neither takes input nor ends nor uses any
  /// processor time is ended, and that is an error.
  double stall_seconds = 60.0;
  /// Called while waiting for the child, if set; true leaves the child `hurried_stall_seconds` in
  /// place of `stall_seconds`.
  StopRequest hurry{};
  double hurried_stall_seconds = 5.0;  ///< [s]
  /// Called while waiting for the child, if set; true ends the child, too.
  StopRequest abandon{};
  /// Largest size of its standard output, if that is kept [bytes]; a child that writes more is
  /// ended, and that is an error. Its standard error may have 16 MiB.
  std::size_t most_output = std::size_t{1} << 28U;
  /// Whether its standard output is kept for output(); otherwise it is discarded.
  bool keeps_output = false;
  /// Environment variables with these prefixes are not passed on.
  std::vector<std::string> hidden_variables{};
  /// Added to the message if the program does not exist.
  std::string if_missing{};
  /// Whether programs that the child has started may continue after its end, as a browser does.
  /// Otherwise they end with it.
  bool leaves_programs = false;
};

/// A running child. The destructor ends the child and all programs that the child has started.
class ChildProcess {
 public:
  /// Starts `arguments[0]`, looked up in PATH, with the rest as its arguments. The child's standard
  /// error goes into a buffer. The child has its own process group, so that Ctrl-C in a terminal
  /// reaches only the caller, who may still want to finish the output.
  static Result<ChildProcess> start(const std::vector<std::string>& arguments,
                                    ChildOptions options = {});
  ~ChildProcess();
  ChildProcess(ChildProcess&& other) noexcept;
  ChildProcess& operator=(ChildProcess&& other) noexcept;
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Writes bytes to standard input; waits while the child is busy. If the child has ended, this is
  /// an error, not a signal.
  Errors write(std::span<const std::uint8_t> bytes);
  /// Closes standard input, waits for the end, and reports a status other than 0 with the last part
  /// of the child's standard error.
  Errors finish();
  /// Ends the child, and the programs that it has started, at once.
  void kill();
  /// Everything that the child has written to its standard output, if that is kept.
  [[nodiscard]] std::vector<std::uint8_t> output() const;
  /// The last few hundred bytes of the child's standard error.
  [[nodiscard]] std::string last_words() const;

 private:
  ChildProcess(std::string name, ChildOptions options, int process, int input, int output,
               int messages);
  void close_input();
  /// Ends the child's process group, including its leader. The leader must not have been waited
  /// for: until then no other group can get its number.
  void end_group() const;
  /// The status of the child, which must have ended.
  int reap();
  /// Ends a child for which there is no further waiting.
  Errors give_up(const std::string& why);
  /// Why the child must end now, although it has not; null if it need not.
  [[nodiscard]] const char* reason_to_end() const;

  std::string name_;
  ChildOptions options_;
  int process_ = -1;   ///< -1: ended and waited for
  int input_ = -1;     ///< our end of its standard input
  int output_ = -1;    ///< file that holds its standard output; -1: not kept
  int messages_ = -1;  ///< file that holds its standard error
};

}  // namespace sheave::render
