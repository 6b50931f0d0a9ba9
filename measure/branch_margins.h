#pragma once
// Branches of a motion, and how far the motion is from the other branch.
//
// A motion with contacts, ropes and friction consists of smooth pieces. Each piece belongs to one branch
// of every alternative: a span is taut or slack, a link holds the cable or lets it slide, two bodies
// touch or do not, and so on. The distance of a state from the other branch is a margin >= 0 that becomes
// 0 where the branch changes:
//
//   span is taut         tension [N]
//   span is slack        rest length - length [m]
//   link holds           1 - |ln(T1 / T2)| / (m a): the unused share of the capstan's exponent
//   bodies touch         sum of the normal forces of their points [N]
//   contact sticks       1 - |F| / (m N): the unused share of the friction, of the sums over all points
//   bodies are apart     least gap of the points within reach [m]
//   coordinate is free   distance from its stop [m or rad]
//
// Bodies are within reach if their present velocities, or free fall, close the gap within four steps.
//
// A link or a contact that slides, and a coordinate at its stop, have no margin: no quantity of a state
// becomes 0 where these branches end.

#include <compare>
#include <memory>
#include <string>
#include <vector>

#include "cable/simulation.h"
#include "scenes/scene.h"

namespace sheave {
class ContactFinder;
}

namespace sheave::measure {

enum class Alternative { span, link, touch, contact, stop };

/// An alternative of a machine: the cable and the span or link, the two bodies, or the joint and the
/// stop (twice the coordinate, plus 1 for the upper one).
struct AlternativeKey {
  Alternative kind = Alternative::span;
  int first = 0;
  int second = 0;
  [[nodiscard]] auto operator<=>(const AlternativeKey&) const = default;
};

/// The branch of an alternative in a state.
struct BranchMargin {
  AlternativeKey key;
  bool second_branch = false;  ///< slack, slides, apart or at the stop
  double margin = -1.0;        ///< distance from the other branch, >= 0; < 0: none is known
  bool is_length = false;      ///< or an angle: continuous with its rate, unlike a force
};

/// Reads the branches of one machine.
class BranchReader {
 public:
  /// For runs of this scene; `start`, one of them, must outlive the reader.
  BranchReader(const Scene& scene, const Simulation& start);
  ~BranchReader();
  BranchReader(BranchReader&&) noexcept;
  BranchReader& operator=(BranchReader&&) noexcept;
  /// Replaces the list by the branches after the last substep of a run, in no order. The friction of
  /// links is that of the scene, or of the control that sets it.
  void read(const Simulation& run, std::vector<BranchMargin>& list);
  /// The alternative in words, such as "span rope.0".
  [[nodiscard]] std::string name_of(const AlternativeKey& key) const;
  /// Whether the alternative is the stop of an angle.
  [[nodiscard]] bool is_angle(const AlternativeKey& key) const;

 private:
  struct Link {
    int cable = 0;
    int link = 0;
    int control = 0;  // index among the links of all cables
    double friction = 0.0;
  };
  struct Stop {
    AlternativeKey key;
    std::size_t coordinate = 0;
    double at = 0.0;
    double side = 1.0;  // +1: the coordinate stays above
    bool angle = false;
    std::string name;
  };
  void read_cables(const Simulation& run, std::vector<BranchMargin>& list) const;
  void read_contacts(const World& world, std::vector<BranchMargin>& list);
  void read_stops(const World& world, std::vector<BranchMargin>& list) const;
  void find_stops(const Scene& scene);
  [[nodiscard]] double static_friction(const Model& model, int body_a, int body_b) const;

  std::vector<std::string> cables_;
  std::vector<std::string> bodies_;
  std::vector<Link> links_;  // with friction
  std::vector<Stop> stops_;
  double scale_ = 1.0;
  std::unique_ptr<ContactFinder> finder_;  // null without colliders
};

}  // namespace sheave::measure
