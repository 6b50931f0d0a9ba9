#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "scenes/json/pretty.h"

namespace sheave::json {
namespace {

using Value = nlohmann::ordered_json;

TEST(JsonPretty, PutsShortThingsOnOneLineAndObjectsOfAListOnTheirOwn) {
  const Value value{{"b", 1}, {"a", {1.5, 2.0}}, {"list", Value::array({{{"x", 1}}, {{"x", 2}}})}};
  EXPECT_EQ(pretty(value),
            "{\n  \"b\": 1,\n  \"a\": [1.5, 2],\n  \"list\": [\n    {\"x\": 1},\n    {\"x\": 2}\n"
            "  ]\n}\n");
}

TEST(JsonPretty, NoLineIsLongerThanAHundredUnlessItCannotBeSplit) {
  Value value = Value::object();
  for (int i = 0; i < 100; ++i) {
    value["key" + std::to_string(i)] = std::vector<double>(static_cast<std::size_t>(i), 1.0 / 3.0);
  }
  std::istringstream text(pretty(value));
  for (std::string line; std::getline(text, line);) EXPECT_LE(line.size(), 100U);
  EXPECT_EQ(Value::parse(pretty(value)), value);
}

TEST(JsonPretty, NumbersReadBackBitForBit) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 20'000; ++i) {
    const auto number = std::bit_cast<double>(random());
    if (!std::isfinite(number)) continue;
    const std::string text = pretty(Value(number));
    EXPECT_EQ(std::bit_cast<std::uint64_t>(Value::parse(text).get<double>()),
              std::bit_cast<std::uint64_t>(number))
        << text;
  }
  EXPECT_EQ(pretty(Value(-0.0)), "-0.0\n");
  EXPECT_EQ(pretty(Value(0.1)), "0.1\n");
  EXPECT_EQ(pretty(Value(std::nan(""))), "null\n");
}

TEST(JsonPretty, EscapesStrings) {
  EXPECT_EQ(pretty(Value("a\"\n\xC3\xA4")), "\"a\\\"\\n\xC3\xA4\"\n");
}

}  // namespace
}  // namespace sheave::json
