#include "render/renderer.h"

#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "render/gl/frame_renderer.h"
#include "render/image_canvas.h"
#include "render/overlay.h"

namespace sheave::render {
namespace {

void check(Errors& errors, const char* name, double value, double low, double high) {
  if (value >= low && value <= high) return;
  const auto text = [](double x) {
    return x == std::floor(x) && std::abs(x) < 1e9 ? std::to_string(static_cast<long long>(x))
                                                   : std::to_string(x);
  };
  errors.push_back({std::string("/") + name, std::string("renderer: ") + name + " is " +
                                                 text(value) + "; it must lie between " +
                                                 text(low) + " and " + text(high)});
}

Errors check_settings(int width, int height, const RendererOptions& options) {
  Errors errors;
  check(errors, "supersample", options.supersample, 1, 4);
  const int factor = errors.empty() ? options.supersample : 1;
  const int most = Renderer::max_side / factor;  // in whole pixels
  check(errors, "width", width, Renderer::min_side, most);
  check(errors, "height", height, Renderer::min_side, most);
  if (options.samples != 1 && options.samples != 2 && options.samples != 4) {
    errors.push_back({"/samples", "renderer: samples is " + std::to_string(options.samples) +
                                      "; it must be 1, 2 or 4"});
  }
  if (options.shadow_side != 0) check(errors, "shadow_side", options.shadow_side, 64, 8192);
  check(errors, "line_width", options.line_width, 0.0, 10.0);
  return errors;
}

/// Decodes sRGB, because light adds up in linear colour and not in encoded values.
class LinearTable {
 public:
  LinearTable() {
    for (std::size_t i = 0; i < decode_.size(); ++i) {
      const double c = static_cast<double>(i) / 255.0;
      decode_[i] = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
    }
    for (std::size_t i = 0; i < encode_.size(); ++i) {
      const double c = static_cast<double>(i) / static_cast<double>(encode_.size() - 1);
      const double s = c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1.0 / 2.4) - 0.055;
      encode_[i] = static_cast<std::uint8_t>(std::lround(255.0 * s));
    }
  }
  [[nodiscard]] double decode(std::uint8_t value) const { return decode_[value]; }
  [[nodiscard]] std::uint8_t encode(double value) const {
    return encode_[static_cast<std::size_t>(
        std::lround(value * static_cast<double>(encode_.size() - 1)))];
  }

 private:
  std::array<double, 256> decode_{};
  std::array<std::uint8_t, 16384> encode_{};
};

/// Averages squares of factor x factor pixels.
Image shrink(const Image& large, int factor) {
  static const LinearTable table;
  Image small(large.width / factor, large.height / factor);
  for (int y = 0; y < small.height; ++y) {
    for (int x = 0; x < small.width; ++x) {
      std::array<double, 3> sum{};
      for (int dy = 0; dy < factor; ++dy) {
        for (int dx = 0; dx < factor; ++dx) {
          const std::uint8_t* from = large.pixel(x * factor + dx, y * factor + dy);
          for (std::size_t c = 0; c < 3; ++c) sum[c] += table.decode(from[c]);
        }
      }
      std::uint8_t* to = small.pixel(x, y);
      for (std::size_t c = 0; c < 3; ++c) to[c] = table.encode(sum[c] / (factor * factor));
    }
  }
  return small;
}

}  // namespace

struct Renderer::Content {
  int width = 0;
  int height = 0;
  RendererOptions options;
  // declared first, so that it outlives the objects made with it
  std::unique_ptr<GlContext> context;
  std::unique_ptr<FrameRenderer> frames;

  ~Content() {
    // GL objects can only be deleted in their own context.
    if (frames && context->make_current()) frames.reset();
  }
};

Renderer::Renderer(std::unique_ptr<Content> content) : content_(std::move(content)) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

Result<Renderer> Renderer::create(int width, int height, const RendererOptions& options) {
  if (Errors errors = check_settings(width, height, options); !errors.empty()) return errors;
  auto content = std::make_unique<Content>();
  content->width = width;
  content->height = height;
  content->options = options;
  Result<std::unique_ptr<GlContext>> context = make_osmesa_context();
  if (!context) return context.errors();
  content->context = std::move(context).value();
  FrameSettings settings;
  settings.width = width * options.supersample;
  settings.height = height * options.supersample;
  settings.samples = options.samples;
  settings.shadow_side = options.shadow_side;
  settings.line_width = options.line_width * options.supersample;
  auto frames = FrameRenderer::make(content->context->functions(), settings);
  if (!frames) return frames.errors();
  content->frames = std::move(frames).value();
  return Renderer(std::move(content));
}

int Renderer::width() const { return content_->width; }
int Renderer::height() const { return content_->height; }

Result<Image> Renderer::draw(const DrawList& list, const Camera& camera) {
  Errors errors = validate(list);
  for (Error& error : validate(camera)) errors.push_back(std::move(error));
  if (!errors.empty()) return errors;
  if (!content_->context->make_current()) {
    return Error{"", "the renderer's OpenGL context cannot be made current"};
  }
  Result<Image> image = content_->frames->draw(list, camera);
  if (!image) return image;
  if (content_->options.supersample > 1) {
    image = shrink(image.value(), content_->options.supersample);
  }
  if (content_->options.text) {
    ImageCanvas canvas(image.value());
    draw_overlay(list, camera, canvas);
  }
  return image;
}

}  // namespace sheave::render
