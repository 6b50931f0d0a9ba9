#pragma once
// Properties of the machine and the build on which times depend.

#include <string>

namespace sheave::command {

struct MachineInfo {
  std::string cpu;  ///< the system's name for it; "unknown" if there is none
  int cores = 0;
  std::string compiler;     ///< that built this program
  bool assertions = false;  ///< built with assertions: its times are meaningless
};

[[nodiscard]] MachineInfo machine_info();

}  // namespace sheave::command
