#pragma once
// One failing output must not prevent the others. Each output is attempted, and all faults are
// reported at the end.

#include <functional>
#include <string>

#include "command/failure.h"

namespace sheave::command {

class OutputFaults {
 public:
  /// Writes an output. Remembers a Failure or lack of memory. Returns whether the output was
  /// written.
  bool attempt(const std::function<void()>& write);
  /// Remembers a fault found elsewhere (74).
  void add(const std::string& message, ExitCode code = ExitCode::io);

  /// Remembers lack of memory. Allocates nothing.
  void add_out_of_memory();

  [[nodiscard]] bool any() const { return code_ != ExitCode::done; }
  /// Reports all faults on standard error. Returns the exit code: 70 after lack of memory, else the
  /// code of the first fault. Either replaces the command's other exit codes. `otherwise` if there
  /// was no fault.
  [[nodiscard]] ExitCode report(ExitCode otherwise) const;

 private:
  std::string text_;
  bool out_of_memory_ = false;
  ExitCode code_ = ExitCode::done;
};

}  // namespace sheave::command
