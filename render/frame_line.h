#pragma once
// Frames of a film, drawn on several threads and returned in order.
//
//   auto line = FrameLine::create(1280, 720, {.threads = 4});
//   for (...) {
//     while (line->full()) use(line->take());
//     line->put(list, camera);
//   }
//   while (!line->empty()) use(line->take());
//
// The pictures equal those of one Renderer, to the byte, for any number of threads.

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
  int threads = 1;  ///< 1 to 1024; each has its own renderer
  /// Also encodes frames as PNG; nothing: no encoding.
  std::optional<PngEffort> png{};
};

class FrameLine {
 public:
  struct Frame {
    Image image;
    std::vector<std::uint8_t> png;  ///< empty unless requested
  };

  /// Fails if a size or option is out of range, or if no thread or GL context can be created.
  static Result<FrameLine> create(int width, int height, const FrameLineOptions& options);
  /// Waits for the frames being drawn and drops them.
  ~FrameLine();
  FrameLine(FrameLine&&) noexcept;
  FrameLine& operator=(FrameLine&&) noexcept;

  /// Begins a frame. The line must not be full; call take() first.
  void put(DrawList list, const Camera& camera);
  /// Whether the largest number of frames is under way: two per thread, so that memory is bounded.
  [[nodiscard]] bool full() const;
  [[nodiscard]] bool empty() const;
  /// Waits for the oldest frame; an error if it cannot be drawn. Rethrows exceptions of its thread
  /// (std::bad_alloc). The line must not be empty.
  [[nodiscard]] Result<Frame> take();

 private:
  struct Job;
  struct Content;
  explicit FrameLine(std::unique_ptr<Content> content);
  std::unique_ptr<Content> content_;
};

}  // namespace sheave::render
