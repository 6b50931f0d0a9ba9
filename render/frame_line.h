#pragma once
// Frames of a film, drawn on several threads and given back in order.
//
//   auto line = FrameLine::create(1280, 720, {.threads = 4});
//   for (...) {
//     while (line->full()) use(line->take());
//     line->put(list, camera);
//   }
//   while (!line->empty()) use(line->take());
//
// The pictures are those of one Renderer, to the byte, whatever the number of threads.

#include <memory>
#include <optional>
#include <vector>

#include "engine/result.h"
#include "render/draw_list.h"
#include "render/image.h"
#include "render/png_writer.h"
#include "render/renderer.h"

namespace sheave::render {

struct FrameLineOptions {
  RendererOptions picture{};
  int threads = 1;  ///< 1 to 1024; each has a renderer of its own
  /// Encodes frames as PNG, too; nothing: does not.
  std::optional<PngEffort> png{};
};

class FrameLine {
 public:
  struct Frame {
    Image image;
    std::vector<std::uint8_t> png;  ///< empty unless it was asked for
  };

  /// Fails if a size or option is out of range or there is no thread or GL context to be had.
  static Result<FrameLine> create(int width, int height, const FrameLineOptions& options);
  /// Waits for frames that are being drawn, and drops them.
  ~FrameLine();
  FrameLine(FrameLine&&) noexcept;
  FrameLine& operator=(FrameLine&&) noexcept;

  /// Begins a frame. Must not be called if the line is full: then take() one first.
  void put(DrawList list, const Camera& camera);
  /// Whether as many frames are under way as are kept: two for each thread, so that memory stays
  /// bounded.
  [[nodiscard]] bool full() const;
  [[nodiscard]] bool empty() const;
  /// Waits for the oldest frame; what is wrong with it if it cannot be drawn. What its thread threw
  /// (std::bad_alloc) is thrown here. Must not be called if the line is empty.
  [[nodiscard]] Result<Frame> take();

 private:
  struct Job;
  struct Content;
  explicit FrameLine(std::unique_ptr<Content> content);
  std::unique_ptr<Content> content_;
};

}  // namespace sheave::render
