#pragma once
// The command with faults injected into its calls (tests/fault_library), and what that library
// recorded.

#include <string>
#include <vector>

#include "tests/command/process.h"

namespace sheave::test {

/// Which calls fail.
struct Fault {
  long call = 0;         ///< the n-th output call; 0: none
  long allocation = 0;   ///< the n-th allocation; 0: none
  bool stays = false;    ///< and all after it
  std::string log = {};  ///< file for the record of the calls; empty: none
};

/// `options` with the library and the fault in the environment.
[[nodiscard]] ProcessOptions with_fault(const Fault& fault, ProcessOptions options = {});

/// One recorded call that succeeded.
struct RecordedCall {
  /// "write", "pwrite", "fsync", "rename", "create", "open", "close", "unlink", "ftruncate"
  std::string name;
  int descriptor = -1;
  long offset = -1;
  std::string first;   ///< the bytes, or a path
  std::string second;  ///< of rename: the new path
};

struct FaultLog {
  std::vector<RecordedCall> recorded;
  long calls = 0;        ///< that can fail, in all
  long allocations = 0;  ///< likewise
};
[[nodiscard]] FaultLog read_fault_log(const std::string& path);

}  // namespace sheave::test
