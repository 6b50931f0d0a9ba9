#pragma once
// Texts that mean something to programs which take them for more than texts.

#include <cstdint>
#include <string>
#include <vector>

namespace sheave::test {

/// What the texts below would have a shell or gnuplot make: a file of this name.
inline constexpr const char* hostile_file = "pwned";
/// Is in every one of them that is long enough.
inline constexpr const char* hostile_mark = "PWN";

/// One of each kind: quotes, line breaks, commands, macros, markup, control characters, bytes that
/// are no UTF-8, and very much of it.
[[nodiscard]] std::vector<std::string> hostile_texts();

/// A text that follows from a seed, put together of pieces of such ones.
[[nodiscard]] std::string hostile_text(std::uint64_t seed);

}  // namespace sheave::test
