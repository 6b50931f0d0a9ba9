#include "render/png_writer.h"

#include <csetjmp>
#include <cstddef>

#include <png.h>

#include "render/output_file.h"

namespace sheave::render {
namespace {

struct Sink {
  std::vector<std::uint8_t> bytes;
  std::string error;
};

void on_error(png_structp png, png_const_charp message) {
  static_cast<Sink*>(png_get_error_ptr(png))->error = message;
  png_longjmp(png, 1);
}

void on_warning(png_structp /*png*/, png_const_charp /*message*/) {}

void on_data(png_structp png, png_bytep data, png_size_t size) {
  auto& bytes = static_cast<Sink*>(png_get_io_ptr(png))->bytes;
  bytes.insert(bytes.end(), data, data + size);
}

/// libpng reports errors by longjmp, so no object in this frame may need a destructor.
bool encode(png_structp png, png_infop info, const Image& image, PngEffort effort) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  const bool fast = effort == PngEffort::sequence;
  png_set_compression_level(png, fast ? 1 : 6);
  // Without a filter, even rows of a background are runs of equal bytes: they compress faster and
  // smaller.
  png_set_filter(png, PNG_FILTER_TYPE_BASE, fast ? PNG_FILTER_NONE : PNG_ALL_FILTERS);
  png_set_IHDR(png, info, static_cast<png_uint_32>(image.width),
               static_cast<png_uint_32>(image.height), 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB(png, info, PNG_sRGB_INTENT_RELATIVE);
  png_write_info(png, info);
  for (int y = 0; y < image.height; ++y) png_write_row(png, image.pixel(0, y));
  png_write_end(png, info);
  return true;
}

}  // namespace

Result<std::vector<std::uint8_t>> encode_png(const Image& image, PngEffort effort) {
  const std::size_t expected = std::size_t{3} * static_cast<std::size_t>(image.width) *
                               static_cast<std::size_t>(image.height);
  if (image.width <= 0 || image.height <= 0 || image.rgb.size() != expected) {
    return Error{
        "",
        "image of " + std::to_string(image.width) + " x " + std::to_string(image.height) +
            " pixels with " + std::to_string(image.rgb.size()) +
            " bytes cannot be written as PNG; it needs at least one pixel and 3 bytes for each"};
  }
  Sink sink;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &sink, on_error, on_warning);
  png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
  bool done = false;
  if (info != nullptr) {
    png_set_write_fn(png, &sink, on_data, nullptr);
    done = encode(png, info, image, effort);
  }
  if (png != nullptr) png_destroy_write_struct(&png, &info);
  if (!done) return Error{"", "libpng cannot encode the image: " + sink.error};
  return std::move(sink.bytes);
}

Errors write_png(const std::string& path, const Image& image, PngEffort effort) {
  const Result<std::vector<std::uint8_t>> bytes = encode_png(image, effort);
  if (!bytes) return bytes.errors();
  // A sequence does not wait for the disk: the wait after each frame would take longer than drawing
  // the frame.
  const bool kept = effort == PngEffort::still;
  return write_file(path, bytes.value(), kept ? Durability::power_loss : Durability::process);
}

}  // namespace sheave::render
