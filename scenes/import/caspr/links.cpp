// <link_rigid>: joint, mass and parent. All types of joints are slides along axes, then turns about
// axes, each after those before it.

#include <array>
#include <map>

#include <fmt/format.h>

#include "engine/index.h"
#include "engine/number_text.h"
#include "scenes/import/caspr/reader.h"
#include "scenes/import/mjcf/pose.h"

namespace sheave::import::caspr {
namespace {

using mjcf::JointType;

/// The motions of a type in the order of its coordinates: (t) along or (r) about x, y and z. Turns
/// of "fixed" angles are about axes that stay.
struct TypeMotions {
  std::string_view type;
  std::string_view motions;
};
constexpr std::array<TypeMotions, 17> types{{{"R_X", "rx"},
                                             {"R_Y", "ry"},
                                             {"R_Z", "rz"},
                                             {"U_XY", "rx ry"},
                                             {"U_YZ", "ry rz"},
                                             {"U_XZ", "rx rz"},
                                             {"P_X", "tx"},
                                             {"P_Y", "ty"},
                                             {"P_Z", "tz"},
                                             {"P_XY", "tx ty"},
                                             {"P_XZ", "tx tz"},
                                             {"PLANAR_XY", "tx ty rz"},
                                             {"PLANAR_YZ", "ty tz rx"},
                                             {"PLANAR_XZ", "tx tz ry"},
                                             {"T_XYZ", "tx ty tz"},
                                             {"S_EULER_XYZ", "rx ry rz"},
                                             {"SPATIAL_EULER_XYZ", "tx ty tz rx ry rz"}}};
// Of a body between two slides, over the mass of the link.
constexpr double small_part = 1e-4;

class LinkReader {
 public:
  LinkReader(const xml::Element& element, mjcf::Model& model, opensim::Properties& properties,
             Log& log)
      : element_(element), model_(model), properties_(properties), log_(log) {}

  /// `numbers` are those of the bodies of links before, by the number of the link.
  void read(std::map<int, int>& numbers) {
    const int parent = parent_of(numbers);
    read_joint();
    if (log_.failed()) return;
    const mjcf::Inertial inertial = read_physical();
    if (log_.failed()) return;
    add_bodies(parent, inertial);
    if (log_.failed()) return;
    numbers[static_cast<int>(numbers.size())] = static_cast<int>(model_.bodies.size()) - 1;
    log_.same(element_, "a body");
  }

 private:
  int parent_of(const std::map<int, int>& numbers) {
    const xml::Element* const parent = properties_.child(element_, "parent");
    if (parent == nullptr) {
      log_.error(element_, "<parent> is missing", {}, FaultCode::missing_key);
      return 0;
    }
    const double number = properties_.number(*parent, "num").value_or(-1.0);
    frame_.position = properties_.vector(*parent, "location").value_or(Vector3::Zero());
    const auto found =
        number >= 0.0 && number < 1e6 ? numbers.find(static_cast<int>(number)) : numbers.end();
    const std::string* const own = element_.value("num");
    const auto wanted = own == nullptr ? std::nullopt : parse_numbers(*own, 1);
    if (!wanted || wanted->size() != 1 || wanted->front() != static_cast<double>(numbers.size())) {
      log_.error(element_, "links must have the numbers 1, 2, ... in the order of the text",
                 own == nullptr ? "" : *own, FaultCode::meaning);
    }
    if (found == numbers.end()) {
      log_.error(*parent, "<num> must be 0 or the number of a link before",
                 properties_.text(*parent, "num"), FaultCode::meaning);
      return 0;
    }
    return found->second;
  }

  void read_joint() {
    const xml::Element* const joint = properties_.child(element_, "joint");
    if (joint == nullptr) {
      log_.error(element_, "<joint> is missing", {}, FaultCode::missing_key);
      return;
    }
    joint_ = joint;
    Attributes attributes(*joint, nullptr, log_);
    std::string type = attributes.text("type").value_or("");
    fixed_ = type == "S_FIXED_XYZ";
    if (fixed_) type = "S_EULER_XYZ";
    for (const TypeMotions& one : types) {
      if (one.type == type) motions_ = one.motions;
    }
    if (motions_.empty()) {
      std::string known = "S_FIXED_XYZ";
      for (const TypeMotions& one : types) known += ", " + std::string(one.type);
      attributes.error("type", "one of " + known, FaultCode::unknown_choice);
      return;
    }
    const std::size_t count = (motions_.size() + 1) / 3;
    start_ = attributes.numbers("q_initial", count, count);
    start_.resize(count, 0.0);
    static_cast<void>(attributes.text("q_min"));
    static_cast<void>(attributes.text("q_max"));
    attributes.finish({});
    log_.changed(*joint, "not taken: q_min and q_max, which bound the search of a workspace");
  }

  [[nodiscard]] int slides() const {
    int count = 0;
    for (const char c : motions_) count += c == 't' ? 1 : 0;
    return count;
  }
  [[nodiscard]] int turns() const { return static_cast<int>(start_.size()) - slides(); }
  [[nodiscard]] Vector3 axis(std::size_t i) const {
    return Vector3::Unit(motions_[3 * i + 1] - 'x');
  }

  mjcf::Inertial read_physical() {
    mjcf::Inertial made;
    const xml::Element* const physical = properties_.child(element_, "physical");
    const xml::Element* const tensor =
        physical == nullptr ? nullptr : properties_.child(*physical, "inertia");
    if (tensor == nullptr) {
      log_.error(element_, "<physical> with <inertia> is missing", {}, FaultCode::missing_key);
      return made;
    }
    made.mass = properties_.positive(*physical, "mass").value_or(0.0);
    made.center = properties_.vector(*physical, "com_location").value_or(Vector3::Zero());
    static_cast<void>(properties_.child(*physical, "end_location"));
    const auto number = [&](const char* name) {
      return properties_.number(*tensor, name).value_or(0.0);
    };
    Matrix3& i = made.inertia;
    i.diagonal() = Vector3(number("Ixx"), number("Iyy"), number("Izz"));
    i(0, 1) = i(1, 0) = number("Ixy");
    i(0, 2) = i(2, 0) = number("Ixz");
    i(1, 2) = i(2, 1) = number("Iyz");
    const std::string* const about = tensor->value("ref");
    if (about != nullptr && *about == "joint") {
      const Vector3& d = made.center;
      i -= made.mass * (d.squaredNorm() * Matrix3::Identity() - d * d.transpose());
    } else if (about != nullptr && *about != "com") {
      log_.error(*tensor, "ref must be com or joint", *about, FaultCode::unknown_choice);
    }
    if (turns() == 0 && !(i.diagonal().minCoeff() > 0.0)) {
      // The link does not turn, so any tensor is as good.
      i = made.mass * Matrix3::Identity();
      log_.same(*tensor, "the link does not turn");
    }
    return made;
  }

  int add_joint(JointType type, const Vector3& axis, int body, const std::string& name) {
    mjcf::Joint joint;
    joint.element = joint_;
    joint.name = name;
    joint.type = type;
    joint.body = body;
    joint.axis = axis;
    joint.qpos = model_.position_count;
    joint.qvel = model_.velocity_count;
    model_.position_count += joint.position_count();
    model_.velocity_count += joint.velocity_count();
    const int number = static_cast<int>(model_.joints.size());
    model_.bodies[at(body)].joints.push_back(number);
    model_.joints.push_back(std::move(joint));
    return number;
  }

  int add_body(int parent, const mjcf::Frame& frame, const std::string& name,
               const mjcf::Inertial& inertial) {
    mjcf::Body body;
    body.element = &element_;
    body.name = name;
    body.parent = parent;
    body.frame = frame;
    body.given = body.inertial = inertial;
    model_.bodies.push_back(std::move(body));
    return static_cast<int>(model_.bodies.size()) - 1;
  }

  /// The orientation by the turns of the start.
  [[nodiscard]] Quaternion turned() const {
    Quaternion whole = Quaternion::Identity();
    for (std::size_t i = 0; i < start_.size(); ++i) {
      if (motions_[3 * i] != 'r') continue;
      const Quaternion one = mjcf::turn_about(axis(i), start_[i]);
      whole = fixed_ ? one * whole : whole * one;
    }
    return whole;
  }

  void push(const std::vector<double>& values) {
    model_.start_positions.insert(model_.start_positions.end(), values.begin(), values.end());
  }

  void add_bodies(int parent, const mjcf::Inertial& inertial) {
    const std::string* const given = element_.value("name");
    const std::string name = given == nullptr ? "link" : *given;
    const Quaternion turn = turned();
    if (turns() == 3 && slides() == 3) {
      if (parent != 0) {
        log_.error(*joint_, "a link with six coordinates must have the parent 0", {},
                   FaultCode::meaning);
        return;
      }
      mjcf::Frame frame = frame_;
      frame.position += Vector3(start_[0], start_[1], start_[2]);
      frame.orientation = turn;
      add_joint(JointType::free, Vector3::UnitZ(), add_body(0, frame, name, inertial), name);
      const Vector3& p = frame.position;
      push({p.x(), p.y(), p.z(), turn.w(), turn.x(), turn.y(), turn.z()});
      return;
    }
    if (turns() == 3) {
      const int body = add_body(parent, frame_, name, inertial);
      add_joint(JointType::ball, Vector3::UnitZ(), body, name + " joint");
      push({turn.w(), turn.x(), turn.y(), turn.z()});
      return;
    }
    // Slides alone have a small body between each two.
    const bool apart = turns() == 0 && slides() > 1;
    mjcf::Inertial small = inertial;
    small.mass *= small_part;
    small.inertia *= small_part;
    mjcf::Frame frame = frame_;
    int body = 0;
    for (std::size_t i = 0; i < start_.size(); ++i) {
      const bool last = i + 1 == start_.size();
      if (i == 0 || apart) {
        body =
            add_body(parent, frame, apart && !last ? fmt::format("{} axis {}", name, i + 1) : name,
                     apart && !last ? small : inertial);
        parent = body;
        frame = {};
      }
      add_joint(motions_[3 * i] == 't' ? JointType::slide : JointType::hinge, axis(i), body,
                fmt::format("{} q{}", name, i + 1));
    }
    push(start_);
    if (apart) {
      log_.changed(element_, fmt::format("{} small bodies between the slides, each of {} kg",
                                         start_.size() - 1, number_text(small.mass, 6)));
    }
  }

  const xml::Element& element_;
  mjcf::Model& model_;
  opensim::Properties& properties_;
  Log& log_;
  const xml::Element* joint_ = nullptr;
  std::string_view motions_;
  bool fixed_ = false;
  std::vector<double> start_;
  mjcf::Frame frame_;  ///< of the joint in the parent
};

}  // namespace

void read_links(const xml::Element& root, mjcf::Model& model, opensim::Properties& properties,
                Log& log) {
  const xml::Element* const links = properties.child(root, "links");
  if (links == nullptr) {
    log.error(root, "<links> is missing", {}, FaultCode::missing_key);
    return;
  }
  // Links are found by their numbers; 0 is the world.
  std::map<int, int> numbers{{0, 0}};
  for (const xml::Element& element : links->children) {
    if (element.tag != "link_rigid") {
      log.error(element, "no link that is known here; allowed is link_rigid", {},
                FaultCode::unknown_key);
      return;
    }
    properties.mark(element);
    LinkReader(element, model, properties, log).read(numbers);
    if (log.failed()) return;
    model.body_names.emplace(fmt::format("link {}", numbers.size() - 1), numbers.rbegin()->second);
  }
}

}  // namespace sheave::import::caspr
