#include "measure/instruction_counter.h"

#include <array>
#include <cerrno>
#include <cstring>

#ifdef __linux__
#include <linux/perf_event.h>
#include <sys/syscall.h>
#include <unistd.h>
#endif

namespace sheave::measure {

#ifdef __linux__

InstructionCounter::InstructionCounter() {
  perf_event_attr attributes{};
  attributes.size = sizeof(attributes);
  attributes.type = PERF_TYPE_HARDWARE;
  attributes.config = PERF_COUNT_HW_INSTRUCTIONS;
  attributes.exclude_kernel = 1;
  attributes.exclude_hv = 1;
  // Time enabled and time running: if they differ, the count is incomplete.
  attributes.read_format = PERF_FORMAT_TOTAL_TIME_ENABLED | PERF_FORMAT_TOTAL_TIME_RUNNING;
  constexpr int this_thread = 0;
  constexpr int any_cpu = -1;
  constexpr int no_group = -1;
  descriptor_ = static_cast<int>(::syscall(SYS_perf_event_open, &attributes, this_thread, any_cpu,
                                           no_group, PERF_FLAG_FD_CLOEXEC));
  if (descriptor_ < 0) reason_ = std::string("no hardware counter: ") + std::strerror(errno);
}

InstructionCounter::~InstructionCounter() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

std::optional<std::uint64_t> InstructionCounter::read() const {
  std::array<std::uint64_t, 3> values{};  // the count, time enabled, time running
  constexpr auto size = static_cast<ssize_t>(sizeof(values));
  if (descriptor_ < 0 || ::read(descriptor_, values.data(), sizeof(values)) != size) return {};
  if (values[1] != values[2]) return {};
  return values[0];
}

#else

InstructionCounter::InstructionCounter() : reason_("only on Linux") {}
InstructionCounter::~InstructionCounter() = default;
std::optional<std::uint64_t> InstructionCounter::read() const { return {}; }

#endif

}  // namespace sheave::measure
