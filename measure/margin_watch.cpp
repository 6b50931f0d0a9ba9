#include "measure/margin_watch.h"

#include <algorithm>

namespace sheave::measure {
namespace {

void take(const LeastMargin& found, std::optional<LeastMargin>& least) {
  if (!least || found.margin < least->margin) least = found;
}

/// The least value of the parabola through three samples in the order of time, of which the middle one is
/// the least.
LeastMargin least_of(const LeastMargin& a, const LeastMargin& b, const LeastMargin& c) {
  const double first = (b.margin - a.margin) / (b.time - a.time);
  const double second = (c.margin - b.margin) / (c.time - b.time);
  const double curvature = (second - first) / (c.time - a.time);
  if (!(curvature > 0.0)) return b;
  // Slope at b.
  const double slope = first + curvature * (b.time - a.time);
  const double at = std::clamp(b.time - 0.5 * slope / curvature, a.time, c.time);
  const double away = at - b.time;
  return {std::max(0.0, b.margin + away * (slope + away * curvature)), at};
}

}  // namespace

void MarginWatch::observe(const Simulation& run, BranchReader& reader) {
  // Before the first substep there are no forces.
  if (!run.world.last_substep()) return;
  const double time = run.world.state().time;
  while (!pending_.empty() && pending_.back().time > time) pending_.pop_back();
  const double last = pending_.empty() ? time_ : pending_.back().time;
  if (!(time > last)) return;
  pending_.push_back({time, {}});
  reader.read(run, pending_.back().margins);
}

void MarginWatch::end_step() {
  for (const Sample& sample : pending_) {
    for (const BranchMargin& margin : sample.margins) {
      add(margin, sample.time, time_, courses_[margin.key]);
    }
    time_ = sample.time;
  }
  pending_.clear();
}

void MarginWatch::add(const BranchMargin& margin, double time, double before, Course& course) {
  const auto branch = static_cast<std::size_t>(margin.second_branch);
  // Bodies that were out of reach have been apart.
  const bool gone = course.begun && course.seen < before;
  if (course.begun && margin.second_branch != course.second && !course.record.first_change) {
    course.record.first_change = time;
  }
  const bool continues = course.begun && !gone && margin.second_branch == course.second;
  if (!continues || margin.margin < 0.0) course.count = 0;
  course.begun = true;
  course.second = margin.second_branch;
  course.seen = time;
  course.record.second_at_end = margin.second_branch;
  course.record.visited[branch] = true;
  if (margin.margin < 0.0) return;
  course.last = {LeastMargin{margin.margin, time}, course.last[0], course.last[1]};
  course.count = std::min(course.count + 1, 3);
  std::optional<LeastMargin>& least = course.record.least[branch];
  const auto& [c, b, a] = course.last;
  if (course.count == 3 && b.margin <= a.margin && b.margin <= c.margin) {
    take(margin.is_length ? least_of(a, b, c) : b, least);
  }
}

std::map<AlternativeKey, BranchRecord> MarginWatch::records() const {
  std::map<AlternativeKey, BranchRecord> records;
  for (const auto& [key, course] : courses_) {
    BranchRecord& record = records[key] = course.record;
    if (course.count == 0 || course.seen < time_) continue;
    take(course.last[0], record.least[static_cast<std::size_t>(course.second)]);
  }
  return records;
}

}  // namespace sheave::measure
