#pragma once
// A program fed through its standard input, started without a shell.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/result.h"
#include "engine/work_limit.h"

namespace sheave::render {

/// How a child is started and how long it is waited for.
struct ChildOptions {
  /// [s]; a child that for so long neither takes input nor ends nor uses any processor time hangs;
  /// it is ended, and that is an error.
  double stall_seconds = 60.0;
  /// If there is one, it is asked while we wait for the child; true ends the child likewise.
  StopRequest abandon{};
  /// Whether its standard output is kept for output(); otherwise that goes nowhere.
  bool keeps_output = false;
  /// Variables of our environment whose names begin so are not handed on.
  std::vector<std::string> hidden_variables{};
  /// What a message adds if there is no such program.
  std::string if_missing{};
  /// Whether programs that it has started may go on when it has ended, as a browser does. Otherwise
  /// they end with it.
  bool leaves_programs = false;
};

/// A running child. Destroying it ends the child and all that the child has started.
class ChildProcess {
 public:
  /// Starts `arguments[0]`, looked up in PATH, with the rest as its arguments. Its standard error
  /// goes into a buffer. It gets its own process group, so that Ctrl-C in a terminal reaches only
  /// the caller, who may still want to finish the output.
  static Result<ChildProcess> start(const std::vector<std::string>& arguments,
                                    ChildOptions options = {});
  ~ChildProcess();
  ChildProcess(ChildProcess&& other) noexcept;
  ChildProcess& operator=(ChildProcess&& other) noexcept;
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Feeds bytes to standard input; waits while the child is busy. No signal if the child has
  /// ended, but an error.
  Errors write(std::span<const std::uint8_t> bytes);
  /// Closes standard input, waits for the end and reports a status other than 0 with the last of
  /// what the child said.
  Errors finish();
  /// Ends the child, and what it has started, at once.
  void kill();
  /// All that the child has written to its standard output, if that is kept.
  [[nodiscard]] std::vector<std::uint8_t> output() const;
  /// The last few hundred bytes of the child's standard error.
  [[nodiscard]] std::string last_words() const;

 private:
  ChildProcess(std::string name, ChildOptions options, int process, int input, int output,
               int messages);
  void close_input();
  /// Ends the child's group, its leader with it. The leader must not have been waited for yet:
  /// until then no other group can have its number.
  void end_group() const;
  /// The status of the child once it has ended, which it must have.
  int reap();
  /// Ends a child that is no longer waited for.
  Errors give_up(const std::string& why);
  [[nodiscard]] bool is_abandoned() const { return options_.abandon && options_.abandon(); }

  std::string name_;
  ChildOptions options_;
  int process_ = -1;   ///< -1: ended and waited for
  int input_ = -1;     ///< our end of its standard input
  int output_ = -1;    ///< file that holds its standard output; -1: not kept
  int messages_ = -1;  ///< file that holds its standard error
};

}  // namespace sheave::render
