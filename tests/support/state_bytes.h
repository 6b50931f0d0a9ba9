#pragma once
// States as versions without a checksum wrote them: what of a file is changed can be read there.

#include <string>

namespace sheave::test {

/// What to_bytes() writes, as SHSTATE2: without the mark, the origin and the checksum.
inline std::string without_checksum(const std::string& bytes) {
  constexpr std::size_t word = 8;
  std::string old = "SHSTATE2" + bytes.substr(4 * word, bytes.size() - 5 * word);
  return old;
}

}  // namespace sheave::test
