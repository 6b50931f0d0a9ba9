#pragma once
// A program fed through its standard input, started without a shell.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/result.h"
#include "engine/work_limit.h"

namespace sheave::render {

/// A running child. Destroying it ends the child.
class ChildProcess {
 public:
  /// Starts `arguments[0]`, looked up in PATH, with the rest as its arguments. Its standard output
  /// goes nowhere, its standard error into a buffer. It gets its own process group, so that Ctrl-C
  /// in a terminal reaches only the caller, who may still want to finish the output.
  ///
  /// `stall_seconds`: a child that for so long neither takes input nor ends nor uses any processor
  /// time hangs; it is ended, and that is an error. `abandon`, if there is one, is asked while we
  /// wait for the child; true ends it likewise.
  static constexpr double usual_stall_seconds = 60.0;
  static Result<ChildProcess> start(const std::vector<std::string>& arguments,
                                    double stall_seconds = usual_stall_seconds,
                                    StopRequest abandon = {});
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
  /// Ends the child at once.
  void kill();
  /// The last few hundred bytes of the child's standard error.
  [[nodiscard]] std::string last_words() const;

 private:
  ChildProcess(std::string name, int process, int input, int messages, double stall_seconds,
               StopRequest abandon);
  void close_input();
  /// Ends a child that is no longer waited for.
  Errors give_up(const std::string& why);
  [[nodiscard]] bool is_abandoned() const { return abandon_ && abandon_(); }

  std::string name_;
  double stall_seconds_;
  StopRequest abandon_;
  int process_ = -1;   ///< -1: ended and waited for
  int input_ = -1;     ///< our end of its standard input
  int messages_ = -1;  ///< file that holds its standard error
};

}  // namespace sheave::render
