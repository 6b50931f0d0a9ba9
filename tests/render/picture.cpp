#include "tests/render/picture.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <sstream>

#include <png.h>

#include "render/png_writer.h"

namespace sheave::test {

using render::Image;

std::optional<Image> read_png(const std::string& path) {
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_file(&header, path.c_str()) == 0) return std::nullopt;
  header.format = PNG_FORMAT_RGB;
  Image image(static_cast<int>(header.width), static_cast<int>(header.height));
  if (png_image_finish_read(&header, nullptr, image.rgb.data(), 0, nullptr) == 0)
    return std::nullopt;
  return image;
}

std::string compare_with_golden(const Image& image, const std::string& name) {
  std::string golden = SHEAVE_SOURCE_DIR;
  golden.append("/tests/render/golden/").append(name).append(".png");
  const char* update = std::getenv("SHEAVE_UPDATE_GOLDEN");
  if (update != nullptr && std::string(update) == "1") {
    const Errors errors = render::write_png(golden, image);
    return errors.empty() ? "" : errors.front().message;
  }
  const std::optional<Image> expected = read_png(golden);
  if (!expected) return "cannot read " + golden;
  if (expected->width != image.width || expected->height != image.height) {
    return name + " has another size than its golden picture";
  }
  double sum = 0.0;
  int different = 0;
  for (std::size_t i = 0; i < image.rgb.size(); i += 3) {
    int largest = 0;
    for (std::size_t c = i; c < i + 3; ++c) {
      const int difference = std::abs(static_cast<int>(image.rgb[c]) - expected->rgb[c]);
      sum += difference;
      largest = std::max(largest, difference);
    }
    if (largest > 32) ++different;
  }
  const double mean = sum / static_cast<double>(image.rgb.size());
  const double share = 3.0 * different / static_cast<double>(image.rgb.size());
  if (mean <= 0.7 && share <= 0.01) return "";
  const auto kept = std::filesystem::temp_directory_path() / ("sheave_" + name + ".png");
  const bool written = render::write_png(kept.string(), image).empty();
  std::ostringstream text;
  text << name << " differs from its golden picture: mean " << mean << " (allowed 0.7), "
       << 100.0 * share << " % of the pixels by more than 32 (allowed 1 %)";
  if (written) text << "; the new picture is in " << kept.string();
  return text.str();
}

}  // namespace sheave::test
