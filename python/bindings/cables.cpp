// Cables of a live world.

#include <algorithm>

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "cable/cable_polyline.h"
#include "cable/cable_system.h"
#include "cable/compiled_cable.h"
#include "engine/body_set.h"
#include "engine/index.h"
#include "python/bindings/arguments.h"
#include "python/bindings/bind.h"
#include "python/bindings/errors.h"

namespace sheave::python {
namespace {

using CableClass = py::class_<LiveCable>;
constexpr std::int64_t most_links = 1'000'000;

int place_of(const py::object& value, const char* name) {
  return static_cast<int>(integer(value, name, 0, most_links));
}

/// The compiled cable; null for a cable without tension because it hangs loose.
const CompiledCable* compiled(const LiveCable& cable) {
  const LiveWorld& world = world_of(cable);
  const CableSystem* system = world.simulation().cables;
  const Result<std::string> name = world.name(cable.handle);
  for (std::size_t c = 0; system != nullptr && c < system->cables().size(); ++c) {
    if (world.cable_at(static_cast<int>(c)) == cable.handle) return &system->cables()[c];
  }
  return nullptr;
}

/// The rows of a cable's spans in a view of all spans.
template <py::array Views::*View>
py::object listed(const LiveCable& cable) {
  const CompiledCable* own = compiled(cable);
  const int first = own != nullptr ? own->first_span : 0;
  const int count = own != nullptr ? own->listed_spans : 0;
  const py::array all = cable.core->views().*View;
  return all[py::slice(first, first + count, 1)];
}

/// A setter for a control of the cable.
using SetNumber = Errors (LiveWorld::*)(CableHandle, double);
using Clear = Errors (LiveWorld::*)(CableHandle);

template <SetNumber Set>
void set(const LiveCable& cable, const py::object& value) {
  check((world_of(cable).*Set)(cable.handle, number(value, "value")));
}
template <Clear Clearer>
void clear(const LiveCable& cable) {
  check((world_of(cable).*Clearer)(cable.handle));
}

void cut(const LiveCable& cable, const py::object& place) {
  if (place.is_none()) return clear<&LiveWorld::cut>(cable);
  check(world_of(cable).cut(cable.handle, number(place, "place")));
}

py::object loose_length(const LiveCable& cable, const py::object& end) {
  const std::string word = text(end, "end");
  if (word != "first" && word != "last") refuse("end", end, "\"first\" or \"last\"");
  const auto length = value_of(world_of(cable).loose_length(
      cable.handle, word == "first" ? CableEnd::first : CableEnd::last));
  return length ? py::object(py::float_(*length)) : py::none();
}

py::dict link_dict(const LiveWorld& world, const LinkReport& link) {
  py::dict one;
  one["type"] = std::string(link.type);
  const auto name_of = [&](BodyId body) {
    return body.is_world() ? std::string("world")
                           : world.simulation().world.bodies().name(body.index);
  };
  one["body"] = name_of(link.body);
  if (link.exit_body != link.body) one["exit_body"] = name_of(link.exit_body);
  one["touched"] = link.touched;
  one["center"] = tuple_of(link.center);
  one["radius"] = link.radius;
  one["entry"] = tuple_of(link.entry);
  one["exit"] = tuple_of(link.exit);
  one["stored_length"] = link.stored_length;
  one["wrap_angle"] = link.wrap_angle;
  one["slip"] = link.slip;
  one["stalled"] = link.stalled;
  one["fed"] = link.fed;
  if (link.groove) {
    one["axial_position"] = link.groove->axial_position;
    one["fleet_angle"] = link.groove->fleet_angle;
    one["layer"] = link.groove->layer;
  }
  return one;
}

py::dict report_of_cable(const LiveCable& cable) {
  const LiveWorld& world = world_of(cable);
  if (compiled(cable) == nullptr) {
    raise("Error", "cable \"" + *world.name(cable.handle) + "\" hangs loose, so it has no report");
  }
  const std::string name = *world.name(cable.handle);
  py::dict all;
  for (const CableReport& report : world.simulation().cable_reports()) {
    if (report.name != name) continue;
    py::list links;
    for (const LinkReport& link : report.links) links.append(link_dict(world, link));
    py::list spans;
    for (const SpanReport& span : report.spans) {
      py::dict one;
      one["start"] = tuple_of(span.start);
      one["end"] = tuple_of(span.end);
      one["length"] = span.length;
      one["rest_length"] = span.rest_length;
      one["tension"] = span.tension;
      one["start_tension"] = span.tension_at(0.0);
      one["end_tension"] = span.tension_at(1.0);
      spans.append(std::move(one));
    }
    all["closed"] = report.closed;
    all["cut"] = report.cut;
    if (report.cut) all["pieces"] = py::make_tuple(report.pieces[0], report.pieces[1]);
    all["total_length"] = report.total_length;
    all["length_error"] = report.length_error;
    all["links"] = links;
    all["spans"] = spans;
  }
  return all;
}

/// The line of one span, or of all of them in order.
py::array_t<double> polyline(const LiveCable& cable, const py::object& span,
                             const py::object& tolerance) {
  const LiveWorld& world = world_of(cable);
  const Simulation& simulation = world.simulation();
  PolylineOptions options;
  options.tolerance = 1e-3 * simulation.world.bodies().scale();
  if (!tolerance.is_none()) options.tolerance = number(tolerance, "tolerance");
  const Controls& controls = world.state().controls;
  options.gravity = controls.has_gravity ? controls.gravity : simulation.world.model().gravity;
  CableReports reports;
  reports.read(simulation);
  std::vector<Vector3> line;
  const auto append = [&](int k) {
    const std::size_t before = line.size();
    line.resize(before + value_of(world.cable_polyline(cable.handle, k, reports, options, {})));
    static_cast<void>(world.cable_polyline(cable.handle, k, reports, options,
                                           std::span<Vector3>(line).subspan(before)));
  };
  if (span.is_none()) {
    const CompiledCable* own = compiled(cable);
    if (world.is_cut(cable.handle)) refuse("span", span, "0 or 1, a piece of the cut cable");
    for (int k = 0; k < (own != nullptr ? own->listed_spans : 1); ++k) append(k);
  } else {
    append(place_of(span, "span"));
  }
  py::array_t<double> points({static_cast<py::ssize_t>(line.size()), py::ssize_t{3}});
  double* next = points.mutable_data();
  for (const Vector3& p : line) next = std::copy(p.data(), p.data() + 3, next);
  return points;
}

void bind_cable_readers(CableClass& cable) {
  cable.def_property_readonly("name", [](const LiveCable& own) {
    return value_of(own.core->world().name(own.handle), "StaleError");
  });
  cable.def_property_readonly(
      "alive", [](const LiveCable& own) { return own.core->world().name(own.handle).ok(); },
      "Whether the cable is still part of the world.");
  cable.def(
      "tension",
      [](const LiveCable& own, const py::object& span) {
        return value_of(world_of(own).tension(own.handle, place_of(span, "span")));
      },
      py::arg("span") = 0, "Mean tension of a span over the last substep [N].");
  cable.def(
      "rest_length",
      [](const LiveCable& own, const py::object& span) {
        return value_of(world_of(own).rest_length(own.handle, place_of(span, "span")));
      },
      py::arg("span") = 0, "Unstretched length of a span [m].");
  cable.def(
      "stored_length",
      [](const LiveCable& own, const py::object& link) {
        return value_of(world_of(own).stored_length(own.handle, place_of(link, "link")));
      },
      py::arg("link"), "Unstretched length of the cable on a link [m].");
  cable.def_property_readonly("tensions", &listed<&Views::tensions>,
                              "Tensions of the spans [N]: a view of the state.");
  cable.def_property_readonly("rest_lengths", &listed<&Views::rest_lengths>,
                              "Rest lengths of the spans [m]: a view of the state.");
  cable.def_property_readonly(
      "pulls", [](const LiveCable& own) { return world_of(own).pulls(own.handle); },
      "Whether a part of the cable lies between two holds.");
  cable.def_property_readonly(
      "length", [](const LiveCable& own) { return value_of(world_of(own).length(own.handle)); },
      "All of it [m].");
  cable.def("loose_length", &loose_length, py::arg("end"),
            "Length beyond the last hold of the \"first\" or \"last\" end [m]; None if that is "
            "not loose.");
  cable.def("polyline", &polyline, py::arg("span") = py::none(), py::arg("tolerance") = py::none(),
            "Points along which to draw the cable, shape (n, 3) [m]: one span with the arc before "
            "it, or all spans in order. `tolerance` is the largest distance from the cable [m]; "
            "default: a thousandth of the machine's size. Of a cut cable `span` is a piece, 0 or "
            "1, which hangs at rest.");
  cable.def("report", &report_of_cable, "Course of the cable, link by link and span by span.");
}

void bind_cable_controls(CableClass& cable) {
  const auto none = py::none();
  cable.def("set_compliance", &set<&LiveWorld::set_compliance>, py::arg("value"),
            "Sets the compliance of each span [m/N], > 0, of a cable that has one.");
  cable.def("clear_compliance", &clear<&LiveWorld::clear_compliance>);
  cable.def("set_breaking_tension", &set<&LiveWorld::set_breaking_tension>, py::arg("value"),
            "[N], > 0");
  cable.def("clear_breaking_tension", &clear<&LiveWorld::clear_breaking_tension>);
  cable.def(
      "cut", &cut, py::arg("place") = none,
      "Cuts the cable now, in the span with the largest tension, or at a place: the "
      "unstretched length from the first link on [m]. Without a place a cable without tension "
      "is cut once it carries tension, unless clear_breaking_tension() is called before.");
  cable.def("set_wrap_friction", &set<&LiveWorld::set_wrap_friction>, py::arg("value"),
            "Sets the friction on wrappable bodies, > 0, of a cable that has one.");
  cable.def("clear_wrap_friction", &clear<&LiveWorld::clear_wrap_friction>);
  cable.def(
      "set_friction",
      [](const LiveCable& own, const py::object& link, const py::object& value) {
        const int place = place_of(link, "link");
        check(world_of(own).set_friction(own.handle, place, number(value, "value")));
      },
      py::arg("link"), py::arg("value"), "Sets the friction of a link that has one, > 0.");
  cable.def(
      "clear_friction",
      [](const LiveCable& own, const py::object& link) {
        check(world_of(own).clear_friction(own.handle, place_of(link, "link")));
      },
      py::arg("link"));
  cable.def(
      "set_feed_speed",
      [](const LiveCable& own, const py::object& link, const py::object& value,
         const py::object& over) {
        const int place = place_of(link, "link");
        const DriveTarget wanted = target(value, over, py::none());
        check(world_of(own).set_feed_speed(own.handle, place, wanted));
      },
      py::arg("link"), py::arg("value"), py::arg("over") = none,
      "Sets the feed speed of an attachment that has one [m/s].");
  cable.def(
      "clear_feed_speed",
      [](const LiveCable& own, const py::object& link) {
        check(world_of(own).clear_feed_speed(own.handle, place_of(link, "link")));
      },
      py::arg("link"));
}

LiveCable cable_called(const std::shared_ptr<Core>& core, const py::object& name) {
  return {core, value_of(core->world().cable(text(name, "name")), "UnknownNameError")};
}

std::vector<LiveCable> cables_of(const std::shared_ptr<Core>& core) {
  std::vector<LiveCable> all;
  for (const CableHandle handle : core->world().cables()) all.push_back({core, handle});
  return all;
}

}  // namespace

void bind_cables(py::module_& module, SimulationClass& simulation) {
  CableClass cable(module, "LiveCable",
                   "A cable of a simulation; the handle is stale once the cable is removed.");
  bind_cable_readers(cable);
  bind_cable_controls(cable);
  cable.def("__eq__", [](const LiveCable& own, const py::object& other) {
    return py::isinstance<LiveCable>(other) && own == other.cast<const LiveCable&>();
  });
  cable.def("__hash__", [](const LiveCable& own) {
    return py::hash(py::make_tuple(reinterpret_cast<std::uintptr_t>(own.core.get()),
                                   own.handle.slot, own.handle.generation));
  });
  cable.def("__repr__", [](const LiveCable& own) {
    const Result<std::string> name = own.core->world().name(own.handle);
    return name ? "<LiveCable \"" + *name + "\">" : std::string("<LiveCable, removed>");
  });
  simulation.def("cable", &cable_called, py::arg("name"), "The cable with this name.");
  simulation.def("_cables", &cables_of);
}

}  // namespace sheave::python
