// The colours of loads: fixed to names, and told apart by all kinds of eyes.
#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "render/body_view.h"
#include "render/color_map.h"

namespace sheave::render {
namespace {

using Triple = std::array<double, 3>;

Triple linear(const Color& color) {
  const auto decode = [](double c) {
    return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
  };
  return {decode(static_cast<double>(color.r)), decode(static_cast<double>(color.g)),
          decode(static_cast<double>(color.b))};
}

/// CIE L*a*b* for the white of sRGB.
Triple lab(const Triple& c) {
  const double x = (0.4124 * c[0] + 0.3576 * c[1] + 0.1805 * c[2]) / 0.9505;
  const double y = 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
  const double z = (0.0193 * c[0] + 0.1192 * c[1] + 0.9505 * c[2]) / 1.089;
  const auto f = [](double t) { return t > 0.008856 ? std::cbrt(t) : 7.787 * t + 16.0 / 116.0; };
  return {116.0 * f(y) - 16.0, 500.0 * (f(x) - f(y)), 200.0 * (f(y) - f(z))};
}

/// What eyes without red or green cones see, of linear colours (Vienot, Brettel and Mollon, 1999).
Triple without_red(const Triple& c) {
  const double same = 0.11238 * c[0] + 0.88762 * c[1];
  return {same, same, 0.00401 * c[0] - 0.00401 * c[1] + c[2]};
}
Triple without_green(const Triple& c) {
  const double same = 0.29275 * c[0] + 0.70725 * c[1];
  return {same, same, -0.02234 * c[0] + 0.02234 * c[1] + c[2]};
}

double difference(const Triple& a, const Triple& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

TEST(LoadColor, AreDistinctForAllKindsOfColorVision) {
  // A difference of 2.3 is just noticeable side by side; five times that is plain.
  constexpr double plain = 11.5;
  for (std::size_t i = 0; i < load_colors.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const Triple a = linear(load_colors[i]);
      const Triple b = linear(load_colors[k]);
      EXPECT_GT(difference(lab(a), lab(b)), plain) << i << " and " << k;
      EXPECT_GT(difference(lab(without_red(a)), lab(without_red(b))), plain) << i << " and " << k;
      EXPECT_GT(difference(lab(without_green(a)), lab(without_green(b))), plain)
          << i << " and " << k;
    }
  }
}

TEST(LoadColor, NumberedNamesDiffer) {
  std::set<std::array<float, 3>> seen;
  for (char digit = '0'; digit < '8'; ++digit) {
    const Color color = load_color(std::string("weight ") + digit);
    seen.insert({color.r, color.g, color.b});
  }
  EXPECT_EQ(seen.size(), load_colors.size());
  // By hand: FNV-1a of no bytes is 2166136261, which is 5 more than a multiple of 8.
  EXPECT_EQ(load_color(""), load_colors[5]);
}

TEST(LoadColor, OfPairsIsOne) {
  EXPECT_EQ(load_color("left load"), load_color("right load"));
  EXPECT_EQ(load_color("left-front leg"), load_color("right-rear leg"));
  EXPECT_EQ(load_color("jib left top"), load_color("jib right bottom"));
  // A part of a word is no side, and other words count.
  EXPECT_NE(load_color("leftover"), load_color("rightover"));
  EXPECT_NE(load_color("left load"), load_color("left wheel"));
}

}  // namespace
}  // namespace sheave::render
