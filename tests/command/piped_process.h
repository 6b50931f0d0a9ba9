#pragma once
// The sheave command between two pipes, to talk with.

#include <string>
#include <vector>

#include "tests/command/process.h"

namespace sheave::test {

class PipedProcess {
 public:
  explicit PipedProcess(const std::vector<std::string>& arguments);
  ~PipedProcess();
  PipedProcess(const PipedProcess&) = delete;
  PipedProcess& operator=(const PipedProcess&) = delete;

  /// Writes all of it, however long that takes; false if nobody reads it.
  bool write(const std::string& text) const;
  /// The next line of its output, without its end; empty when there is none any more.
  std::string read_line();
  /// All that it still writes until it ends.
  std::string read_rest();
  void close_input();
  void close_output();
  void send(int signal) const;
  [[nodiscard]] bool running() const;
  /// Waits for its end, with both pipes as they are. `out` is empty.
  ProcessResult wait();

 private:
  int process_ = -1;
  int in_ = -1;
  int out_ = -1;
  int err_ = -1;
  std::string buffer_;
};

}  // namespace sheave::test
