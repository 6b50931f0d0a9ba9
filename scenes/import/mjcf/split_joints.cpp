// Several joints of one body act one after the other, each in the frame that those before it have
// left (pose.cpp). So a chain of bodies with one joint each moves alike: the first has the frame of
// the body in its parent, the others that of the body before, and all joints have the axes and the
// anchors that they have in the body.
//
// A body between has the part e of the mass M of the body behind it, at the same centre of mass, and
// e of the mean of its moments in all directions. The kinetic energy of the chain is that of the body
// and e times that of the same mass moved by a part of the joints. So the relative change of the mass
// matrix, and with it of accelerations, is of the order of e.

#include <fmt/format.h>

#include "engine/index.h"
#include "engine/number_text.h"
#include "scenes/import/mjcf/joint_kind.h"
#include "scenes/import/mjcf/reader.h"

namespace sheave::import::mjcf {
namespace {

constexpr double between_part = 1e-6;  // of the mass and inertia of the body behind

Inertial small_inertial(const Inertial& whole) {
  return {between_part * whole.mass, whole.center,
          between_part * whole.inertia.trace() / 3.0 * Matrix3::Identity()};
}

/// Writes the list of bodies anew, with those between.
class Splitter {
 public:
  Splitter(Model& model, Log& log) : model_(model), log_(log), masses_(carried_masses(model)) {}

  void run() {
    std::vector<Body> given = std::move(model_.bodies);
    std::vector<int> numbers;
    model_.bodies.clear();
    for (std::size_t i = 0; i < given.size(); ++i) {
      Body& body = given[i];
      if (i > 0) body.parent = numbers[at(body.parent)];
      if (is_split_[i]) add_chain(body, masses_[i]);
      numbers.push_back(static_cast<int>(model_.bodies.size()));
      model_.bodies.push_back(std::move(body));
    }
    renumber(numbers);
  }

  /// Whether any body must be split.
  bool find() {
    is_split_.assign(model_.bodies.size(), false);
    bool any = false;
    for (std::size_t i = 1; i < model_.bodies.size(); ++i) {
      const Body& body = model_.bodies[i];
      if (body.joints.size() < 2 || masses_[i].mass <= 0.0) continue;
      is_split_[i] = joint_kind(model_, static_cast<int>(i)) == JointKind::none;
      any = any || is_split_[i];
    }
    return any;
  }

 private:
  /// Adds the bodies between; the body keeps its last joint.
  void add_chain(Body& body, const Inertial& whole) {
    const Inertial small = small_inertial(whole);
    const std::size_t count = body.joints.size() - 1;
    for (std::size_t k = 0; k < count; ++k) {
      Body between;
      between.element = body.element;
      if (!body.name.empty()) between.name = fmt::format("{} axis {}", body.name, k + 1);
      between.parent = body.parent;
      between.frame = body.frame;
      between.joints = {body.joints[k]};
      between.inertial = small;
      body.parent = static_cast<int>(model_.bodies.size());
      body.frame = {};
      model_.bodies.push_back(std::move(between));
    }
    log_.changed(*model_.joints[at(body.joints.front())].element,
                 fmt::format("{} small {} between the joints of the body, each of {} kg", count,
                             count == 1 ? "body" : "bodies", number_text(small.mass, 6)));
    body.joints.erase(body.joints.begin(), body.joints.end() - 1);
  }

  void renumber(const std::vector<int>& numbers) {
    const auto move = [&](int& body) { body = numbers[at(body)]; };
    for (Geom& geom : model_.geoms) move(geom.body);
    for (Site& site : model_.sites) move(site.body);
    for (auto& [name, body] : model_.body_names) move(body);
    for (Equality& equality : model_.equalities) {
      move(equality.body1);
      move(equality.body2);
    }
    for (std::size_t i = 0; i < model_.bodies.size(); ++i) {
      for (const int joint : model_.bodies[i].joints) {
        model_.joints[at(joint)].body = static_cast<int>(i);
      }
    }
  }

  Model& model_;
  Log& log_;
  std::vector<Inertial> masses_;
  std::vector<bool> is_split_;
};

}  // namespace

void split_joints(Model& model, Log& log) {
  Splitter splitter(model, log);
  if (splitter.find()) splitter.run();
}

}  // namespace sheave::import::mjcf
