#include "measure/branch_margins.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "cable/cable_system.h"
#include "cable/link_geometry.h"
#include "engine/body_set.h"
#include "engine/contacts/contact_finder.h"
#include "engine/contacts/contact_report.h"
#include "engine/controls.h"
#include "engine/joint_report.h"
#include "engine/substep.h"
#include "scenes/format.h"

namespace sheave::measure {
namespace {

/// A coordinate so near its stop, as a share of the size of the scene, touches the stop.
constexpr double touching_share = 1e-9;
/// Bodies are within reach if they can touch in so many steps.
constexpr double steps_of_reach = 4.0;

/// The numbers of the fields of a joint whose names end in this.
std::vector<std::pair<std::string_view, double>> numbers_of(const JointDef& joint,
                                                            std::string_view ending) {
  std::vector<std::pair<std::string_view, double>> numbers;
  const Variant* variant = joint_format().variant(joint.type());
  if (variant == nullptr) return numbers;
  for (const Field& field : variant->table.fields) {
    if (!field.name.ends_with(ending)) continue;
    // Slots serve reading and writing; this code only reads.
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-const-cast)
    const FieldSlot slot = field.slot(const_cast<void*>(joint.settings()));
    const auto* number = std::get_if<std::optional<double>*>(&slot);
    if (number != nullptr && **number) numbers.emplace_back(field.name, ***number);
  }
  return numbers;
}

/// The coordinate to which a field belongs: the only one, or that with whose name the field begins.
std::optional<std::size_t> coordinate_of(const JointDef& joint, std::string_view field) {
  const std::span<const JointCoordinateInfo> all = joint.coordinates();
  if (all.size() == 1) return 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (field.starts_with(all[i].name)) return i;
  }
  return {};
}

/// The span that begins at a link of a report, wraps included, and the one that ends there.
std::pair<double, double> tensions_at(const CableReport& cable, std::size_t link) {
  const std::size_t count = cable.spans.size();
  const double after = link < count ? cable.spans[link].tension : 0.0;
  const std::size_t last = link > 0 ? link - 1 : count - 1;
  double before = last < count ? cable.spans[last].tension : 0.0;
  for (const WrapReport& wrap : cable.wraps) {
    if (wrap.after == static_cast<int>(last)) before = wrap.span.tension;
  }
  return {before, after};
}

}  // namespace

BranchReader::BranchReader(const Scene& scene, const Simulation& start)
    : scale_(start.world.bodies().scale()) {
  for (int i = 0; i < start.world.bodies().count(); ++i) {
    bodies_.push_back(start.world.bodies().name(i));
  }
  int control = 0;
  for (std::size_t i = 0; i < scene.cables.size(); ++i) {
    const CableDef& cable = scene.cables[i];
    cables_.push_back(cable.name);
    for (std::size_t k = 0; k < cable.links.size(); ++k, ++control) {
      const Result<LinkGeometry> geometry = cable.links[k]->compile(start.world.bodies(), "");
      // Spans at the ends of an open cable have no neighbour.
      const bool inner = cable.closed || (k > 0 && k + 1 < cable.links.size());
      if (!geometry || !inner || !(geometry->friction > 0.0)) continue;
      links_.push_back({static_cast<int>(i), static_cast<int>(k), control, geometry->friction});
    }
  }
  find_stops(scene);
  const Model& model = start.world.model();
  if (model.colliders.empty()) return;
  finder_ = std::make_unique<ContactFinder>(model, start.world.bodies());
}

void BranchReader::find_stops(const Scene& scene) {
  for (std::size_t j = 0; j < scene.model.joints.size(); ++j) {
    const JointDef& joint = *scene.model.joints[j];
    for (const bool upper : {false, true}) {
      for (const auto& [field, at] : numbers_of(joint, upper ? "upper" : "lower")) {
        const std::optional<std::size_t> coordinate = coordinate_of(joint, field);
        if (!coordinate) continue;
        const int second = 2 * static_cast<int>(*coordinate) + (upper ? 1 : 0);
        stops_.push_back({{Alternative::stop, static_cast<int>(j), second},
                          *coordinate,
                          at,
                          upper ? -1.0 : 1.0,
                          joint.coordinates()[*coordinate].angle,
                          fmt::format("stop {} of {}", field, joint.name)});
      }
    }
  }
}

BranchReader::~BranchReader() = default;
BranchReader::BranchReader(BranchReader&&) noexcept = default;
BranchReader& BranchReader::operator=(BranchReader&&) noexcept = default;

void BranchReader::read(const Simulation& run, std::vector<BranchMargin>& list) {
  list.clear();
  if (run.cables != nullptr) read_cables(run, list);
  read_contacts(run.world, list);
  read_stops(run.world, list);
}

void BranchReader::read_cables(const Simulation& run, std::vector<BranchMargin>& list) const {
  const std::vector<CableReport> reports = run.cable_reports();
  for (std::size_t i = 0; i < reports.size(); ++i) {
    if (reports[i].cut) continue;
    for (std::size_t k = 0; k < reports[i].spans.size(); ++k) {
      const SpanReport& span = reports[i].spans[k];
      if (span.hangs) continue;
      const bool slack = !(span.tension > 0.0);
      const double margin = slack ? std::max(0.0, span.rest_length - span.length) : span.tension;
      list.push_back(
          {{Alternative::span, static_cast<int>(i), static_cast<int>(k)}, slack, margin, slack});
    }
  }
  const FeatureState& own = run.world.state().features.back();
  for (const Link& link : links_) {
    const CableReport& cable = reports[static_cast<std::size_t>(link.cable)];
    const LinkReport& report = cable.links[static_cast<std::size_t>(link.link)];
    if (cable.cut || !report.touched) continue;
    const auto [before, after] = tensions_at(cable, static_cast<std::size_t>(link.link));
    const double low = std::min(before, after);
    const LinkControl* set = run.world.state().controls.links.find(link.control);
    const bool is_set = set != nullptr && !std::isnan(set->friction);
    const double exponent = (is_set ? set->friction : link.friction) * report.wrap_angle;
    BranchMargin own_margin{{Alternative::link, link.cable, link.link}};
    own_margin.second_branch = own.integers[CableSystem::slip_state_index(link.control)] != 0;
    if (!own_margin.second_branch && low > 0.0 && exponent > 0.0) {
      const double used = std::log(std::max(before, after) / low) / exponent;
      own_margin.margin = std::max(0.0, 1.0 - used);
    }
    list.push_back(own_margin);
  }
}

double BranchReader::static_friction(const Model& model, int body_a, int body_b) const {
  double product = 1.0;
  for (const int body : {body_a, body_b}) {
    const auto own = std::ranges::find_if(
        model.colliders, [&](const ColliderDef& c) { return c.body.index == body; });
    if (own == model.colliders.end()) return 0.0;
    product *= own->static_friction.value_or(own->friction);
  }
  return std::sqrt(product);
}

void BranchReader::read_contacts(const World& world, std::vector<BranchMargin>& list) {
  if (finder_ == nullptr) return;
  struct Pair {
    double gap = std::numeric_limits<double>::infinity();
    double pressed = 0.0;
    Vector3 dragged = Vector3::Zero();
    bool sticks = false;
  };
  std::map<std::pair<int, int>, Pair> pairs;
  const double reach = steps_of_reach * world.model().step.dt;
  const Substep now(world.bodies(), world.state(), reach, 1);
  finder_->find(now, [&](const FormPair& forms, const Manifold& manifold) {
    const auto body = [&](int form) {
      return finder_->forms()[static_cast<std::size_t>(form)].body;
    };
    Pair& pair = pairs[{body(forms.a), body(forms.b)}];
    for (const ContactPoint& point : manifold.points) pair.gap = std::min(pair.gap, point.gap);
    return true;
  });
  for (const ContactReport& point : world.contacts()) {
    Pair& pair = pairs[{point.body_a.index, point.body_b.index}];
    pair.pressed += point.normal_force;
    pair.dragged += point.friction_force;
    pair.sticks = pair.sticks || (point.sticks && point.normal_force > 0.0);
  }
  for (const auto& [bodies, pair] : pairs) {
    const bool apart = !(pair.pressed > 0.0);
    const double open = apart ? std::max(0.0, pair.gap) : pair.pressed;
    list.push_back({{Alternative::touch, bodies.first, bodies.second}, apart, open, apart});
    const double friction = static_friction(world.model(), bodies.first, bodies.second);
    if (apart || !(friction > 0.0)) continue;
    const double left = std::max(0.0, 1.0 - pair.dragged.norm() / (friction * pair.pressed));
    list.push_back({{Alternative::contact, bodies.first, bodies.second},
                    !pair.sticks,
                    pair.sticks ? left : -1.0});
  }
}

void BranchReader::read_stops(const World& world, std::vector<BranchMargin>& list) const {
  if (stops_.empty()) return;
  const JointReader reader(world);
  for (const Stop& stop : stops_) {
    const JointReport report = reader.report(stop.key.first);
    if (report.broken_at) continue;
    const JointCoordinateReport& coordinate = report.coordinates[stop.coordinate];
    const double left = stop.side * (coordinate.value - stop.at);
    const bool touches = left <= touching_share * (coordinate.angle ? 1.0 : scale_);
    list.push_back({stop.key, touches, touches ? -1.0 : left, true});
  }
}

bool BranchReader::is_angle(const AlternativeKey& key) const {
  const auto own = std::ranges::find(stops_, key, &Stop::key);
  return own != stops_.end() && own->angle;
}

std::string BranchReader::name_of(const AlternativeKey& key) const {
  const auto body = [&](int index) {
    return index < 0 ? std::string("the world") : bodies_[static_cast<std::size_t>(index)];
  };
  switch (key.kind) {
    case Alternative::span:
      return fmt::format("span {}.{}", cables_[static_cast<std::size_t>(key.first)], key.second);
    case Alternative::link:
      return fmt::format("link {} of {}", key.second, cables_[static_cast<std::size_t>(key.first)]);
    case Alternative::touch:
      return fmt::format("contact of {} and {}", body(key.first), body(key.second));
    case Alternative::contact:
      return fmt::format("friction of {} and {}", body(key.first), body(key.second));
    case Alternative::stop: {
      const auto own = std::ranges::find(stops_, key, &Stop::key);
      return own == stops_.end() ? "stop" : own->name;
    }
  }
  return "";
}

}  // namespace sheave::measure
