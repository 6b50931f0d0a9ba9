#pragma once
// Runs of the command in which no text from outside may do anything.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "command/text/one_line.h"
#include "scenes/json/text.h"
#include "tests/command/process.h"
#include "tests/support/hostile_text.h"

namespace sheave::test {

/// Nothing in it that a terminal acts on, but for line breaks and tabs.
inline void expect_showable(std::string_view text, const std::string& where) {
  while (!text.empty()) {
    const std::size_t length = sheave::json::character_length(text);
    ASSERT_GT(length, 0U) << where << " is no UTF-8: " << command::one_line(text);
    const std::string_view character = text.substr(0, length);
    if (character != "\n" && character != "\t") {
      ASSERT_FALSE(command::cannot_be_shown(character)) << where << ": " << command::one_line(text);
    }
    text.remove_prefix(length);
  }
}

/// Remembers every program that is started, and looks at what is printed and at what appears.
class WatchedRuns {
 public:
  /// Runs the command, which may leave files of these names in the folder, and no others. They are
  /// removed; `contents` has them, as far as they are there.
  ProcessResult run(const std::vector<std::string>& arguments,
                    const std::vector<std::string>& files = {}) {
    std::vector<std::string> before = folder.entries();
    ProcessResult result =
        run_sheave(arguments, {.environment = {"LD_PRELOAD=" SHEAVE_FAULT_LIBRARY,
                                               "SHEAVE_FAULT_PROGRAMS=" + log_.path("programs"),
                                               // What it would make without a folder's name.
                                               "GNUTERM=no such terminal"}});
    expect_showable(result.out, arguments[0] + ", standard output");
    expect_showable(result.err, arguments[0] + ", standard error");
    contents.clear();
    for (const std::string& file : files) {
      contents.push_back(read_file(folder.path(file)));
      std::filesystem::remove(folder.path(file));
    }
    EXPECT_EQ(folder.entries(), before);
    EXPECT_FALSE(std::filesystem::exists(hostile_file));
    return result;
  }

  /// How many gnuplots there were; no other program may have been started.
  int gnuplots() {
    int count = 0;
    for (const std::string& program : split(read_file(log_.path("programs")), '\n')) {
      const std::string name = std::filesystem::path(program).filename();
      // The sanitizer asks its symbolizer whether a leak is one of those that are known.
      const bool symbolizer = SHEAVE_SANITIZED != 0 && name.starts_with("llvm-symbolizer");
      EXPECT_TRUE(name.empty() || name == "sheave" || name.starts_with("gnuplot") || symbolizer)
          << program;
      count += name.starts_with("gnuplot") ? 1 : 0;
    }
    return count;
  }

  TemporaryFolder folder;
  std::vector<std::string> contents;

 private:
  TemporaryFolder log_;
};

}  // namespace sheave::test
