// What the file says; how it looks is docs/how-to/pictures.md's.

#include "view/svg_canvas.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "render/font.h"
#include "view/recording_pack.h"

namespace sheave::view {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr render::Color blue = render::rgb(0x0000ff);

TEST(SvgCanvas, ContainsThePictureAndItsOverlay) {
  SvgCanvas canvas(320, 200);
  canvas.fill(1.0, 2.0, 3.0, 4.0, blue);
  canvas.line(5.0, 6.0, 7.0, 8.0, 1.5, blue, 0.5);
  const std::string text = canvas.document("bytes", "A title");
  EXPECT_THAT(text, HasSubstr(R"(width="320" height="200" viewBox="0 0 320 200")"));
  EXPECT_THAT(text, HasSubstr("<title>A title</title>"));
  EXPECT_THAT(text, HasSubstr("data:image/png;base64," + base64("bytes")));
  EXPECT_THAT(text,
              HasSubstr(R"(<rect x="1.00" y="2.00" width="3.00" height="4.00" fill="#0000ff")"));
  EXPECT_THAT(text, HasSubstr(R"(x1="5.00" y1="6.00" x2="7.00" y2="8.00" stroke="#0000ff")"));
  EXPECT_THAT(text, HasSubstr(R"(stroke-opacity="0.5")"));
  // The picture is below what is drawn.
  EXPECT_LT(text.find("<image"), text.find("<rect"));
}

TEST(SvgCanvas, TextsAreAsWideAsInAPicture) {
  SvgCanvas canvas(320, 200);
  canvas.text(10.0, 20.0, "12.5 kN", 20.0, blue, 1.0);
  canvas.text(10.0, 40.0, "", 20.0, blue, 1.0);
  const std::string text = canvas.document("", "");
  const double width = render::Font::builtin().measure("12.5 kN", 20.0).width;
  const std::size_t place = text.find("textLength=\"");
  ASSERT_NE(place, std::string::npos);
  EXPECT_NEAR(std::stod(text.substr(place + 12)), width, 0.005);  // two decimals
  EXPECT_THAT(text, HasSubstr(">12.5 kN</text>"));
  EXPECT_EQ(text.find("textLength", place + 1), std::string::npos);
}

TEST(SvgCanvas, NamesCannotBreakTheFile) {
  SvgCanvas canvas(320, 200);
  canvas.text(0.0, 9.0, "a<b>&\"c\"\x01\xff\xEF\xBF\xBF", 9.0, blue, 0.0);
  const std::string text = canvas.document("", "</title><script>");
  EXPECT_THAT(text,
              HasSubstr("a&lt;b&gt;&amp;&quot;c&quot;\xEF\xBF\xBD\xEF\xBF\xBD\xEF\xBF\xBD</text>"));
  EXPECT_THAT(text, Not(HasSubstr("<script>")));
}

}  // namespace
}  // namespace sheave::view
