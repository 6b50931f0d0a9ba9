#pragma once
// Counts the instructions of this thread, if the machine allows it.

#include <cstdint>
#include <optional>
#include <string>

namespace sheave::measure {

/// A hardware counter of the kernel (perf_event_open), of user code only.
class InstructionCounter {
 public:
  InstructionCounter();
  ~InstructionCounter();
  InstructionCounter(const InstructionCounter&) = delete;
  InstructionCounter& operator=(const InstructionCounter&) = delete;

  [[nodiscard]] bool available() const { return descriptor_ >= 0; }
  /// Why the counter is not available, in a few words; empty if it is.
  [[nodiscard]] const std::string& reason() const { return reason_; }
  /// Instructions since the counter was made. Nothing if it is not available or was replaced by
  /// other counters for a time, so every returned number is a complete count.
  [[nodiscard]] std::optional<std::uint64_t> read() const;

 private:
  int descriptor_ = -1;
  std::string reason_;
};

}  // namespace sheave::measure
