#pragma once
// A hash of all inputs that decide a result, by which journals recognise runs of the same work.

#include <cstdint>
#include <string>
#include <string_view>

namespace sheave::command {

/// FNV-1a, 64 bits, of a list of texts.
class ContentHash {
 public:
  /// Two texts are not the same as one that is both.
  void add(std::string_view bytes);
  /// The program's version and its file, byte by byte: two builds of one version differ.
  void add_program();
  /// 16 hexadecimal digits.
  [[nodiscard]] std::string text() const;

 private:
  std::uint64_t value_ = 0xcbf29ce484222325ULL;
};

}  // namespace sheave::command
