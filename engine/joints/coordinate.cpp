#include "engine/joints/coordinate.h"

#include "engine/field_check.h"

namespace sheave {
namespace {

class CoordinateCheck {
 public:
  CoordinateCheck(const JointCoordinate& coordinate, const std::string& joint,
                  const std::string& path, Errors& errors)
      : coordinate_(coordinate), joint_(joint), path_(path), errors_(errors) {}

  void check() {
    check_limits();
    if (coordinate_.rest != 0.0 && coordinate_.stiffness == 0.0) {
      fail("rest", "only a spring has a rest; give a stiffness too");
    }
    if (coordinate_.drive == CoordinateDrive::none) {
      check_no_drive();
    } else {
      check_drive();
    }
  }

 private:
  void fail(const char* key, const std::string& message) {
    errors_.push_back({path_ + key, "joint \"" + joint_ + "\": " + message});
  }

  void check_limits() {
    const auto& [lower, upper] = std::tie(coordinate_.lower, coordinate_.upper);
    if (lower && upper && *lower > *upper) {
      fail("lower", "the lower stop " + number_text(*lower) + " lies above the upper one " +
                        number_text(*upper));
      return;
    }
    if (coordinate_.limit_compliance > 0.0) {
      if (!lower && !upper) fail("limit_compliance", "there are no stops; give lower or upper");
      return;
    }
    if (lower && *lower > 0.0) {
      fail("lower", "the coordinate is 0 at time 0, so a rigid lower stop must be at most 0, not " +
                        number_text(*lower));
    }
    if (upper && *upper < 0.0) {
      fail("upper",
           "the coordinate is 0 at time 0, so a rigid upper stop must be at least 0, not " +
               number_text(*upper));
    }
  }

  void check_no_drive() {
    if (!coordinate_.drive_values.empty() || !coordinate_.drive_times.empty() ||
        coordinate_.drive_amplitude != 0.0 || coordinate_.drive_limit ||
        coordinate_.drive_compliance != 0.0 ||
        coordinate_.drive_interpolation != Interpolation::linear) {
      fail("drive", "settings of a drive need a drive; name the quantity that it prescribes");
    }
  }

  void check_drive() {
    const std::size_t faults = errors_.size();
    const std::size_t values = coordinate_.drive_values.size();
    const std::size_t times = coordinate_.drive_times.size();
    const bool sine = coordinate_.drive_amplitude != 0.0;
    if (values == 0 && !sine) fail("drive_values", "a drive needs values or an amplitude");
    if (values > 1 ? times != values : times > values) {
      fail("drive_values", "as many values as times are needed, there are " +
                               std::to_string(values) + " and " + std::to_string(times));
    }
    for (std::size_t i = 1; i < times; ++i) {
      if (coordinate_.drive_times[i] > coordinate_.drive_times[i - 1]) continue;
      fail(("drive_times/" + std::to_string(i)).c_str(), "times must increase");
      break;
    }
    if (sine && coordinate_.drive_frequency == 0.0) {
      fail("drive_frequency", "a sine needs a frequency above 0");
    }
    const bool position = coordinate_.drive == CoordinateDrive::position;
    if (coordinate_.drive_limit && coordinate_.drive == CoordinateDrive::force) {
      fail("drive_limit", "the values prescribe the drive's force; leave the limit out");
    }
    if (coordinate_.drive_compliance > 0.0 && !position) {
      fail("drive_compliance", "only a drive to a position can have compliance");
    }
    if (errors_.size() > faults) return;  // an inconsistent table has no value at 0
    const double start = coordinate_.signal().at(0.0);
    if (position && !coordinate_.drive_limit && coordinate_.drive_compliance == 0.0 &&
        !(std::abs(start) <= 1e-9)) {
      fail("drive_values",
           "a rigid drive without limit must begin where the joint is at time 0, "
           "at 0, not at " +
               number_text(start));
    }
  }

  const JointCoordinate& coordinate_;
  const std::string& joint_;
  std::string path_;
  Errors& errors_;
};

}  // namespace

bool JointCoordinate::acts() const {
  return lower || upper || stiffness > 0.0 || damping > 0.0 || friction > 0.0 ||
         drive != CoordinateDrive::none;
}

void check_coordinate(const JointCoordinate& coordinate, const std::string& joint,
                      const std::string& path, const std::string& prefix, Errors& errors) {
  CoordinateCheck(coordinate, joint, path + "/" + prefix, errors).check();
}

std::vector<Field> joined(std::initializer_list<std::vector<Field>> tables) {
  std::vector<Field> all;
  for (const std::vector<Field>& table : tables) all.insert(all.end(), table.begin(), table.end());
  return all;
}

}  // namespace sheave
