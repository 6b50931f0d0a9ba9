#include "engine/number_text.h"

#include <array>
#include <charconv>
#include <cstdlib>
#include <limits>
#include <locale>
#include <sstream>

namespace sheave {
namespace {

#ifdef __cpp_lib_to_chars

template <class... Format>
std::string written(double value, Format... format) {
  std::array<char, 352> text{};  // room for the longest finite double in fixed notation
  const auto [end, code] = std::to_chars(text.data(), text.data() + text.size(), value, format...);
  return code == std::errc() ? std::string(text.data(), end) : std::string("?");
}

std::string shortest(double value) { return written(value); }
std::string general(double value, int digits) {
  return written(value, std::chars_format::general, digits);
}

std::string fixed(double value, int decimals) {
  return written(value, std::chars_format::fixed, decimals);
}

#else

// Emscripten's library writes numbers through streams only.

std::string streamed(double value, int digits, std::ios_base::fmtflags notation) {
  std::ostringstream stream;
  stream.imbue(std::locale::classic());
  stream.precision(digits);
  stream.setf(notation, std::ios_base::floatfield);
  stream << value;
  return stream.str();
}

std::string general(double value, int digits) { return streamed(value, digits, {}); }

std::string fixed(double value, int decimals) {
  return streamed(value, decimals, std::ios_base::fixed);
}

std::string shortest(double value) {
  constexpr int most = std::numeric_limits<double>::max_digits10;
  int digits = 1;
  while (digits < most && std::strtod(general(value, digits).c_str(), nullptr) != value) ++digits;
  const std::string scientific = streamed(value, digits - 1, std::ios_base::scientific);
  for (int decimals = 0; decimals <= most + 3; ++decimals) {
    const std::string plain = fixed(value, decimals);
    if (plain.size() > scientific.size()) break;
    if (std::strtod(plain.c_str(), nullptr) == value) return plain;
  }
  return scientific;
}

#endif

}  // namespace

std::string number_text(double value) { return shortest(value); }
std::string number_text(double value, int digits) { return general(value, digits); }
std::string fixed_number_text(double value, int decimals) { return fixed(value, decimals); }

}  // namespace sheave
