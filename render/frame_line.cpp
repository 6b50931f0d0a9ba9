#include "render/frame_line.h"

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <new>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

namespace sheave::render {
/// A frame that has been ordered and not yet delivered.
struct FrameLine::Job {
  DrawList list;
  Camera camera;
  bool begun = false;
  bool done = false;
  std::optional<Result<Frame>> frame;
  std::exception_ptr thrown;

  void draw(Renderer& renderer, const std::optional<PngEffort>& effort) {
    Result<Image> image = renderer.draw(list, camera);
    if (!image) {
      frame.emplace(image.errors());
      return;
    }
    Frame made{std::move(image).value(), {}};
    if (effort) {
      auto bytes = encode_png(made.image, *effort);
      if (!bytes) {
        frame.emplace(bytes.errors());
        return;
      }
      made.png = std::move(bytes).value();
    }
    frame.emplace(std::move(made));
  }
};

struct FrameLine::Content {
  int width = 0;
  int height = 0;
  FrameLineOptions options;
  std::size_t most = 0;  // largest number of frames under way
  std::mutex mutex;      // protects all members below
  std::condition_variable changed;
  std::deque<std::unique_ptr<Job>> jobs;  // oldest first
  std::size_t ready = 0;  // number of threads that have a renderer or have failed to make one
  Errors faults;          // reasons why a renderer could not be made
  bool ending = false;
  std::vector<std::thread> threads;

  Content() = default;
  Content(const Content&) = delete;
  Content& operator=(const Content&) = delete;
  ~Content() {
    {
      const std::lock_guard lock(mutex);
      ending = true;
    }
    changed.notify_all();
    for (std::thread& thread : threads) thread.join();
  }

  /// The oldest frame that no thread draws yet, or null.
  [[nodiscard]] Job* next() const {
    const auto found = std::find_if(jobs.begin(), jobs.end(),
                                    [](const std::unique_ptr<Job>& job) { return !job->begun; });
    return found == jobs.end() ? nullptr : found->get();
  }

  [[nodiscard]] Result<Renderer> make_renderer() const {
    try {
      return Renderer::create(width, height, options.picture);
    } catch (const std::bad_alloc&) {
      return Error{"", "frame line: there is no memory for another renderer"};
    }
  }

  /// Waits until each started thread has a renderer or has failed to make one; returns the faults.
  [[nodiscard]] Errors wait_for_renderers() {
    std::unique_lock lock(mutex);
    changed.wait(lock, [&] { return ready == threads.size(); });
    return faults;
  }

  /// Body of a thread. A GL context belongs to the thread that uses it, so the thread itself makes
  /// and destroys its renderer.
  void work() {
    Result<Renderer> renderer = make_renderer();
    std::unique_lock lock(mutex);
    ++ready;
    if (!renderer) faults = renderer.errors();
    changed.notify_all();
    if (!renderer) return;
    for (;;) {
      changed.wait(lock, [&] { return ending || next() != nullptr; });
      if (ending) return;
      Job& job = *next();
      job.begun = true;
      lock.unlock();
      try {
        job.draw(*renderer, options.png);
      } catch (...) {
        job.thrown = std::current_exception();
      }
      lock.lock();
      job.done = true;
      changed.notify_all();
    }
  }
};

FrameLine::FrameLine(std::unique_ptr<Content> content) : content_(std::move(content)) {}
FrameLine::~FrameLine() = default;
FrameLine::FrameLine(FrameLine&&) noexcept = default;
FrameLine& FrameLine::operator=(FrameLine&&) noexcept = default;

Result<FrameLine> FrameLine::create(int width, int height, const FrameLineOptions& options) {
  if (options.threads < 1 || options.threads > 1024) {
    return Error{"/threads", "frame line: threads is " + std::to_string(options.threads) +
                                 "; it must lie between 1 and 1024"};
  }
  auto content = std::make_unique<Content>();
  content->width = width;
  content->height = height;
  content->options = options;
  content->most = 2 * static_cast<std::size_t>(options.threads);
  for (int i = 0; i < options.threads; ++i) {
    try {
      content->threads.emplace_back([&line = *content] { line.work(); });
    } catch (const std::system_error& error) {
      // Fewer threads suffice.
      if (!content->threads.empty()) break;
      return Error{"", std::string("no thread can be started to draw frames: ") + error.what() +
                           "; allow this user more processes (ulimit -u)"};
    }
    if (Errors faults = content->wait_for_renderers(); !faults.empty()) return faults;
  }
  return FrameLine(std::move(content));
}

void FrameLine::put(DrawList list, const Camera& camera) {
  auto job = std::make_unique<Job>();
  job->list = std::move(list);
  job->camera = camera;
  {
    const std::lock_guard lock(content_->mutex);
    content_->jobs.push_back(std::move(job));
  }
  content_->changed.notify_all();
}

bool FrameLine::full() const {
  const std::lock_guard lock(content_->mutex);
  return content_->jobs.size() >= content_->most;
}

bool FrameLine::empty() const {
  const std::lock_guard lock(content_->mutex);
  return content_->jobs.empty();
}

Result<FrameLine::Frame> FrameLine::take() {
  std::unique_lock lock(content_->mutex);
  content_->changed.wait(lock, [&] { return content_->jobs.front()->done; });
  const std::unique_ptr<Job> job = std::move(content_->jobs.front());
  content_->jobs.pop_front();
  lock.unlock();
  if (job->thrown) std::rethrow_exception(job->thrown);
  return std::move(*job->frame);
}

}  // namespace sheave::render
