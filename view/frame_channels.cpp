#include "view/frame_channels.h"

#include <algorithm>
#include <limits>
#include <string_view>
#include <unordered_map>

#include <fmt/format.h>

#include "engine/index.h"
#include "engine/joint.h"
#include "engine/world.h"

namespace sheave::view {
namespace {

ChannelKind kind_of(std::string_view unit) {
  if (unit == "m") return ChannelKind::length;
  if (unit == "rad") return ChannelKind::angle;
  if (unit == "N") return ChannelKind::force;
  return ChannelKind::other;
}

/// Units by the last part of a name; for coordinates of joints by the whole name.
std::unordered_map<std::string, std::string> units_of(const Model& model) {
  std::unordered_map<std::string, std::string> units;
  for (const QuantityGroup& group : quantity_groups()) {
    for (const Quantity& quantity : group.quantities) {
      units.emplace(quantity.name, quantity.unit);
    }
  }
  for (const auto& joint : model.joints) {
    const auto coordinates = joint->coordinates();
    for (const JointCoordinateInfo& coordinate : coordinates) {
      const std::string name = fmt::format("{}.{}", joint->name, coordinate.name);
      units[name] = coordinate.angle ? "rad" : "m";
      units[name + "_rate"] = coordinate.angle ? "rad/s" : "m/s";
      units[coordinates.size() == 1 ? joint->name + ".drive_force" : name + "_drive_force"] =
          coordinate.angle ? "N m" : "N";
    }
  }
  return units;
}

/// Writes values one after another.
class Writer {
 public:
  Writer(std::vector<double>& values, int first) : at_(values.data() + first) {}
  void write(double value) { *at_++ = value; }
  void write(const Vector3& v) {
    for (int i = 0; i < 3; ++i) write(v[i]);
  }

 private:
  double* at_;
};

/// The frame of a link's body.
struct BodyFrameNow {
  Vector3 position = Vector3::Zero();
  Quaternion to_body = Quaternion::Identity();

  BodyFrameNow(const World& world, BodyId body) {
    if (body.is_world()) return;
    position = world.position(body);
    to_body = world.orientation(body).conjugate();
  }
  [[nodiscard]] Vector3 point(const Vector3& p) const { return to_body * (p - position); }
};

}  // namespace

FrameChannels::FrameChannels(const Simulation& simulation, const std::vector<CableReport>& reports)
    : observables_(simulation, ObservableSet::Extent::columns) {
  add_columns(simulation.world.model());
  for (std::size_t c = 0; c < reports.size(); ++c) {
    const CableReport& report = reports[c];
    const bool has_weight = (*simulation.cable_definitions)[c].linear_density > 0.0;
    CableSlots cable;
    cable.name = std::string(report.name);
    for (std::size_t k = 0; k < report.spans.size(); ++k) {
      const std::string name = fmt::format("{}.{}.", cable.name, k);
      cable.spans.push_back(add_point(name + "start", ChannelKind::length));
      add_point(name + "end", ChannelKind::length);
      if (!has_weight) continue;
      cable.forces.push_back(add_point(name + "start_force", ChannelKind::force));
      add_point(name + "end_force", ChannelKind::force);
      if (!(*simulation.cable_definitions)[c].floor) continue;
      cable.floors.push_back(add(name + "floored", "m", ChannelKind::length));
      add_point(name + "floor_start", ChannelKind::length);
      add_point(name + "floor_end", ChannelKind::length);
    }
    for (std::size_t k = 0; k < report.links.size(); ++k) {
      cable.links.push_back(add_link(fmt::format("{}.link{}.", cable.name, k)));
    }
    cable.wrap_count = add(cable.name + ".wrap_count", "", ChannelKind::other);
    for (std::size_t k = 0; k < cable.pieces.size(); ++k) {
      cable.pieces[k].prefix = fmt::format("{}.piece{}.", cable.name, k);
      cable.pieces[k].count = add(cable.pieces[k].prefix + "count", "", ChannelKind::other);
    }
    cables_.push_back(std::move(cable));
  }
  extend(reports, {});
}

int FrameChannels::add(const std::string& name, const char* unit, ChannelKind kind) {
  channels_.push_back({name, unit, kind, true});
  return static_cast<int>(channels_.size()) - 1;
}

int FrameChannels::add_point(const std::string& name, ChannelKind kind) {
  const char* unit = kind == ChannelKind::length ? "m" : kind == ChannelKind::force ? "N" : "";
  const int first = add(name + "_x", unit, kind);
  add(name + "_y", unit, kind);
  add(name + "_z", unit, kind);
  return first;
}

void FrameChannels::add_columns(const Model& model) {
  const auto units = units_of(model);
  for (std::size_t i = 0; i < observables_.default_count(); ++i) {
    const std::string& name = observables_.names()[i];
    const std::string last = name.substr(name.rfind('.') + 1);
    auto unit = units.find(name);
    if (unit == units.end()) unit = units.find(last);
    FrameChannel channel{name, name == "t" ? "s" : "", ChannelKind::other, false};
    if (unit != units.end()) channel.unit = unit->second;
    channel.kind = kind_of(channel.unit);
    // Components of quaternions.
    if (last.size() == 2 && last[0] == 'q') channel.kind = ChannelKind::angle;
    channels_.push_back(std::move(channel));
  }
}

FrameChannels::LinkSlot FrameChannels::add_link(const std::string& prefix) {
  LinkSlot slot;
  slot.prefix = prefix;
  slot.first = add(prefix + "radius", "m", ChannelKind::length);
  add(prefix + "winding", "", ChannelKind::other);
  add_point(prefix + "center", ChannelKind::length);
  add_point(prefix + "normal", ChannelKind::angle);
  return slot;
}

void FrameChannels::add_wrap(CableSlots& cable) {
  const std::string prefix = fmt::format("{}.wrap{}.", cable.name, cable.wraps.size());
  LinkSlot slot = add_link(prefix);
  add(prefix + "body", "", ChannelKind::other);
  add(prefix + "after", "", ChannelKind::other);
  add(prefix + "stored_length", "m", ChannelKind::length);
  add(prefix + "wrap_angle", "rad", ChannelKind::angle);
  add(prefix + "tension", "N", ChannelKind::force);
  add(prefix + "length", "m", ChannelKind::length);
  add(prefix + "rest_length", "m", ChannelKind::length);
  for (const char* point : {"entry", "exit", "end"}) {
    add_point(prefix + point, ChannelKind::length);
  }
  cable.wraps.push_back(std::move(slot));
}

void FrameChannels::extend_path(LinkSlot& slot, std::size_t corners) {
  if (corners > 0 && slot.path_count < 0) {
    slot.path_count = add(slot.prefix + "path_count", "", ChannelKind::other);
  }
  while (slot.corners.size() < corners) {
    slot.corners.push_back(
        add_point(fmt::format("{}path{}", slot.prefix, slot.corners.size()), ChannelKind::length));
  }
}

void FrameChannels::extend_piece(LineSlot& slot, std::size_t points) {
  while (slot.points.size() < points) {
    slot.points.push_back(
        add_point(fmt::format("{}{}", slot.prefix, slot.points.size()), ChannelKind::length));
  }
}

void FrameChannels::write_pieces(const CableSlots& cable,
                                 std::span<const std::vector<Vector3>> pieces,
                                 std::vector<double>& values) const {
  for (std::size_t k = 0; k < cable.pieces.size(); ++k) {
    const LineSlot& slot = cable.pieces[k];
    values[at(slot.count)] = k < pieces.size() ? static_cast<double>(pieces[k].size()) : 0.0;
    if (k >= pieces.size()) continue;
    for (std::size_t i = 0; i < pieces[k].size(); ++i) {
      Writer(values, slot.points[i]).write(pieces[k][i]);
    }
  }
}

bool FrameChannels::fits(const std::vector<CableReport>& reports,
                         const render::CutRopes& ropes) const {
  for (std::size_t c = 0; c < reports.size(); ++c) {
    const CableReport& report = reports[c];
    const CableSlots& cable = cables_[c];
    if (report.wraps.size() > cable.wraps.size()) return false;
    const auto pieces = ropes.pieces(c);
    for (std::size_t k = 0; k < pieces.size(); ++k) {
      if (pieces[k].size() > cable.pieces[k].points.size()) return false;
    }
    for (std::size_t k = 0; k < report.links.size(); ++k) {
      if (report.links[k].path.size() > cable.links[k].corners.size()) return false;
    }
    for (std::size_t k = 0; k < report.wraps.size(); ++k) {
      if (report.wraps[k].link.path.size() > cable.wraps[k].corners.size()) return false;
    }
  }
  return true;
}

void FrameChannels::extend(const std::vector<CableReport>& reports, const render::CutRopes& ropes) {
  for (std::size_t c = 0; c < reports.size(); ++c) {
    const CableReport& report = reports[c];
    CableSlots& cable = cables_[c];
    while (cable.wraps.size() < report.wraps.size()) add_wrap(cable);
    const auto pieces = ropes.pieces(c);
    for (std::size_t k = 0; k < pieces.size(); ++k) {
      extend_piece(cable.pieces[k], pieces[k].size());
    }
    for (std::size_t k = 0; k < report.links.size(); ++k) {
      extend_path(cable.links[k], report.links[k].path.size());
    }
    for (std::size_t k = 0; k < report.wraps.size(); ++k) {
      extend_path(cable.wraps[k], report.wraps[k].link.path.size());
    }
  }
}

void FrameChannels::sample(const Simulation& simulation, const std::vector<CableReport>& reports,
                           const render::CutRopes& ropes, std::vector<double>& values) const {
  const World& world = simulation.world;
  observables_.sample(simulation, values);
  for (std::size_t i = 0; world.state().steps == 0 && i < values.size(); ++i) {
    if (observables_.known_at_start(static_cast<int>(i))) continue;
    values[i] = std::numeric_limits<double>::quiet_NaN();
  }
  values.resize(channels_.size(), 0.0);
  const auto write_link = [&](const LinkSlot& slot, const LinkReport& link) {
    const BodyFrameNow frame(world, link.body);
    Writer writer(values, slot.first);
    writer.write(link.radius);
    writer.write(link.winding);
    writer.write(frame.point(link.center));
    writer.write(Vector3(frame.to_body * link.normal));
    if (slot.path_count >= 0) {
      values[at(slot.path_count)] = static_cast<double>(link.path.size());
    }
    for (std::size_t k = 0; k < link.path.size(); ++k) {
      Writer(values, slot.corners[k]).write(frame.point(link.path[k]));
    }
    return writer;
  };
  for (std::size_t c = 0; c < reports.size(); ++c) {
    const CableReport& report = reports[c];
    const CableSlots& cable = cables_[c];
    for (std::size_t k = 0; k < report.spans.size(); ++k) {
      Writer writer(values, cable.spans[k]);
      writer.write(report.spans[k].start);
      writer.write(report.spans[k].end);
      if (cable.forces.empty()) continue;
      Writer forces(values, cable.forces[k]);
      forces.write(report.spans[k].start_force);
      forces.write(report.spans[k].end_force);
      if (cable.floors.empty()) continue;
      Writer floors(values, cable.floors[k]);
      floors.write(report.spans[k].floored);
      for (const Vector3& touch : report.spans[k].touches) floors.write(touch);
    }
    for (std::size_t k = 0; k < report.links.size(); ++k) {
      write_link(cable.links[k], report.links[k]);
    }
    for (std::size_t k = 0; k < report.wraps.size(); ++k) {
      const WrapReport& wrap = report.wraps[k];
      Writer writer = write_link(cable.wraps[k], wrap.link);
      writer.write(wrap.link.body.is_world() ? -1.0 : wrap.link.body.index);
      writer.write(wrap.after);
      writer.write(wrap.link.stored_length);
      writer.write(wrap.link.wrap_angle);
      writer.write(wrap.span.tension);
      writer.write(wrap.span.length);
      writer.write(wrap.span.rest_length);
      writer.write(wrap.link.entry);
      writer.write(wrap.link.exit);
      writer.write(wrap.span.end);
    }
    values[at(cable.wrap_count)] = static_cast<double>(report.wraps.size());
    write_pieces(cable, ropes.pieces(c), values);
  }
}

}  // namespace sheave::view
