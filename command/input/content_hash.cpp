#include "command/input/content_hash.h"

#include <cstddef>

#include <sheave_version.h>

#include <fmt/format.h>

#include "command/input/file.h"

namespace sheave::command {
namespace {

/// Far more than any program.
constexpr std::size_t most_bytes = std::size_t{1} << 30U;

}  // namespace

void ContentHash::add(std::string_view bytes) {
  constexpr std::uint64_t prime = 0x100000001b3ULL;
  for (const char c : bytes) value_ = (value_ ^ static_cast<unsigned char>(c)) * prime;
  value_ = (value_ ^ 0xffULL) * prime;
}

void ContentHash::add_program() {
  add(version_string);
  add(read_input("/proc/self/exe", most_bytes));
}

std::string ContentHash::text() const { return fmt::format("{:016x}", value_); }

}  // namespace sheave::command
