#include "render/view_survey.h"

#include <algorithm>
#include <cmath>

#include "engine/body_set.h"
#include "render/cable_path.h"
#include "render/joint_view.h"
#include "render/number_text.h"
#include "render/overlay.h"
#include "render/view_builder.h"

namespace sheave::render {
namespace {

void extend(Eigen::AlignedBox3d& box, const Vector3& center, const Vector3& half) {
  if (!center.allFinite() || !half.allFinite()) return;
  box.extend(Vector3(center - half));
  box.extend(Vector3(center + half));
}

/// Rounds up to 1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6 or 8 times a power of ten.
double round_up(double value) {
  constexpr std::array<double, 11> steps{1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0};
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double step : steps) {
    if (value <= step * power * (1.0 + 1e-9)) return step * power;
  }
  return 10.0 * power;
}

}  // namespace

void ViewSurvey::add(const World& world, std::span<const CableReport> cables) {
  add_room(world, cables);
  add_tensions(world, cables);
}

void ViewSurvey::add_tensions(const World& world, std::span<const CableReport> cables) {
  weight_ = total_weight(world.model());
  const auto count = [&](double tension) {
    if (!(tension > 0.0) || !std::isfinite(tension)) return;
    largest_ = std::max(largest_, tension);
    const double octave = std::clamp(std::log2(tension) - lowest_exponent, 0.0, octaves - 1e-3);
    ++counts_[static_cast<std::size_t>(octave * classes_per_octave)];
  };
  for (const CableReport& cable : cables) {
    for (const SpanReport& span : cable.with_wraps_in_place().spans) count(span.tension);
  }
}

void ViewSurvey::look_for_highest(const World& world, std::span<const CableReport> cables) {
  const auto look = [&](double tension) {
    if (!(tension > peak_) || !std::isfinite(tension)) return;
    peak_ = tension;
    highest_ = world.state().time;
  };
  for (const CableReport& cable : cables) {
    for (const SpanReport& span : cable.spans) look(span.tension);
    for (const WrapReport& wrap : cable.wraps) look(wrap.span.tension);
  }
}

void ViewSurvey::add_room(const World& world, std::span<const CableReport> cables) {
  const auto& bodies = world.model().bodies;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const BodyId id{static_cast<int>(i)};
    const Matrix3 rotation = world.orientation(id).toRotationMatrix();
    for (const PlacedShape& placed : bodies[i].shapes) {
      const Matrix3 turn = rotation * placed.orientation.toRotationMatrix();
      const Vector3 half = turn.cwiseAbs() * placed.shape->half_extent();
      extend(bounds_, world.point(id, placed.position), half);
    }
    if (bodies[i].shapes.empty()) extend(bounds_, world.position(id), Vector3::Zero());
  }
  extend_by_joints(world, bounds_);
  extend_travels(world, travels_);
  CableStyle style;
  style.gravity = world.model().gravity;
  style.tolerance = 1e-3 * world.bodies().scale();
  if (const auto& ground = world.model().ground) {
    style.floor = Plane{.point = ground->point, .normal = ground->normal.normalized()};
  }
  for (const CableReport& listed : cables) {
    const CableReport cable = listed.with_wraps_in_place();
    for (const LinkReport& link : cable.links) {
      // A disc reaches r sqrt(1 - n_i^2) along axis i.
      const Vector3 disc =
          (Vector3::Ones() - link.normal.cwiseAbs2()).cwiseMax(0.0).cwiseSqrt() * link.radius;
      extend(bounds_, link.center, disc);
    }
    if (cable.cut) continue;
    for (const auto& line : span_lines(cable, style)) {
      for (const Vector3& p : line) extend(bounds_, p, Vector3::Zero());
    }
  }
}

double ViewSurvey::tension_max() const {
  std::int64_t total = 0;
  for (const std::int64_t count : counts_) total += count;
  if (total == 0 || largest_ <= 1e-6 * weight_) return weight_ > 0.0 ? round_up(weight_) : 1.0;
  std::int64_t below = 0;
  std::size_t index = 0;
  for (; index + 1 < counts_.size(); ++index) {
    below += counts_[index];
    if (static_cast<double>(below) >= 0.98 * static_cast<double>(total)) break;
  }
  const double upper =
      std::exp2(static_cast<double>(index + 1) / classes_per_octave + lowest_exponent);
  return round_up(std::min(upper, largest_));
}

Camera automatic_camera(const Model& model, std::span<const CableReport> cables,
                        const Eigen::AlignedBox3d& run_bounds, const DrawList& typical, int width,
                        int height) {
  const Vector3 up = up_direction(model);
  FrameOptions options;
  options.aspect = static_cast<double>(width) / height;
  options.margins = overlay_margins(typical, width, height);
  const Vector3 direction = default_view_direction(up, motion_plane(model, cables));
  return frame_box(run_bounds, direction, up, options);
}

}  // namespace sheave::render
