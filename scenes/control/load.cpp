#include "scenes/control/load.h"

#include <map>

#include <fmt/format.h>

#include "engine/field_check.h"
#include "engine/model.h"

namespace sheave {

VectorTable::VectorTable(const std::vector<double>& times, const std::vector<Vector3>& values,
                         Interpolation interpolation) {
  if (values.empty()) return;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> part;
    for (const Vector3& value : values) part.push_back(value[axis]);
    parts_[static_cast<std::size_t>(axis)] = TimeTable::of(times, std::move(part), interpolation);
  }
}

Vector3 VectorTable::at(double time) const {
  return {parts_[0].at(time), parts_[1].at(time), parts_[2].at(time)};
}

Vector3 VectorTable::rate(double time) const {
  return {parts_[0].rate(time), parts_[1].rate(time), parts_[2].rate(time)};
}

Vector3 VectorTable::mean(double from, double to) const {
  const Vector3 sum(parts_[0].integral(from, to), parts_[1].integral(from, to),
                    parts_[2].integral(from, to));
  return sum / (to - from);
}

Vector3 VectorTable::moment(double from, double to) const {
  return {parts_[0].moment(from, to), parts_[1].moment(from, to), parts_[2].moment(from, to)};
}

double VectorTable::next_corner(double time) const { return parts_[0].next_corner(time); }

PointForce ActingLoad::force(const World& /*world*/, const LoadSubstep& /*substep*/,
                             std::span<double> /*memory*/) const {
  return {};
}

void ActingLoad::pull(const World& /*world*/, std::span<const CableReport> /*cables*/,
                      const LoadSubstep& /*substep*/, std::span<double> /*memory*/,
                      std::map<int, PointForce>& /*forces*/) const {}

MuscleState ActingLoad::muscle(std::span<const double> /*memory*/, double /*time*/) const {
  return {};
}

MotionTarget ActingLoad::motion(const World& /*world*/, double /*h*/) const { return {}; }

LoadCourse ActingLoad::course(const World& /*world*/, double /*h*/) const { return {}; }

std::span<const Field> LoadDef::common_field_table() {
  static const std::array table{
      field<&LoadDef::name>("name", "", {}, required, "unique name among the loads"),
      field<&LoadDef::body>(
          "body", "", {}, optional,
          "the body on which it acts; required, but for a muscle, which has none"),
  };
  return table;
}

Error LoadDef::fault(const std::string& path, const std::string& message) const {
  return {path, fmt::format("load \"{}\": {}", name, message)};
}

void LoadDef::check_table(const std::vector<double>& times, std::size_t values,
                          std::string_view key, const std::string& path, Errors& errors) const {
  const bool constant = times.empty() && values == 1;
  if (values > 0 && !constant && values != times.size()) {
    errors.push_back(fault(fmt::format("{}/{}", path, key),
                           fmt::format("one value per time is needed, or one value without times; "
                                       "there are {} values and {} times",
                                       values, times.size())));
  }
}

void LoadDef::check_times(const std::vector<double>& times, const std::string& path,
                          Errors& errors) const {
  for (std::size_t i = 1; i < times.size(); ++i) {
    if (times[i] > times[i - 1]) continue;
    errors.push_back(fault(fmt::format("{}/times/{}", path, i), "times must increase"));
    return;
  }
}

std::vector<int> LoadDef::bodies(const LoadScope& /*scope*/) const { return {body.index}; }

Errors LoadDef::validate(const LoadScope& scope, const std::string& path) const {
  if (body.is_world()) {
    return {fault(path + "/body", "the world does not move; name a body")};
  }
  const BodyDef& own = scope.model.bodies[static_cast<std::size_t>(body.index)];
  if (is_motion() && own.mobility != Mobility::kinematic) {
    return {fault(path + "/body",
                  fmt::format("a motion needs a kinematic body, and \"{}\" is {}", own.name,
                              mobility_names[static_cast<std::size_t>(own.mobility)]))};
  }
  const bool driven = own.drive == DriveKind::speed || own.drive == DriveKind::angle;
  if (!is_motion() && (driven || !yields(own.mobility))) {
    return {fault(path + "/body",
                  fmt::format("no force moves \"{}\", which is {}", own.name,
                              driven ? "driven to a speed or an angle"
                                     : mobility_names[static_cast<std::size_t>(own.mobility)]))};
  }
  return {};
}

Errors validate_loads(const LoadScope& scope,
                      std::span<const std::shared_ptr<const LoadDef>> loads) {
  Errors errors;
  std::map<int, const LoadDef*> first;
  for (std::size_t i = 0; i < loads.size(); ++i) {
    const LoadDef& load = *loads[i];
    const std::string path = fmt::format("/loads/{}", i);
    check_fields(LoadDef::common_field_table(), &load, path, errors);
    for (const auto& type : load_types()) {
      if (type.name == load.type()) check_fields(type.fields(), load.settings(), path, errors);
    }
    const std::size_t before = errors.size();
    for (Error& error : load.validate(scope, path)) errors.push_back(std::move(error));
    if (errors.size() > before && load.is_muscle()) continue;  // its bodies are not known
    for (const int body : load.bodies(scope)) {
      const auto [other, is_first] = first.emplace(body, &load);
      if (is_first || (load.is_central() && other->second->is_central() && !load.is_motion())) {
        continue;
      }
      errors.push_back(
          {path + (load.is_muscle() ? "/cable" : "/body"),
           fmt::format("load \"{}\": load \"{}\" acts on {}, too, and only muscles and forces at "
                       "its centre of mass in directions of the world add up",
                       load.name, other->second->name,
                       load.is_muscle() ? "a body of its cable" : "this body")});
      break;
    }
  }
  return errors;
}

}  // namespace sheave
