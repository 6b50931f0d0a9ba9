#include "tests/support/hostile_text.h"

#include <random>
#include <string_view>

namespace sheave::test {
namespace {

using namespace std::string_view_literals;

constexpr std::size_t very_long = 1'000'000;

constexpr std::string_view pieces[]{
    "'"sv,
    "\""sv,
    "\\\""sv,
    "\\"sv,
    "\\\n"sv,
    "\n"sv,
    "\r"sv,
    "\r\n"sv,
    "\0"sv,
    "\x1a"sv,
    "\x04"sv,
    "\x1b[2J"sv,
    "\x7f"sv,
    "\xc2\x85"sv,
    "\xe2\x80\xa8"sv,
    "\xe2\x80\xae"sv,
    "\xef\xbf\xbf"sv,
    "\xff"sv,
    "\xc3"sv,
    "\xed\xa0\x80"sv,
    "\xf0\x9f\x8f\x97"sv,
    "`touch pwned`"sv,
    "$(touch pwned)"sv,
    "\nsystem(\"touch pwned\")\n"sv,
    "\n!touch pwned\n"sv,
    "\nset output 'pwned'\nplot x\n"sv,
    "\nset print 'pwned'; print 1\n"sv,
    "\nload '< touch pwned'\n"sv,
    "| touch pwned"sv,
    "< touch pwned"sv,
    "\nend\n"sv,
    "\n.\n"sv,
    "\ne\n"sv,
    "end"sv,
    "@GPVAL_PWD"sv,
    "$texts[1]"sv,
    "$data1 << end"sv,
    "{/Symbol a}"sv,
    "{/\"><script>x()</script> a}"sv,
    "^_{2}"sv,
    "#"sv,
    ";"sv,
    ","sv,
    "%s%n%d"sv,
    "</text><script>x()</script>"sv,
    "&lt;&#0;"sv,
    "]]>"sv,
    "-->"sv,
    "-e"sv,
    "--help"sv,
    "file:///etc/passwd"sv,
    "../../pwned"sv,
    " "sv,
    "\t"sv,
    "1e5"sv,
    "NaN"sv,
};

}  // namespace

std::vector<std::string> hostile_texts() {
  std::vector<std::string> texts{"", "PWN x\nsystem(\"touch pwned\")\n#"};
  for (const std::string_view piece : pieces) {
    texts.push_back(std::string(piece) + hostile_mark + std::string(piece));
  }
  // Appended: GCC 12 sees a copy out of bounds in the sum of such strings.
  texts.emplace_back(very_long, '\'').append(hostile_mark);
  texts.emplace_back(hostile_mark).append(very_long, '\n');
  return texts;
}

std::string hostile_text(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::string text;
  const std::uint64_t count = random() % 8;
  const std::uint64_t marked = count == 0 ? 0 : random() % count;
  for (std::uint64_t i = 0; i < count; ++i) {
    // One in eight is any byte at all.
    if (random() % 8 == 0) {
      text += static_cast<char>(random() % 256);
    } else {
      text += pieces[random() % std::size(pieces)];
    }
    if (i == marked) text += hostile_mark;
  }
  return text;
}

}  // namespace sheave::test
