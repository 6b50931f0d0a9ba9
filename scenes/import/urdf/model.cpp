// <robot>: the tree of links and joints, and the start.

#include <map>
#include <set>

#include <fmt/format.h>

#include "engine/index.h"
#include "scenes/import/mjcf/pose.h"
#include "scenes/import/urdf/reader.h"

namespace sheave::import::urdf {
namespace {

/// A named <link>, with the joint above it and those below it.
struct Link {
  const xml::Element* element = nullptr;
  const xml::Element* joint = nullptr;  ///< to its parent; null: a root
  std::vector<std::string> children;    ///< in the order of the text
};

class TreeReader {
 public:
  TreeReader(const xml::Element& root, Log& log, const std::string& folder)
      : root_(root), log_(log), meshes_(model_) {
    model_.folder = folder;
    model_.file = *root.file;
  }

  mjcf::Model read() {
    if (const std::string* name = root_.value("name")) model_.name = *name;
    model_.format = "URDF";
    model_.compiler.from_geoms = mjcf::FromGeoms::never;
    mjcf::Body world;
    world.element = &root_;
    world.name = "world";
    model_.bodies.push_back(std::move(world));
    for (const xml::Element& child : root_.children) look_at(child);
    for (const xml::Element* joint : joints_) connect(*joint);
    if (!log_.failed()) grow();
    if (!log_.failed()) {
      find_masses_of_shapes(model_, log_);
      for (const xml::Element* joint : joints_) read_mimic(*joint, model_, log_);
      set_start();
    }
    return std::move(model_);
  }

 private:
  /// The name of an element; null with an error if it has none, or another one has it.
  const std::string* name_of(const xml::Element& element, std::set<std::string>& taken) {
    const std::string* const name = element.value("name");
    if (name == nullptr || name->empty()) {
      log_.error(element, "\"name\" is missing", {}, FaultCode::missing_key);
      return nullptr;
    }
    if (taken.insert(*name).second) return name;
    log_.error(element, "another element of its kind has the same name", *name,
               FaultCode::duplicate_name);
    return nullptr;
  }

  void look_at(const xml::Element& child) {
    if (child.tag == "link") {
      if (const std::string* name = name_of(child, link_names_)) links_[*name].element = &child;
    } else if (child.tag == "joint") {
      if (name_of(child, joint_names_) != nullptr) joints_.push_back(&child);
    } else if (child.tag.starts_with("xacro:")) {
      log_.error(child, "the text is one for xacro; run xacro on it first", {},
                 FaultCode::unknown_key);
    } else if (child.tag == "transmission") {
      log_.skipped(child, "a joint of the scene can have a drive, and an inertia by a coupling");
    } else {
      log_.skipped(child, child.tag == "material" ? "looks have no counterpart"
                                                  : "no part of a robot that is known here");
    }
  }

  /// The name of the parent or the child of a joint; null with an error if there is no such link.
  const std::string* end_of(const xml::Element& joint, std::string_view tag) {
    const xml::Element* const end = child_of(joint, tag, log_);
    const std::string* const name = end == nullptr ? nullptr : end->value("link");
    if (name == nullptr) {
      log_.error(joint, fmt::format("<{} link=...> is missing", tag), {}, FaultCode::missing_key);
      return nullptr;
    }
    if (links_.contains(*name)) return name;
    log_.error(*end, "there is no link of this name", *name, FaultCode::meaning);
    return nullptr;
  }

  void connect(const xml::Element& joint) {
    const std::string* const parent = end_of(joint, "parent");
    const std::string* const child = end_of(joint, "child");
    if (parent == nullptr || child == nullptr) return;
    Link& link = links_[*child];
    if (link.joint != nullptr) {
      log_.error(joint,
                 fmt::format("the link \"{}\" has another parent; links form a tree", *child), {},
                 FaultCode::meaning);
      return;
    }
    link.joint = &joint;
    links_[*parent].children.push_back(*child);
  }

  /// Adds the bodies from the roots on, each behind its parent.
  void grow() {
    /// A link whose parent has been added.
    struct Next {
      std::string name;
      int parent = 0;
      mjcf::Frame frame;  ///< of the parent, in the world
    };
    std::vector<Next> next;
    for (const xml::Element& child : root_.children) {
      if (child.tag != "link") continue;
      const std::string& name = *child.value("name");
      if (links_[name].joint == nullptr) next.push_back({name, 0, {}});
    }
    if (next.size() != 1) {
      log_.error(root_,
                 fmt::format("the links form a tree with one root; there are {} links that "
                             "are no child of a joint",
                             next.size()),
                 {}, FaultCode::meaning);
      return;
    }
    // The children of a link before its siblings, as MuJoCo numbers them.
    std::size_t added = 0;
    for (; !next.empty(); ++added) {
      const Next now = next.back();
      next.pop_back();
      const Link& link = links_[now.name];
      const mjcf::Frame frame = add(link, now.parent, now.frame);
      const int number = static_cast<int>(model_.bodies.size()) - 1;
      for (std::size_t k = link.children.size(); k-- > 0;) {
        next.push_back({link.children[k], number, frame});
      }
    }
    if (added == links_.size()) return;
    log_.error(root_, "some joints form a loop; links form a tree", {}, FaultCode::meaning);
  }

  /// Adds a body; returns its frame in the world in the pose of the text.
  mjcf::Frame add(const Link& link, int parent, const mjcf::Frame& outer) {
    const int number = static_cast<int>(model_.bodies.size());
    mjcf::Body body;
    body.element = link.element;
    body.name = *link.element->value("name");
    body.parent = parent;
    if (link.joint != nullptr) body.frame = read_origin(*link.joint, log_);
    const mjcf::Frame frame = outer * body.frame;
    model_.body_names.emplace(body.name, number);
    model_.bodies.push_back(std::move(body));
    if (link.joint != nullptr) read_joint(*link.joint, number, model_, log_);
    mjcf::Body& own = model_.bodies.back();
    if (!own.joints.empty() &&
        model_.joints[at(own.joints.front())].type == mjcf::JointType::free) {
      // A free body does not move with its parent.
      own.parent = 0;
      own.frame = frame;
    }
    read_link(*link.element, number, model_, meshes_, log_);
    if (link.joint == nullptr) {
      log_.changed(*link.element, "the root stands still; a joint of the type floating frees it");
    }
    return frame;
  }

  /// Starts joints that mimic others where those at 0 put them.
  void set_start() {
    std::vector<double> start = mjcf::reference_positions(model_);
    // A chain of n equalities is satisfied after n rounds, if it has no loop.
    bool changed = true;
    for (std::size_t round = 0; changed && round <= model_.equalities.size(); ++round) {
      changed = false;
      for (const mjcf::Equality& equality : model_.equalities) {
        double& own = start[at(model_.joints[at(equality.joint1)].qpos)];
        const double other = start[at(model_.joints[at(equality.joint2)].qpos)];
        const double wanted = equality.polynomial[0] + equality.polynomial[1] * other;
        changed = changed || own != wanted;
        own = wanted;
      }
    }
    model_.start_positions = std::move(start);
  }

  const xml::Element& root_;
  Log& log_;
  mjcf::Model model_;
  MeshReader meshes_;
  std::map<std::string, Link> links_;
  std::set<std::string> link_names_;
  std::set<std::string> joint_names_;
  std::vector<const xml::Element*> joints_;
};

}  // namespace

mjcf::Model read_model(const xml::Element& root, Log& log, const std::string& folder) {
  return TreeReader(root, log, folder).read();
}

}  // namespace sheave::import::urdf
