#pragma once
// Bodies that move along straight lines: sliders, and rotors on axles that do not turn.
//
// Each body has one coordinate and one speed, in flat arrays; the index of a coordinate is called
// its number. Loads and drag do not depend on positions. Their effect on a speed in a substep is
// therefore one factor and one summand, both computed once:
//   v* = keep v + push,   dq* = h v*.
// The carrier of a rotor may slide, but not turn. Number 0 stands for everything that does not
// move.

#include <optional>
#include <span>
#include <vector>

#include "engine/body_drive.h"
#include "engine/body_set.h"
#include "engine/dynamics/affine_body_kernels.h"
#include "engine/state.h"

namespace sheave {

class AffineBodies {
 public:
  /// Empty if a body of the set moves in another way. `bodies` must outlive the result.
  static std::optional<AffineBodies> of(const BodySet& bodies);

  [[nodiscard]] const BodySet& set() const { return *bodies_; }
  /// Count of numbers, with number 0 for everything that does not move.
  [[nodiscard]] std::size_t count() const { return yields_.size(); }
  /// Number of a body; 0 for a body that does not move, and for the world.
  [[nodiscard]] int number_of(int body) const { return numbers_[static_cast<std::size_t>(body)]; }
  /// Unit direction or axle of the coordinate with this number, world frame.
  [[nodiscard]] const Vector3& axis(int number) const {
    return movers_[static_cast<std::size_t>(number)].axis;
  }

  /// Computes the effect of loads and drag during `time` [s], in substeps of `h` [s].
  void prepare(double h, double time);
  /// Inverse masses and inverse moments of inertia, reduced by drag [1/kg], [1/(kg m2)].
  [[nodiscard]] std::span<const double> yields() const { return yields_; }

  /// Reads places [m], [rad] and speeds from a state, and drives and loads from its controls. False
  /// if a force that a control sets turns about an axle. `state` must outlive the next substeps.
  /// `known`: apart from its controls, `state` is the last result of store_passed().
  [[nodiscard]] bool load(const State& state, bool known);
  [[nodiscard]] std::span<const double> places() const {
    return places_;
  }  ///< at the start of the substep
  [[nodiscard]] std::span<const double> speeds() const {
    return speeds_;
  }  ///< at the start of the substep
  /// Displacements in the substep [m], [rad]; after predict() those of the motion without
  /// constraints.
  [[nodiscard]] std::span<double> motion() { return motion_; }
  /// Speeds at the end of the substep.
  [[nodiscard]] std::span<double> end_speeds() { return end_speeds_; }
  /// The motion without constraints in a substep between these times [s]. Loads act until `loaded`.
  void predict(double from, double loaded, double to);
  /// Displacements in the substep at the speeds of its start. Prescribed bodies get their
  /// displacements of predict(), which must be the preceding call.
  void go_straight(std::span<double> way) const;
  /// Work in the substep of the forces that controls set [J].
  [[nodiscard]] double work_of_set_loads() const;
  /// Computes the speeds at the end from the displacements.
  void derive();
  /// Adds the effect of the loads between these times to the speeds at the end.
  void add_loads(double from, double to);
  /// Computes the places at the end; false if a place or a speed is out of range or not a number.
  [[nodiscard]] bool arrive();
  /// The end of the substep becomes the start of the next one.
  void go_on();

  /// To be called after go_on(): rounds places and speeds to the bits that they would have after
  /// the end of the substep is written to a state and read again. Results then do not depend on
  /// whether a state is written.
  void pass();
  /// Writes the end of the last substep that pass() has seen, before the go_on() of the next
  /// substep.
  void store_passed(State& state);

 private:
  struct Mover {
    int body = 0;
    bool slides = false;
    int carrier = -1;  ///< a slider; -1: none
    Vector3 axis = Vector3::Zero();
    double mass = 0.0;  ///< [kg], or moment of inertia [kg m2]; 0: prescribed
    double load = 0.0;  ///< constant force [N] or torque [N m] along `axis`
    double drag = 0.0;
    Vector3 offset = Vector3::Zero();  ///< of the centre from the carrier's centre of mass [m]
  };
  explicit AffineBodies(const BodySet& bodies) : bodies_(&bodies) {}
  bool add(int body);
  [[nodiscard]] BodyDrive drive_of(std::size_t number) const;
  /// Load that controls set on a body and on the rotors it carries [N or N m]; false if the load
  /// depends on the place of the body.
  [[nodiscard]] bool set_load_on(const Mover& mover, const State& state, double& load) const;
  [[nodiscard]] bool take_set_loads(const State& state);
  void begin_passing(const State& loaded);
  void store_slider(std::size_t number, double speed, State& state) const;
  void carry_mounted(State& state) const;

  const BodySet* bodies_;
  std::vector<int> numbers_;   ///< per body, and of the world
  std::vector<Mover> movers_;  ///< per number; the first is none
  std::vector<TurningBody> turning_;
  std::vector<int> driven_;  ///< by a torque that changes with time
  std::vector<int> prescribed_;
  std::vector<double> prescribed_speeds_;  ///< speeds of prescribed_ at the end of the substep
  std::vector<int> mounted_;               ///< rotors on sliders
  std::vector<int> rounded_;  ///< numbers whose place or speed changes by rounding in a state
  /// A slider along a coordinate axis: only one component of its position changes, and its velocity
  /// holds its speed without rounding.
  struct Straight {
    int number = 0;
    int component = 0;
    double sense = 1.0;  ///< direction of the slider's axis, 1 or -1
  };
  std::vector<Straight> straight_;
  double h_ = 0.0;
  double drag_time_ = 0.0;
  const Controls* controls_ = nullptr;
  bool has_set_loads_ = false;
  std::vector<double> set_loads_;  ///< set by controls, in addition to Mover::load
  std::vector<double> yields_, keep_, gains_, push_;
  std::vector<double> farthest_, fastest_;  ///< limits beyond which a run has diverged
  std::vector<double> loaded_;              ///< places that load() has read
  std::vector<double> places_, speeds_, motion_, end_places_, end_speeds_;
  // State at the end of the last substep that pass() has seen: positions of sliders, and speeds of
  // the numbers in by_vector_.
  std::vector<Vector3> passed_positions_;
  std::vector<double> passed_speeds_;
  // rounded_ in two parts: sliders of straight_ that need one component only, and all others.
  std::vector<Straight> by_component_;
  std::vector<int> by_vector_;
  std::vector<double> scratch_;  ///< scratch of turn_bodies()
};

}  // namespace sheave
