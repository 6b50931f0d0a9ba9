#pragma once
// States as versions without a checksum wrote them: what of a file is changed can be read there.

#include <cstdint>
#include <cstring>
#include <string>

#include "engine/state.h"

namespace sheave::test {

/// The bytes of a state without a history of motion, as SHSTATE2: without the mark, the origin, the
/// word of the empty history and the checksum.
inline std::string without_checksum(const std::string& bytes) {
  constexpr std::size_t word = 8;
  return "SHSTATE2" + bytes.substr(4 * word, bytes.size() - 6 * word);
}
/// The state as SHSTATE3 would have it: with a checksum of the words between tag and checksum and of
/// their number, and without a history.
inline std::string as_version_3(State state) {
  constexpr std::size_t word = 8;
  state.history = {};
  const std::string bytes = to_bytes(state);
  std::string old = "SHSTATE3" + bytes.substr(word, bytes.size() - 3 * word);
  std::uint64_t sum = 0xcbf29ce484222325;
  const auto add = [&sum](std::uint64_t next) {
    sum = (sum ^ next) * 0x100000001b3;
    sum ^= sum >> 32;
  };
  for (std::size_t i = 0; i < old.size(); i += word) {
    std::uint64_t next = 0;
    std::memcpy(&next, old.data() + i, word);
    add(next);
  }
  add(old.size() / word);
  old.resize(old.size() + word);
  std::memcpy(old.data() + old.size() - word, &sum, word);
  return old;
}
/// The state as SHSTATE2 would have it.
inline std::string as_version_2(State state) {
  state.history = {};
  return without_checksum(to_bytes(state));
}

}  // namespace sheave::test
