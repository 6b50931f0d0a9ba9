#pragma once
// Degrees of freedom of the bodies of a machine.
//
// A wheel on a fixed axle has one degree of freedom, a body in a plane three, a free body six.
// Solvers of all rows at once express motions and gradients in one number per degree of freedom.
// The inverse mass matrix is diagonal in these numbers, except for free bodies with unequal moments
// of inertia. Number 0 stands for all bodies that no row can move.

#include <cstdint>
#include <span>
#include <vector>

#include "engine/row.h"
#include "engine/vector.h"

namespace sheave {

struct BodyProperties;

/// How rows can move a body.
enum class Freedom : std::uint8_t {
  none,   ///< not at all: fixed, prescribed, or without inertia
  line,   ///< along `along`
  angle,  ///< about the axle, MovingBody::axis
  plane,  ///< along `along` and `across`, about MovingBody::axis
  space,  ///< along and about the axes of the world
  turn,   ///< about the axes of the world: the rotations of `space`, never all that a body has
};

/// Number of degrees of freedom.
[[nodiscard, gnu::always_inline]] constexpr int size_of(Freedom freedom) {
  switch (freedom) {
    case Freedom::none:
      return 0;
    case Freedom::line:
    case Freedom::angle:
      return 1;
    case Freedom::plane:
    case Freedom::turn:
      return 3;
    case Freedom::space:
      return 6;
  }
  return 0;
}

/// A body's degrees of freedom: `first`, `first` + 1, ...
struct BodyFreedom {
  Freedom kind = Freedom::none;
  int body = 0;
  int first = 0;
  Vector3 along = Vector3::Zero();  ///< unit vectors, world frame
  Vector3 across = Vector3::Zero();
};

/// The components of a gradient (or of any pair of linear and angular vectors) along `kind`: all
/// degrees of freedom of the body, or those of its rotation.
[[gnu::always_inline]] inline void project(Freedom kind, const BodyFreedom& freedom,
                                           const MovingBody& body, const Vector3& linear,
                                           const Vector3& angular, double* parts) {
  switch (kind) {
    case Freedom::none:
      break;
    case Freedom::line:
      parts[0] = dot(freedom.along, linear);
      break;
    case Freedom::angle:
      parts[0] = dot(body.axis, angular);
      break;
    case Freedom::plane:
      parts[0] = dot(freedom.along, linear);
      parts[1] = dot(freedom.across, linear);
      parts[2] = dot(body.axis, angular);
      break;
    case Freedom::space:
      for (int i = 0; i < 3; ++i) {
        parts[i] = linear[i];
        parts[3 + i] = angular[i];
      }
      break;
    case Freedom::turn:
      for (int i = 0; i < 3; ++i) parts[i] = angular[i];
      break;
  }
}
/// The components along all degrees of freedom of the body.
[[gnu::always_inline]] inline void project(const BodyFreedom& freedom, const MovingBody& body,
                                           const Vector3& linear, const Vector3& angular,
                                           double* parts) {
  project(freedom.kind, freedom, body, linear, angular, parts);
}

/// The motion per unit multiplier of a gradient with these components: the inverse masses times the
/// components.
[[gnu::always_inline]] inline void weigh(Freedom kind, const MovingBody& body, const double* parts,
                                         double* motion) {
  switch (kind) {
    case Freedom::none:
      break;
    case Freedom::line:
      motion[0] = body.linear_yield * parts[0];
      break;
    case Freedom::angle:
      motion[0] = body.angular_yield * parts[0];
      break;
    case Freedom::plane:
      motion[0] = body.linear_yield * parts[0];
      motion[1] = body.linear_yield * parts[1];
      motion[2] = body.angular_yield * parts[2];
      break;
    case Freedom::space: {
      for (int i = 0; i < 3; ++i) motion[i] = body.linear_yield * parts[i];
      if (parts[3] == 0.0 && parts[4] == 0.0 && parts[5] == 0.0) {
        motion[3] = motion[4] = motion[5] = 0.0;
        break;
      }
      const Vector3 turn = times(body.inverse_inertia, Vector3(parts[3], parts[4], parts[5]));
      for (int i = 0; i < 3; ++i) motion[3 + i] = turn[i];
      break;
    }
    case Freedom::turn: {
      const Vector3 turn = times(body.inverse_inertia, Vector3(parts[0], parts[1], parts[2]));
      for (int i = 0; i < 3; ++i) motion[i] = turn[i];
      break;
    }
  }
}

/// The displacement or velocity of a body whose motion along its degrees of freedom is `motion`.
[[nodiscard, gnu::always_inline]] inline Vector3 linear_motion(const BodyFreedom& freedom,
                                                               const double* motion) {
  switch (freedom.kind) {
    case Freedom::none:
    case Freedom::angle:
      break;
    case Freedom::line:
      return motion[0] * freedom.along;
    case Freedom::plane:
      return sum(motion[0] * freedom.along, motion[1], freedom.across);
    case Freedom::space:
      return {motion[0], motion[1], motion[2]};
    case Freedom::turn:
      break;
  }
  return Vector3::Zero();
}

/// The rotation or angular velocity of such a body.
[[nodiscard, gnu::always_inline]] inline Vector3 angular_motion(const BodyFreedom& freedom,
                                                                const MovingBody& body,
                                                                const double* motion) {
  switch (freedom.kind) {
    case Freedom::none:
    case Freedom::line:
      break;
    case Freedom::angle:
      return motion[0] * body.axis;
    case Freedom::plane:
      return motion[2] * body.axis;
    case Freedom::space:
      return {motion[3], motion[4], motion[5]};
    case Freedom::turn:
      return {motion[0], motion[1], motion[2]};
  }
  return Vector3::Zero();
}

/// Whether number `i` of a body's degrees of freedom is a rotation.
[[nodiscard]] constexpr bool is_rotation(Freedom kind, int i) {
  switch (kind) {
    case Freedom::angle:
    case Freedom::turn:
      return true;
    case Freedom::plane:
      return i == 2;
    case Freedom::space:
      return i >= 3;
    case Freedom::none:
    case Freedom::line:
      break;
  }
  return false;
}

/// The degrees of freedom of all bodies, which follow from mobilities and sizes and never change.
class Coordinates {
 public:
  Coordinates() = default;
  /// `bodies` ends with the world.
  explicit Coordinates(std::span<const BodyProperties> bodies);

  /// Number of degrees of freedom, with one for the bodies that do not move.
  [[nodiscard]] int count() const { return count_; }
  /// Degrees of freedom of a body, or of the world.
  [[nodiscard]] const BodyFreedom& operator[](int body) const {
    return freedoms_[static_cast<std::size_t>(body)];
  }
  /// Displacement per unit of each degree of freedom [m]: 1 m along a line, the body's size about
  /// an axis.
  [[nodiscard]] std::span<const double> levers() const { return levers_; }
  /// Whether each degree of freedom is a rotation: 1 or 0.
  [[nodiscard]] std::span<const char> turns() const { return turns_; }
  /// Degrees of freedom of all bodies that have any.
  [[nodiscard]] std::span<const BodyFreedom> movable() const { return movable_; }

 private:
  int count_ = 1;
  std::vector<BodyFreedom> freedoms_;
  std::vector<BodyFreedom> movable_;
  std::vector<double> levers_;
  std::vector<char> turns_;
};

}  // namespace sheave
