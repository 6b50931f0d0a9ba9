// Couplings of joints: fixed tendons, equalities of joints, and armatures.
//
// A fixed tendon has the length L = sum of coef q. A coupling has the travel L - L0 with L0 at the
// start, so the ends of its range and its spring are shifted by L0.
//
// An equality of joints, q1 - r1 = P(q2 - r2) with the reference coordinates r, is a held coupling
// with the travel u - (P(x + v) - P(x)), where u and v are the changes of q1 and q2 since the start
// and x = q2 - r2 at the start.
//
// An armature A adds A to one diagonal element of the mass matrix: the inertia of a flywheel on an
// axle of the world that turns like the coordinate. The scene has a rotor and a held coupling for
// an armature, except where the joint's axis stands still, so that the body can have the inertia.

#include <algorithm>
#include <array>
#include <set>

#include <fmt/format.h>

#include "engine/index.h"
#include "engine/joints/coupling.h"
#include "engine/number_text.h"
#include "engine/row.h"
#include "scenes/import/mjcf/scene.h"

namespace sheave::import::mjcf {
namespace {

class CouplingWriter {
 public:
  explicit CouplingWriter(Writer& writer) : writer_(writer) {
    for (const Json& joint : joints()) {
      static_cast<void>(names_.take(joint["name"].get_ref<const std::string&>(), ""));
    }
    for (const Json& body : writer.scene["bodies"]) {
      static_cast<void>(body_names_.take(body["name"].get_ref<const std::string&>(), ""));
    }
  }

  void write_tendon(const Tendon& tendon, const std::optional<Drive>& drive) {
    std::vector<std::pair<int, double>> terms;
    double start = 0.0;
    double reference = 0.0;
    for (const TendonJoint& one : tendon.joints) {
      const auto place = at(writer_.model.joints[at(one.joint)].qpos);
      start += one.factor * writer_.start.positions[place];
      reference += one.factor * writer_.reference.positions[place];
      if (one.factor != 0.0) terms.emplace_back(one.joint, one.factor);
    }
    Json coupling = begin(tendon.name, "tendon", terms);
    if (!fault_.empty()) return writer_.log.skipped(*tendon.element, fault_);
    coupling["held"] = false;
    write_range(tendon, start, coupling);
    write_spring(tendon, start, reference, coupling);
    double damping = tendon.damping;
    if (drive) {
      damping += drive->damping;
      coupling["drive"] = drive->to_position ? "position" : "force";
      coupling["drive_values"] = {drive->to_position ? drive->value - start : drive->value};
      if (drive->to_position) coupling["drive_compliance"] = drive->compliance;
      if (drive->to_position && drive->limit) coupling["drive_limit"] = *drive->limit;
    }
    if (damping > 0.0) coupling["damping"] = damping;
    finish(
        *tendon.element, std::move(coupling),
        fmt::format("whose travel is the length of the tendon less {} m", number_text(start, 6)));
  }

  void write_equality(const Equality& equality) {
    const auto start = [&](int number) {
      const auto place = at(writer_.model.joints[at(number)].qpos);
      return writer_.start.positions[place] - writer_.reference.positions[place];
    };
    std::vector<std::pair<int, double>> terms;
    std::vector<double> curve;
    double off = start(equality.joint1) - equality.polynomial[0];
    if (equality.joint2 >= 0) {
      const Polynomial shifted = at_start(equality.polynomial, start(equality.joint2));
      off = start(equality.joint1) - shifted[0];
      // MJCF has five factors; further ones only where they count.
      std::size_t powers = shifted.size();
      while (powers > 5 && shifted[powers - 1] == 0.0) --powers;
      const bool bent = std::any_of(shifted.begin() + 2, shifted.end(),
                                    [](double factor) { return factor != 0.0; });
      if (shifted[1] != 0.0 || bent) terms.emplace_back(equality.joint2, -shifted[1]);
      const auto& second = writer_.coordinates[at(equality.joint2)];
      double sign = second ? second->sense : 1.0;
      for (std::size_t k = 2; bent && k < powers; ++k) {
        sign *= second ? second->sense : 1.0;
        curve.push_back(-shifted[k] * sign);
      }
    }
    // The curve is that of the last joint.
    terms.insert(terms.begin(), {equality.joint1, 1.0});
    Json coupling = begin(equality.name, "equality", terms);
    if (!fault_.empty()) return writer_.log.skipped(*equality.element, fault_);
    if (!curve.empty()) coupling["curve"] = curve;
    if (std::abs(off) > 1e-9) {
      writer_.log.changed(
          *equality.element,
          fmt::format("kept as at the start, where coordinate 1 is {} off", number_text(off, 6)));
    }
    if (writer_.model.is_soft) writer_.log.changed(*equality.element, "rigid, not soft");
    finish(*equality.element, std::move(coupling), "which is held");
  }

  void write_armature(std::size_t number) {
    const Joint& joint = writer_.model.joints[number];
    if (!writer_.coordinates[number]) {
      return writer_.log.changed(
          *joint.element, "not taken: armature of a joint whose coordinate a scene does not have");
    }
    const std::string name = body_names_.take("armature of " + joint.name, "armature");
    Json rotor = {{"name", name},
                  {"mobility", "rotor"},
                  {"axis", {0.0, 0.0, 1.0}},
                  {"mass", 1e-6},  // any: its centre stands still
                  {"spin_inertia", joint.armature}};
    const auto rate = at(joint.qvel);
    if (rate < writer_.velocities.size() && writer_.velocities[rate] != 0.0) {
      rotor["angular_velocity"] = {0.0, 0.0, writer_.velocities[rate]};
    }
    writer_.scene["bodies"].push_back(std::move(rotor));
    const std::string axle = names_.take("axle of " + name, "axle");
    joints().push_back({{"type", "hinge"},
                        {"name", axle},
                        {"body_b", name},
                        {"anchor", {0.0, 0.0, 0.0}},
                        {"axis", {0.0, 0.0, 1.0}}});
    Json coupling = begin(name, "armature", {{static_cast<int>(number), 1.0}});
    coupling["joints"].push_back(axle);
    coupling["joint_coordinates"].push_back("angle");
    coupling["factors"].push_back(-1.0);
    coupling["body_a"] = "world";
    coupling["body_b"] = name;
    finish(
        *joint.element, std::move(coupling),
        fmt::format("armature {} as the inertia of \"{}\"", number_text(joint.armature, 6), name));
  }

 private:
  [[nodiscard]] Json& joints() const { return writer_.scene["joints"]; }

  /// A polynomial in the change of its argument since it was x.
  static Polynomial at_start(Polynomial factors, double x) {
    for (std::size_t first = 0; first + 1 < factors.size(); ++first) {
      for (std::size_t k = factors.size() - 1; k-- > first;) factors[k] += x * factors[k + 1];
    }
    return factors;
  }

  /// A coupling of these joints; sets fault_ if there is none.
  Json begin(const std::string& wanted, const char* otherwise,
             const std::vector<std::pair<int, double>>& terms) {
    fault_.clear();
    if (terms.empty() || terms.size() > CouplingJoint::most_joints) {
      fault_ = fmt::format("it has {} joints with a factor; a coupling has 1 to {}", terms.size(),
                           CouplingJoint::most_joints);
      return {};
    }
    Json names = Json::array();
    Json coordinates = Json::array();
    Json factors = Json::array();
    std::set<int> bodies;
    for (const auto& [number, factor] : terms) {
      const Joint& joint = writer_.model.joints[at(number)];
      const auto& coordinate = writer_.coordinates[at(number)];
      if (!coordinate) {
        fault_ = fmt::format("the scene has no coordinate for the joint \"{}\"", joint.name);
        return {};
      }
      names.push_back(coordinate->joint);
      coordinates.push_back(coordinate->name);
      factors.push_back(factor * coordinate->sense);
      const int parent = writer_.model.bodies[at(joint.body)].parent;
      for (const int body : {joint.body, parent}) bodies.insert(writer_.carriers[at(body)].body);
    }
    bodies.erase(0);
    if (bodies.size() > Row::max_terms) {
      fault_ = fmt::format("its joints have {} bodies; a coupling can have {}", bodies.size(),
                           Row::max_terms);
      return {};
    }
    Json coupling = {{"type", "coupling"}, {"name", names_.take(wanted, otherwise)}};
    for (const Json& joint : joints()) {
      if (joint["name"] != names.back()) continue;
      coupling["body_a"] = joint.value("body_a", "world");
      coupling["body_b"] = joint["body_b"];
    }
    coupling["joints"] = std::move(names);
    coupling["joint_coordinates"] = std::move(coordinates);
    coupling["factors"] = std::move(factors);
    return coupling;
  }

  void finish(const xml::Element& element, Json coupling, const std::string& text) {
    const std::string name = coupling["name"].get<std::string>();
    writer_.log.same(element, fmt::format("the coupling \"{}\", {}", name, text));
    writer_.log.origin(element, fmt::format("/joints/{}", joints().size()));
    joints().push_back(std::move(coupling));
  }

  void write_range(const Tendon& tendon, double start, Json& coupling) {
    if (!tendon.range) return;
    const double lower = (*tendon.range)[0] - start;
    const double upper = (*tendon.range)[1] - start;
    if (lower > 0.0 || upper < 0.0) {
      writer_.log.changed(*tendon.element,
                          "the tendon starts outside the range; the stop is moved to the start");
    }
    coupling["lower"] = std::min(lower, 0.0);
    coupling["upper"] = std::max(upper, 0.0);
    writer_.log.changed(*tendon.element, "the limits of its range are rigid, not soft");
  }

  void write_spring(const Tendon& tendon, double start, double reference, Json& coupling) {
    if (!(tendon.stiffness > 0.0)) return;
    if (!tendon.slack) {
      coupling["stiffness"] = tendon.stiffness;
      coupling["rest"] = tendon.spring_length.value_or(reference) - start;
    } else if (!tendon.range) {
      // Without force between two lengths: elastic stops.
      coupling["lower"] = (*tendon.slack)[0] - start;
      coupling["upper"] = (*tendon.slack)[1] - start;
      coupling["limit_compliance"] = 1.0 / tendon.stiffness;
    } else {
      writer_.log.changed(*tendon.element,
                          "not taken: a springlength of two numbers beside a range");
    }
  }

  Writer& writer_;
  Names names_;
  Names body_names_;
  std::string fault_;
};

}  // namespace

bool is_armature_of_body(const Writer& writer, const Joint& joint) {
  const Body& body = writer.model.bodies[at(joint.body)];
  return joint.armature > 0.0 && body.joints.size() == 1 && !writer.carriers[at(body.parent)].moves;
}

void write_couplings(Writer& writer) {
  CouplingWriter couplings(writer);
  for (std::size_t t = 0; t < writer.model.tendons.size(); ++t) {
    const Tendon& tendon = writer.model.tendons[t];
    if (!tendon.joints.empty()) couplings.write_tendon(tendon, writer.tendon_drives[t]);
  }
  for (const Equality& equality : writer.model.equalities) {
    if (equality.type == EqualityType::joint) couplings.write_equality(equality);
  }
  for (std::size_t j = 0; j < writer.model.joints.size(); ++j) {
    const Joint& joint = writer.model.joints[j];
    if (joint.armature == 0.0 || joint.type == JointType::free) continue;
    if (!is_armature_of_body(writer, joint)) couplings.write_armature(j);
  }
}

}  // namespace sheave::import::mjcf
