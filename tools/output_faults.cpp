#include "tools/output_faults.h"

#include <new>

#include "tools/terminal.h"

namespace sheave::tools {

bool OutputFaults::attempt(const std::function<void()>& write) {
  try {
    write();
    return true;
  } catch (const Failure& failure) {
    add(failure.what(), failure.code());
  } catch (const std::bad_alloc&) {
    add("out of memory", ExitCode::internal);
  }
  return false;
}

void OutputFaults::add(const std::string& message, ExitCode code) {
  if (!any()) code_ = code;
  text_ += (text_.empty() ? "" : "\n") + message;
}

ExitCode OutputFaults::report(ExitCode otherwise) const {
  if (!any()) return otherwise;
  print_error(text_);
  return code_;
}

}  // namespace sheave::tools
