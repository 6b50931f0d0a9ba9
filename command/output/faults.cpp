#include "command/output/faults.h"

#include <new>

#include "command/terminal.h"

namespace sheave::command {

bool OutputFaults::attempt(const std::function<void()>& write) {
  try {
    try {
      write();
      return true;
    } catch (const Failure& failure) {
      add(failure.what(), failure.code());
    }
  } catch (const std::bad_alloc&) {
    add_out_of_memory();
  }
  return false;
}

void OutputFaults::add_out_of_memory() {
  out_of_memory_ = true;
  code_ = ExitCode::internal;
}

void OutputFaults::add(const std::string& message, ExitCode code) {
  if (!any()) code_ = code;
  text_ += (text_.empty() ? "" : "\n") + message;
}

ExitCode OutputFaults::report(ExitCode otherwise) const {
  if (!any()) return otherwise;
  if (!text_.empty()) print_error(text_);
  if (out_of_memory_) print_error("out of memory");
  return code_;
}

}  // namespace sheave::command
