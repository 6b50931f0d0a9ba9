#include "render/font.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <stb/stb_truetype.h>

#include "embedded_font.h"

namespace sheave::render {
namespace {

/// The next code point of a UTF-8 text; advances `at`. Malformed input gives U+FFFD.
int next_code_point(std::string_view text, std::size_t& at) {
  constexpr int replacement = 0xFFFD;
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned first = byte(at++);
  if (first < 0x80U) return static_cast<int>(first);
  const int more = first >= 0xF8U   ? 0
                   : first >= 0xF0U ? 3
                   : first >= 0xE0U ? 2
                   : first >= 0xC0U ? 1
                                    : 0;
  if (more == 0) return replacement;
  unsigned code = first & (0x3FU >> static_cast<unsigned>(more));
  for (int k = 0; k < more; ++k) {
    if (at >= text.size() || (byte(at) & 0xC0U) != 0x80U) return replacement;
    code = (code << 6U) | (byte(at++) & 0x3FU);
  }
  return static_cast<int>(code);
}

/// Adds one glyph with its pen at column `pen`, at its exact fraction of a pixel.
void stamp(const stbtt_fontinfo& info, int glyph, float scale, double pen, TextMask& mask) {
  const auto shift = static_cast<float>(pen - std::floor(pen));
  int x0 = 0;
  int y0 = 0;
  int x1 = 0;
  int y1 = 0;
  stbtt_GetGlyphBitmapBoxSubpixel(&info, glyph, scale, scale, shift, 0.0F, &x0, &y0, &x1, &y1);
  const int w = x1 - x0;
  const int h = y1 - y0;
  if (w <= 0 || h <= 0) return;
  std::vector<std::uint8_t> pixels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h));
  stbtt_MakeGlyphBitmapSubpixel(&info, pixels.data(), w, h, w, scale, scale, shift, 0.0F, glyph);
  const int left = static_cast<int>(std::floor(pen)) + x0;
  const int top = mask.baseline + y0;
  for (int y = std::max(0, -top); y < std::min(h, mask.height - top); ++y) {
    for (int x = std::max(0, -left); x < std::min(w, mask.width - left); ++x) {
      std::uint8_t& to = mask.coverage[static_cast<std::size_t>((top + y) * mask.width + left + x)];
      to = std::max(to, pixels[static_cast<std::size_t>(y * w + x)]);
    }
  }
}

}  // namespace

struct Font::Face {
  stbtt_fontinfo info{};
};

Font::Font() : face_(std::make_unique<Face>()) {
  stbtt_InitFont(&face_->info, embedded_font, stbtt_GetFontOffsetForIndex(embedded_font, 0));
}

Font::~Font() = default;

const Font& Font::builtin() {
  static const Font font;
  return font;
}

TextSize Font::measure(std::string_view text, double pixels) const {
  const stbtt_fontinfo* info = &face_->info;
  const double scale =
      static_cast<double>(stbtt_ScaleForPixelHeight(info, static_cast<float>(pixels)));
  int ascent = 0;
  int descent = 0;
  stbtt_GetFontVMetrics(info, &ascent, &descent, nullptr);
  double pen = 0.0;
  int previous = 0;
  for (std::size_t at = 0; at < text.size();) {
    const int glyph = stbtt_FindGlyphIndex(info, next_code_point(text, at));
    int advance = 0;
    stbtt_GetGlyphHMetrics(info, glyph, &advance, nullptr);
    if (previous != 0) pen += scale * stbtt_GetGlyphKernAdvance(info, previous, glyph);
    pen += scale * advance;
    previous = glyph;
  }
  return {pen, scale * ascent, -scale * descent};
}

TextMask Font::draw(std::string_view text, double pixels, int border) const {
  const stbtt_fontinfo* info = &face_->info;
  const float scale = stbtt_ScaleForPixelHeight(info, static_cast<float>(pixels));
  const TextSize size = measure(text, pixels);
  TextMask mask;
  mask.left = border + 1;  // room for glyphs that reach left of the pen
  mask.baseline = border + static_cast<int>(std::ceil(size.ascent));
  mask.width = static_cast<int>(std::ceil(size.width)) + 2 * border + 2;
  mask.height = mask.baseline + static_cast<int>(std::ceil(size.descent)) + border;
  mask.coverage.resize(static_cast<std::size_t>(mask.width) *
                       static_cast<std::size_t>(mask.height));
  double pen = mask.left;
  int previous = 0;
  for (std::size_t at = 0; at < text.size();) {
    const int glyph = stbtt_FindGlyphIndex(info, next_code_point(text, at));
    if (previous != 0) {
      pen += static_cast<double>(scale) * stbtt_GetGlyphKernAdvance(info, previous, glyph);
    }
    stamp(*info, glyph, scale, pen, mask);
    int advance = 0;
    stbtt_GetGlyphHMetrics(info, glyph, &advance, nullptr);
    pen += static_cast<double>(scale) * advance;
    previous = glyph;
  }
  return mask;
}

}  // namespace sheave::render
