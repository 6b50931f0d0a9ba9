#include "view/svg_canvas.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "render/font.h"
#include "view/recording_pack.h"

namespace sheave::view {
namespace {

/// Height of DejaVu Sans from ascent to descent, relative to the em.
constexpr double face_height = 1.164;
constexpr std::string_view replacement = "\xEF\xBF\xBD";  // U+FFFD

std::string hex(const render::Color& color) {
  const auto byte = [](float value) {
    return static_cast<int>(std::lround(255.0 * std::clamp(static_cast<double>(value), 0.0, 1.0)));
  };
  return fmt::format("#{:02x}{:02x}{:02x}", byte(color.r), byte(color.g), byte(color.b));
}

/// `text` with everything replaced that is invalid UTF-8 or not allowed in XML, except control
/// characters.
std::string valid_text(std::string_view text) {
  using Json = nlohmann::json;
  const std::string quoted =
      Json(std::string(text)).dump(-1, ' ', false, Json::error_handler_t::replace);
  std::string valid = Json::parse(quoted).get<std::string>();
  // U+FFFE and U+FFFF are valid UTF-8, but XML does not allow them.
  for (const std::string_view stranger : {"\xEF\xBF\xBE", "\xEF\xBF\xBF"}) {
    for (std::size_t at = 0; (at = valid.find(stranger, at)) != std::string::npos;) {
      valid.replace(at, stranger.size(), replacement);
    }
  }
  return valid;
}

std::string escaped(std::string_view text) {
  std::string safe;
  for (const char c : valid_text(text)) {
    switch (c) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '"':
        safe += "&quot;";
        break;
      default:
        if (static_cast<unsigned char>(c) < 0x20) {
          safe += replacement;
        } else {
          safe += c;
        }
    }
  }
  return safe;
}

}  // namespace

void SvgCanvas::fill(double x, double y, double w, double h, const render::Color& color,
                     double alpha) {
  elements_ += fmt::format(
      "<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" fill=\"{}\" "
      "fill-opacity=\"{:.3g}\"/>\n",
      x, y, w, h, hex(color), alpha);
}

void SvgCanvas::line(double x0, double y0, double x1, double y1, double width,
                     const render::Color& color, double alpha) {
  elements_ += fmt::format(
      "<line x1=\"{:.2f}\" y1=\"{:.2f}\" x2=\"{:.2f}\" y2=\"{:.2f}\" stroke=\"{}\" "
      "stroke-width=\"{:.2f}\" stroke-opacity=\"{:.3g}\" stroke-linecap=\"round\"/>\n",
      x0, y0, x1, y1, hex(color), width, alpha);
}

void SvgCanvas::text(double x, double y, std::string_view text, double pixels,
                     const render::Color& color, double halo) {
  if (text.empty()) return;
  elements_ += fmt::format(
      "<text x=\"{:.2f}\" y=\"{:.2f}\" font-size=\"{:.2f}\" textLength=\"{:.2f}\" "
      "lengthAdjust=\"spacingAndGlyphs\" fill=\"{}\" stroke-width=\"{:.2f}\">{}</text>\n",
      x, y, pixels / face_height, render::Font::builtin().measure(text, pixels).width, hex(color),
      2.0 * halo, escaped(text));
}

std::string SvgCanvas::document(const std::string& png, const std::string& title) const {
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" "
      "viewBox=\"0 0 {0} {1}\">\n"
      "<title>{2}</title>\n"
      "<image width=\"{0}\" height=\"{1}\" href=\"data:image/png;base64,{3}\"/>\n"
      "<style>text {{ font-family: 'DejaVu Sans', Verdana, sans-serif; stroke: #ffffff; "
      "stroke-opacity: 0.85; stroke-linejoin: round; paint-order: stroke }}</style>\n"
      "{4}</svg>\n",
      width_, height_, escaped(title), base64(png), elements_);
}

}  // namespace sheave::view
