#include "engine/joint_report.h"

#include "engine/joint_feature.h"
#include "engine/substep.h"
#include "engine/world.h"

namespace sheave {

struct JointReader::Content {
  /// The location of a joint among the features.
  struct Place {
    std::size_t feature = 0;
    int index = 0;
  };

  explicit Content(const World& of) : world(of), now(of.bodies(), of.state(), 1.0, 1) {}

  const World& world;
  Substep now;
  std::vector<Place> places;
};

JointReader::JointReader(const World& world) : content_(std::make_unique<Content>(world)) {
  // A feature holds all joints of one type, in the order of the model.
  struct Course {
    std::string_view type;
    Content::Place next;
  };
  std::vector<Course> courses;
  for (std::size_t i = 0; i < world.features().size(); ++i) {
    const auto* joints = dynamic_cast<const JointFeature*>(world.features()[i].get());
    if (joints != nullptr) courses.push_back({joints->type(), {i, 0}});
  }
  for (const auto& joint : world.model().joints) {
    for (Course& course : courses) {
      if (course.type != joint->type()) continue;
      content_->places.push_back(course.next);
      ++course.next.index;
    }
  }
}

JointReader::~JointReader() = default;
JointReader::JointReader(JointReader&&) noexcept = default;
JointReader& JointReader::operator=(JointReader&&) noexcept = default;

JointReport JointReader::report(int joint) const {
  const Content::Place& place = content_->places[static_cast<std::size_t>(joint)];
  const auto& feature =
      static_cast<const JointFeature&>(*content_->world.features()[place.feature]);
  return feature.report(place.index, content_->now, content_->world.feature_state(place.feature));
}

std::vector<JointReport> joint_reports(const World& world) {
  const std::size_t count = world.model().joints.size();
  std::vector<JointReport> reports;
  if (count == 0) return reports;
  reports.reserve(count);
  const JointReader reader(world);
  for (std::size_t i = 0; i < count; ++i) reports.push_back(reader.report(static_cast<int>(i)));
  return reports;
}

}  // namespace sheave
