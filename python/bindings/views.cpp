// NumPy arrays that view the numbers of the state without copies.

#include <cstddef>

#include <fmt/format.h>

#include "cable/cable_system.h"
#include "cable/compiled_cable.h"
#include "engine/index.h"
#include "python/bindings/bind.h"

namespace sheave::python {
namespace {

/// The owner that keeps the viewed memory alive.
py::capsule keeper(const std::shared_ptr<const void>& revision) {
  return {new std::shared_ptr<const void>(revision),
          [](void* held) { delete static_cast<std::shared_ptr<const void>*>(held); }};
}

/// A read-only view: only the engine may write, because dependent values must stay consistent.
py::array read_only(const double* data, std::vector<py::ssize_t> shape,
                    std::vector<py::ssize_t> strides, const std::shared_ptr<const void>& revision) {
  py::array array(py::dtype::of<double>(), std::move(shape), std::move(strides), data,
                  keeper(revision));
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

py::array of_bodies(const State& state, std::size_t offset, py::ssize_t width,
                    const std::shared_ptr<const void>& revision) {
  // Members of a body are addressed by byte offsets, because its parts are classes.
  const auto* bytes = reinterpret_cast<const std::byte*>(state.bodies.data());
  const auto* first = reinterpret_cast<const double*>(bytes + offset);
  const auto count = static_cast<py::ssize_t>(state.bodies.size());
  const auto stride = static_cast<py::ssize_t>(sizeof(BodyState));
  if (width == 1) return read_only(first, {count}, {stride}, revision);
  return read_only(first, {count, width}, {stride, sizeof(double)}, revision);
}

int span_count(const CableSystem* system) {
  if (system == nullptr || system->cables().empty()) return 0;
  return system->cables().back().first_span + system->cables().back().span_count;
}

std::vector<std::string> span_names(Core& core) {
  std::vector<std::string> names;
  const CableSystem* system = core.simulation().cables;
  for (int c = 0; system != nullptr && c < static_cast<int>(system->cables().size()); ++c) {
    const CompiledCable& cable = system->cables()[at(c)];
    for (int k = 0; k < cable.span_count; ++k) {
      names.push_back(k < cable.listed_spans
                          ? fmt::format("{}.{}", cable.name, k)
                          : fmt::format("{}.wrap{}", cable.name, k - cable.listed_spans));
    }
  }
  return names;
}

std::vector<std::string> body_names(Core& core) {
  std::vector<std::string> names;
  for (const BodyDef& body : core.simulation().world.model().bodies) names.push_back(body.name);
  return names;
}

template <py::array Views::*View>
py::array view(Core& core) {
  return core.views().*View;
}

}  // namespace

Views& Core::views() {
  LiveWorld& world = this->world();
  std::shared_ptr<const void> revision = world.keep_in_place();
  if (views_.revision == revision) return views_;
  const State& state = world.state();
  views_.positions = of_bodies(state, offsetof(BodyState, position), 3, revision);
  views_.orientations = of_bodies(state, offsetof(BodyState, orientation), 4, revision);
  views_.velocities = of_bodies(state, offsetof(BodyState, velocity), 3, revision);
  views_.angular_velocities = of_bodies(state, offsetof(BodyState, angular_velocity), 3, revision);
  views_.angles = of_bodies(state, offsetof(BodyState, angle), 1, revision);
  const CableSystem* system = world.simulation().cables;
  const auto spans = static_cast<py::ssize_t>(span_count(system));
  static const double none = 0.0;
  const double* reals = spans > 0 ? state.features.back().reals.data() : &none;
  const auto place = [&](std::size_t index) { return spans > 0 ? reals + index : reals; };
  constexpr py::ssize_t stride = sizeof(double);
  views_.tensions =
      read_only(place(spans > 0 ? system->tension_index(0) : 0), {spans}, {stride}, revision);
  views_.rest_lengths =
      read_only(place(spans > 0 ? system->rest_length_index(0) : 0), {spans}, {stride}, revision);
  views_.revision = std::move(revision);
  return views_;
}

void bind_views(SimulationClass& simulation) {
  simulation.def_property_readonly(
      "positions", &view<&Views::positions>,
      "Positions of the bodies' centres of mass [m]: a view of the state, (bodies, 3), read only.");
  simulation.def_property_readonly(
      "orientations_xyzw", &view<&Views::orientations>,
      "Orientations of the bodies, unit quaternions x, y, z, w: a view of the state, (bodies, 4).");
  simulation.def_property_readonly(
      "velocities", &view<&Views::velocities>,
      "Velocities of the bodies' centres of mass [m/s]: a view of the state, (bodies, 3).");
  simulation.def_property_readonly(
      "angular_velocities", &view<&Views::angular_velocities>,
      "Angular velocities of the bodies [rad/s]: a view of the state, (bodies, 3).");
  simulation.def_property_readonly("angles", &view<&Views::angles>,
                                   "Angles turned by rotors and planar bodies since time 0 [rad]: "
                                   "a view of the state, (bodies,).");
  simulation.def_property_readonly(
      "tensions", &view<&Views::tensions>,
      "Tensions of all spans, in the order of span_names [N]: a view of the state, (spans,).");
  simulation.def_property_readonly(
      "rest_lengths", &view<&Views::rest_lengths>,
      "Rest lengths of all spans, in the order of span_names [m]: a view of the state, (spans,).");
  simulation.def_property_readonly("span_names", &span_names,
                                   "Names of the rows of tensions: \"rope.0\", ..., and places for "
                                   "wraps, \"rope.wrap0\", ...");
  simulation.def_property_readonly("body_names", &body_names,
                                   "Names of the rows of positions; names of removed bodies stay "
                                   "until other bodies take their places.");
}

}  // namespace sheave::python
