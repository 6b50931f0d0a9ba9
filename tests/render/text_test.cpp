// Numbers, colours and the places of labels.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "render/color_map.h"
#include "render/font.h"
#include "render/label_layout.h"
#include "render/number_text.h"

namespace sheave::render {
namespace {

TEST(NumberText, WritesFixedDigitsWithoutNegativeZero) {
  EXPECT_EQ(fixed_text(20.0, 1), "20.0");
  EXPECT_EQ(fixed_text(-0.04, 1), "0.0");
  EXPECT_EQ(fixed_text(-0.06, 1), "-0.1");
  EXPECT_EQ(fixed_text(-0.0, 0), "0");
  EXPECT_EQ(fixed_text(1e300, 0).size(), 301U);
  EXPECT_EQ(fixed_text(std::numeric_limits<double>::quiet_NaN(), 1), "nan");
}

TEST(NumberText, KeepsThreeDigitsOfTheReference) {
  EXPECT_EQ(quantity_text(20.0, 20.0, "N"), "20.0 N");
  EXPECT_EQ(quantity_text(9.81, 9.81, "N"), "9.81 N");
  EXPECT_EQ(quantity_text(5.0, 150.0, "N"), "5 N");
  EXPECT_EQ(quantity_text(12345.0, 20000.0, "N"), "12.3 kN");
  EXPECT_EQ(quantity_text(0.0123, 0.02, "N"), "12.3 mN");
  EXPECT_EQ(quantity_text(0.0, 0.0, "N"), "0.00 N");
}

TEST(NumberText, TicksAreRoundAndInside) {
  const Ticks ticks = round_ticks(0.0, 20.0, 5);
  EXPECT_EQ(ticks.values, (std::vector<double>{0.0, 5.0, 10.0, 15.0, 20.0}));
  EXPECT_EQ(ticks.decimals, 0);
  for (const double high : {1e-9, 0.3, 7.7, 15.0, 60.0, 80.0, 123.0, 4e12}) {
    const Ticks t = round_ticks(0.0, high, 5);
    EXPECT_GE(t.values.size(), 3U) << high;
    EXPECT_LE(t.values.size(), 9U) << high;
    for (const double v : t.values) EXPECT_LE(v, high * (1.0 + 1e-5));
  }
  EXPECT_EQ(round_ticks(0.0, 1.0, 5).decimals, 1);
}

TEST(NumberText, RoundsDownToOneTwoFive) {
  EXPECT_DOUBLE_EQ(round_down(0.3), 0.2);
  EXPECT_DOUBLE_EQ(round_down(0.2), 0.2);
  EXPECT_DOUBLE_EQ(round_down(7.0), 5.0);
  EXPECT_DOUBLE_EQ(round_down(1000.0), 1000.0);
}

/// CIE lightness, 0 black to 100 white.
double lightness(const Color& c) {
  const auto decode = [](double x) {
    return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
  };
  const double y = 0.2126 * decode(static_cast<double>(c.r)) +
                   0.7152 * decode(static_cast<double>(c.g)) +
                   0.0722 * decode(static_cast<double>(c.b));
  return y > 0.008856 ? 116.0 * std::cbrt(y) - 16.0 : 903.3 * y;
}

TEST(ColorMap, GetsEvenlyLighterAndStaysVisibleOnWhite) {
  double previous = lightness(sample(ColorMap::tension, 0.0));
  const double rise = (lightness(sample(ColorMap::tension, 1.0)) - previous) / 20.0;
  for (int k = 1; k <= 20; ++k) {
    const double now = lightness(sample(ColorMap::tension, k / 20.0));
    EXPECT_GT(now - previous, 0.4 * rise);
    EXPECT_LT(now - previous, 1.7 * rise);
    previous = now;
  }
  EXPECT_LT(previous, 75.0);
}

TEST(ColorMap, ClampsAndTakesNan) {
  EXPECT_EQ(sample(ColorMap::tension, -1.0), sample(ColorMap::tension, 0.0));
  EXPECT_EQ(sample(ColorMap::tension, 2.0), sample(ColorMap::tension, 1.0));
  EXPECT_EQ(sample(ColorMap::gray, std::nan("")), sample(ColorMap::gray, 0.0));
}

TEST(Font, MeasuresTheWidthThatItDraws) {
  const Font& font = Font::builtin();
  const TextSize one = font.measure("8", 20.0);
  const TextSize two = font.measure("88", 20.0);
  EXPECT_NEAR(two.width, 2.0 * one.width, 1e-6);
  const TextMask mask = font.draw("88", 20.0, 3);
  EXPECT_GE(mask.width, static_cast<int>(two.width) + 6);
  int inked = 0;
  for (const std::uint8_t c : mask.coverage) inked += c > 128 ? 1 : 0;
  EXPECT_GT(inked, 40);
  // Nothing touches the border that a halo needs.
  for (int x = 0; x < mask.width; ++x) EXPECT_EQ(mask.coverage[static_cast<std::size_t>(x)], 0);
}

TEST(Font, TakesAnyBytes) {
  const Font& font = Font::builtin();
  for (const char* text :
       {"", "\xff\xfe", "\xc3", "\xe2\x82", "\xf0\x9f\x98\x80", "T\u2080 = \u00b5N"}) {
    EXPECT_GE(font.measure(text, 15.0).width, 0.0);
    const TextMask mask = font.draw(text, 15.0, 2);
    EXPECT_EQ(mask.coverage.size(), static_cast<std::size_t>(mask.width * mask.height));
  }
}

LabelSurroundings around(double width, double height) {
  LabelSurroundings s;
  s.width = width;
  s.height = height;
  return s;
}

TEST(LabelLayout, StandsOffInThePreferredDirection) {
  const std::vector<LabelRequest> one{
      {.x = 200, .y = 100, .direction_x = 1, .width = 40, .height = 12}};
  const LabelPlace place = place_labels(one, around(400, 200)).front();
  EXPECT_NEAR(place.text.x, 208.0, 1e-9);
  EXPECT_NEAR(place.text.y + 6.0, 100.0, 1e-9);
}

TEST(LabelLayout, KeepsLabelsApartAndInside) {
  // Twelve labels on a spot where one fits, and one in a corner.
  std::vector<LabelRequest> labels(
      12, LabelRequest{.x = 200, .y = 100, .direction_x = 1, .width = 40, .height = 12});
  labels.push_back({.x = 399, .y = 1, .direction_x = 1, .width = 40, .height = 12});
  const std::vector<LabelPlace> places = place_labels(labels, around(400, 200));
  ASSERT_EQ(places.size(), labels.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      EXPECT_EQ(overlap(places[i].text, places[k].text), 0.0) << i << " and " << k;
    }
    EXPECT_NEAR(overlap(places[i].text, {0, 0, 400, 200}), 40.0 * 12.0, 1e-6);
  }
}

TEST(LabelLayout, AvoidsTextAndLinesAndSlides) {
  const std::vector<Rectangle> taken{{205, 60, 60, 80}};
  const std::vector<ScreenSegment> lines{{180, 0, 180, 200}};
  LabelSurroundings s = around(400, 200);
  s.occupied = taken;
  s.lines = lines;
  std::vector<LabelRequest> labels{
      {.x = 200, .y = 100, .direction_x = 1, .width = 40, .height = 12}};
  LabelPlace place = place_labels(labels, s).front();
  EXPECT_EQ(overlap(place.text, taken[0]), 0.0);
  EXPECT_FALSE(place.text.x < 180.0 && place.text.x + 40.0 > 180.0);
  // An anchor that may slide along its cable finds room beside the obstacle.
  labels[0].slide_y = 60.0;
  place = place_labels(labels, s).front();
  EXPECT_NE(place.anchor_y, 100.0);
  EXPECT_EQ(overlap(place.text, taken[0]), 0.0);
}

TEST(LabelLayout, LabelsOfCrowdedCablesStandOnNone) {
  // The parts of a tackle, closer together than a label is wide with its gaps.
  std::vector<ScreenSegment> lines;
  std::vector<LabelRequest> labels;
  for (int k = 0; k < 5; ++k) {
    const double x = 200.0 + 30.0 * k;
    lines.push_back({x, 20, x, 280});
    labels.push_back(
        {.x = x, .y = 150, .direction_x = 1, .slide_y = 90, .width = 45, .height = 16});
  }
  LabelSurroundings s = around(500, 300);
  s.gap = 13.0;
  s.lines = lines;
  const std::vector<LabelPlace> places = place_labels(labels, s);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Rectangle& r = places[i].text;
    EXPECT_FALSE(places[i].covers);
    for (const ScreenSegment& line : lines) {
      const bool beside = line[0] <= r.x || line[0] >= r.x + r.width;
      const bool beyond = r.y + r.height <= line[1] || r.y >= line[3];
      EXPECT_TRUE(beside || beyond) << "label " << i;
    }
    for (std::size_t k = 0; k < i; ++k) EXPECT_EQ(overlap(r, places[k].text), 0.0);
  }
}

TEST(LabelLayout, ReportsLabelsWithoutAFreePlace) {
  const std::vector<Rectangle> bodies{{0, 0, 400, 200}};
  LabelSurroundings s = around(400, 200);
  s.bodies = bodies;
  const std::vector<LabelRequest> one{
      {.x = 200, .y = 100, .direction_x = 1, .width = 40, .height = 12}};
  EXPECT_TRUE(place_labels(one, s).front().covers);
  s.bodies = {};
  EXPECT_FALSE(place_labels(one, s).front().covers);
}

}  // namespace
}  // namespace sheave::render
