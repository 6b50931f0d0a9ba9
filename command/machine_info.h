#pragma once
// What times depend on besides the program.

#include <string>

namespace sheave::command {

struct MachineInfo {
  std::string cpu;  ///< as the system calls it; "unknown" if it does not tell
  int cores = 0;
  std::string compiler;     ///< that this program was built with
  bool assertions = false;  ///< built with assertions: its times mean nothing
};

[[nodiscard]] MachineInfo machine_info();

}  // namespace sheave::command
