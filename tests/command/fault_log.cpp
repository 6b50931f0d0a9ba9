#include "tests/command/fault_log.h"

#include <sstream>

namespace sheave::test {

ProcessOptions with_fault(const Fault& fault, ProcessOptions options) {
  options.environment.emplace_back("LD_PRELOAD=" SHEAVE_FAULT_LIBRARY);
  options.environment.push_back("SHEAVE_FAULT_AT=" + std::to_string(fault.call));
  options.environment.push_back("SHEAVE_FAULT_NEW=" + std::to_string(fault.allocation));
  options.environment.emplace_back(fault.stays ? "SHEAVE_FAULT_STAYS=1" : "SHEAVE_FAULT_STAYS=0");
  if (!fault.log.empty()) options.environment.push_back("SHEAVE_FAULT_LOG=" + fault.log);
  // The sanitizers' library wants to be the first; here it need not be.
  if (SHEAVE_SANITIZED) options.environment.emplace_back("ASAN_OPTIONS=verify_asan_link_order=0");
  return options;
}

FaultLog read_fault_log(const std::string& path) {
  FaultLog log;
  std::istringstream stream(read_file(path));
  RecordedCall call;
  std::size_t first = 0;
  std::size_t second = 0;
  while (stream >> call.name >> call.descriptor >> call.offset >> first >> second) {
    stream.ignore(1);
    call.first.resize(first);
    call.second.resize(second);
    stream.read(call.first.data(), static_cast<std::streamsize>(first));
    stream.read(call.second.data(), static_cast<std::streamsize>(second));
    if (call.name == "end") {
      log.calls = call.descriptor;
      log.allocations = call.offset;
    } else {
      log.recorded.push_back(call);
    }
  }
  return log;
}

}  // namespace sheave::test
