#pragma once
// How the command ends. The libraries return their errors as values. A subcommand that cannot
// continue throws a Failure, and main turns the Failure into a message and an exit code. Stack
// unwinding removes unfinished output files.

#include <stdexcept>
#include <string>

#include "engine/result.h"

namespace sheave::command {

/// Exit codes: the numbers of BSD's sysexits.h where one of them fits.
enum class ExitCode {
  done = 0,
  check_failed = 1,  ///< a check of the scene did not hold
  usage = 2,         ///< wrong command line
  bad_scene = 65,    ///< the contents of an input file are wrong
  no_input = 66,     ///< no such input file
  internal = 70,
  io = 74,            ///< an input cannot be read or an output cannot be written
  diverged = 75,      ///< the simulation stopped at a meaningless state
  doubtful = 76,      ///< a run's certificate is not clean, and --strict was given
  time_limit = 124,   ///< --time-limit; the code is that of timeout(1)
  interrupted = 130,  ///< by a signal
};

/// Ends the command with this message, one or more lines, and exit code.
class Failure : public std::runtime_error {
 public:
  Failure(ExitCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  [[nodiscard]] ExitCode code() const { return code_; }

 private:
  ExitCode code_;
};

/// All errors, one per line.
[[nodiscard]] inline std::string to_text(const Errors& errors) {
  std::string text;
  for (const Error& error : errors) {
    if (!text.empty()) text += '\n';
    if (!error.path.empty()) text += error.path + ": ";
    text += error.message;
  }
  return text;
}

}  // namespace sheave::command
