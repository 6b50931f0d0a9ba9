#pragma once
// Outputs that fail must not take the others with them: each is attempted, and what failed is told
// at the end, all of it.

#include <functional>
#include <string>

#include "command/failure.h"

namespace sheave::command {

class OutputFaults {
 public:
  /// Writes an output; if that ends in a Failure or for want of memory, remembers it. Whether it
  /// was written.
  bool attempt(const std::function<void()>& write);
  /// Remembers a fault that was found elsewhere (74).
  void add(const std::string& message, ExitCode code = ExitCode::io);

  /// Remembers that memory was wanting; needs none.
  void add_out_of_memory();

  [[nodiscard]] bool any() const { return code_ != ExitCode::done; }
  /// Says on standard error what failed. The exit code: 70 if memory was wanting, else that of the
  /// first fault, either of which replaces any other of the command; `otherwise` if there is none.
  [[nodiscard]] ExitCode report(ExitCode otherwise) const;

 private:
  std::string text_;
  bool out_of_memory_ = false;
  ExitCode code_ = ExitCode::done;
};

}  // namespace sheave::command
