#include "scenes/json/checksum_chain.h"

#include <cstddef>

#include <fmt/format.h>

namespace sheave::json {
namespace {

constexpr std::size_t checksum_digits = 16;

bool only_of(std::string_view text, std::string_view allowed) {
  return text.find_first_not_of(allowed) == std::string_view::npos;
}

}  // namespace

std::string ChecksumChain::add(std::string_view line) {
  constexpr std::uint64_t prime = 0x100000001b3ULL;
  for (const char c : line) value_ = (value_ ^ static_cast<unsigned char>(c)) * prime;
  value_ = (value_ ^ static_cast<unsigned char>('\n')) * prime;
  return fmt::format("{} {:016x}", ++lines_, value_);
}

bool is_checksum_mark(std::string_view text, ChecksumMark& mark) {
  const std::size_t blank = text.find(' ');
  if (blank == 0 || blank == std::string_view::npos) return false;
  mark = {text.substr(0, blank), text.substr(blank + 1)};
  return only_of(mark.number, "0123456789") && mark.checksum.size() == checksum_digits &&
         only_of(mark.checksum, "0123456789abcdef");
}

std::string checksum_fault(std::string_view mark, std::string_view expected) {
  if (mark == expected) return {};
  ChecksumMark found, right;
  if (!is_checksum_mark(mark, found) || !is_checksum_mark(expected, right)) {
    return fmt::format("the line has been changed: its number and its checksum must be \"{}\"",
                       expected);
  }
  // Content that has been changed leaves the number; a line from elsewhere has another one.
  if (found.number != right.number && found.checksum != right.checksum) {
    return fmt::format(
        "line {} stands where line {} must be: lines were removed, repeated or moved", found.number,
        right.number);
  }
  return fmt::format(
      "the line has been changed: its number and its checksum are \"{}\" and must be \"{}\"", mark,
      expected);
}

}  // namespace sheave::json
