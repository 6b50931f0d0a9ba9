// Positions, orientations and mass properties in frames.

#include "engine/math/portable.h"
#include "scenes/import/mjcf/reader.h"

namespace sheave::import::mjcf {
namespace {

/// Lower-case letters turn about the axes that have turned already, capitals about those that stay.
Quaternion from_euler(const std::vector<double>& angles, const std::string& sequence, double unit) {
  Quaternion total = Quaternion::Identity();
  for (std::size_t i = 0; i < 3; ++i) {
    const char letter = sequence[i];
    const bool fixed = letter >= 'X' && letter <= 'Z';
    const int axis = fixed ? letter - 'X' : letter - 'x';
    const Quaternion one = turn_about(Vector3::Unit(axis), unit * angles[i]);
    total = fixed ? one * total : total * one;
  }
  return total;
}

}  // namespace

Quaternion turn_about(const Vector3& axis, double angle) {
  const Vector3 part = portable::sin(0.5 * angle) * axis.normalized();
  return {portable::cos(0.5 * angle), part.x(), part.y(), part.z()};
}

Quaternion from_z_axis(const Vector3& direction) {
  const Vector3 z = direction.normalized();
  const Vector3 axis(-z.y(), z.x(), 0.0);
  const double sine = axis.norm();
  if (sine < 1e-10) return turn_about(Vector3::UnitX(), z.z() > 0.0 ? 0.0 : pi);
  return turn_about(axis, portable::atan2(sine, z.z()));
}

void Inertial::add(const Inertial& part) {
  if (!(part.mass > 0.0)) return;
  const double total = mass + part.mass;
  const Vector3 joint = (mass * center + part.mass * part.center) / total;
  const auto about = [&](const Inertial& one) -> Matrix3 {
    const Vector3 d = one.center - joint;
    return one.inertia + one.mass * (d.squaredNorm() * Matrix3::Identity() - d * d.transpose());
  };
  inertia = mass > 0.0 ? Matrix3(about(*this) + about(part)) : part.inertia;
  center = mass > 0.0 ? joint : part.center;
  mass = total;
}

Inertial Inertial::seen_from(const Frame& frame) const {
  const Matrix3 turned = frame.orientation.toRotationMatrix();
  return {mass, frame.point(center), turned * inertia * turned.transpose()};
}

namespace {

/// Reads the ways in which an orientation can be given, and counts them.
class OrientationReader {
 public:
  OrientationReader(Attributes& attributes, const Compiler& compiler)
      : attributes_(attributes), compiler_(compiler) {}

  /// nullopt if none is given, or if one has no direction.
  std::optional<Quaternion> read() {
    read_quaternion();
    if (const auto e = attributes_.numbers("euler", 3, 3); !e.empty()) {
      set(from_euler(e, compiler_.euler_sequence, unit()));
    }
    if (const auto a = attributes_.numbers("axisangle", 4, 4); !a.empty()) {
      const Vector3 axis(a[0], a[1], a[2]);
      if (has_length("axisangle", axis.norm())) set(turn_about(axis, unit() * a[3]));
    }
    read_axes();
    if (const auto z = attributes_.vector("zaxis"); z && has_length("zaxis", z->norm())) {
      set(from_z_axis(*z));
    }
    if (ways_ > 1) {
      attributes_.error("orientation",
                        "given in one way, not in several of quat, euler, axisangle, xyaxes and "
                        "zaxis",
                        FaultCode::exclusive_keys);
    }
    return orientation_;
  }

 private:
  [[nodiscard]] double unit() const { return compiler_.degrees ? pi / 180.0 : 1.0; }
  void set(const Quaternion& orientation) {
    ++ways_;
    orientation_ = orientation;
  }
  bool has_length(std::string_view name, double length) {
    if (length > 1e-10 && length < 1e100) return true;
    attributes_.error(name, "of a length that is not 0", FaultCode::out_of_range);
    return false;
  }

  void read_quaternion() {
    const auto q = attributes_.numbers("quat", 4, 4);
    if (q.empty()) return;
    const Quaternion given(q[0], q[1], q[2], q[3]);
    if (has_length("quat", given.norm())) set(given.normalized());
  }

  void read_axes() {
    const auto a = attributes_.numbers("xyaxes", 6, 6);
    if (a.empty()) return;
    const Vector3 x(a[0], a[1], a[2]);
    const Vector3 given_y(a[3], a[4], a[5]);
    if (!(x.norm() > 1e-10) || !(x.cross(given_y).norm() > 1e-10 * x.norm() * given_y.norm())) {
      attributes_.error("xyaxes", "two directions that are not parallel", FaultCode::out_of_range);
      return;
    }
    Matrix3 axes;
    axes.col(0) = x.normalized();
    axes.col(2) = x.cross(given_y).normalized();
    axes.col(1) = axes.col(2).cross(axes.col(0));
    set(Quaternion(axes));
  }

  Attributes& attributes_;
  const Compiler& compiler_;
  int ways_ = 0;
  std::optional<Quaternion> orientation_;
};

}  // namespace

std::optional<Quaternion> read_orientation(Attributes& attributes, const Compiler& compiler) {
  return OrientationReader(attributes, compiler).read();
}

Frame read_frame(Attributes& attributes, const Compiler& compiler) {
  Frame frame;
  frame.position = attributes.vector("pos").value_or(Vector3::Zero());
  frame.orientation =
      read_orientation(attributes, compiler).value_or(Quaternion(Quaternion::Identity()));
  return frame;
}

}  // namespace sheave::import::mjcf
