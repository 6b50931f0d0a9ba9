#pragma once
// Bodies that move along straight lines: sliders, and rotors on axles that do not turn.
//
// Each has one number and one speed, in flat arrays. Nothing in their motion depends on where they
// are, so what loads and drag make of a speed in a substep is a factor and a sum, found once:
//   v* = keep v + push,   dq* = h v*.
// What a rotor is mounted on may slide, but not turn. Number 0 belongs to what does not move.

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
  /// Nothing if one of the bodies moves in another way. `bodies` must outlive it.
  static std::optional<AffineBodies> of(const BodySet& bodies);

  [[nodiscard]] const BodySet& set() const { return *bodies_; }
  /// Numbers of all bodies, that of what does not move among them.
  [[nodiscard]] std::size_t count() const { return yields_.size(); }
  /// Which one is the body's; 0 if it does not move, and of the world.
  [[nodiscard]] int number_of(int body) const { return numbers_[static_cast<std::size_t>(body)]; }
  /// The unit direction or axle that it counts along or about, world frame.
  [[nodiscard]] const Vector3& axis(int number) const {
    return movers_[static_cast<std::size_t>(number)].axis;
  }

  /// Takes what loads and drag do in `time` [s], of a substep of `h` [s].
  void prepare(double h, double time);
  /// Inverse masses and moments of inertia, as far as drag leaves them [1/kg], [1/(kg m2)].
  [[nodiscard]] std::span<const double> yields() const { return yields_; }

  /// Takes places [m], [rad] and speeds from a state, and what its controls say of drives and
  /// loads. False if a force that has been set turns about an axle. `state` must outlive the
  /// substeps that follow. `known`: it is what store_passed() has last written, but for controls.
  [[nodiscard]] bool load(const State& state, bool known);
  [[nodiscard]] std::span<const double> places() const { return places_; }  ///< at the start
  [[nodiscard]] std::span<const double> speeds() const { return speeds_; }  ///< likewise
  /// Displacements of the substep [m], [rad]: free ones from predict() on.
  [[nodiscard]] std::span<double> motion() { return motion_; }
  /// Speeds at the end of the substep.
  [[nodiscard]] std::span<double> end_speeds() { return end_speeds_; }
  /// The motion without constraints in a substep between these times [s], with what loads do until
  /// `loaded`.
  void predict(double from, double loaded, double to);
  /// Displacements in the substep at the speeds of its start; of prescribed bodies those of
  /// predict(), of which it must be called right after.
  void go_straight(std::span<double> way) const;
  /// Work that forces do in the substep which have been set [J].
  [[nodiscard]] double work_of_set_loads() const;
  /// Speeds at the end follow from the motion.
  void derive();
  /// What loads do between these times to the speeds at the end.
  void add_loads(double from, double to);
  /// Places at the end; false if they, or the speeds, mean nothing any more.
  [[nodiscard]] bool arrive();
  /// The end of the substep becomes the start of the next one.
  void go_on();

  /// After go_on(): what writing the end of the substep to a state and taking it from there again
  /// would do to numbers, to the last bit, so that results do not depend on who looks.
  void pass();
  /// Writes the end of the last substep that has passed, before go_on() of the next.
  void store_passed(State& state);

 private:
  struct Mover {
    int body = 0;
    bool slides = false;
    int carrier = -1;  ///< that slides; -1: none
    Vector3 axis = Vector3::Zero();
    double mass = 0.0;  ///< or moment of inertia; 0: prescribed
    double load = 0.0;  ///< constant force or torque along it
    double drag = 0.0;
    Vector3 offset = Vector3::Zero();  ///< of the centre from the carrier's centre of mass
  };
  explicit AffineBodies(const BodySet& bodies) : bodies_(&bodies) {}
  bool add(int body);
  [[nodiscard]] BodyDrive drive_of(std::size_t number) const;
  /// Of a body and what it carries [N or N m]; false if it depends on where the body is.
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
  std::vector<double> prescribed_speeds_;  ///< of these, at the end of the substep
  std::vector<int> mounted_;               ///< on what slides
  std::vector<int> rounded_;  ///< whose number or speed a state does not hold to the last bit
  /// What slides along a coordinate axis: of its place only one component changes, and its speed
  /// is what it was.
  struct Straight {
    int number = 0;
    int component = 0;
    double sense = 1.0;  ///< of the axis
  };
  std::vector<Straight> straight_;
  double h_ = 0.0;
  double drag_time_ = 0.0;
  const Controls* controls_ = nullptr;
  bool has_set_loads_ = false;
  std::vector<double> set_loads_;  ///< besides Mover::load
  std::vector<double> yields_, keep_, gains_, push_;
  std::vector<double> farthest_, fastest_;  ///< beyond these a state means nothing
  std::vector<double> loaded_;              ///< places of load()
  std::vector<double> places_, speeds_, motion_, end_places_, end_speeds_;
  // Of the last substep that has passed, as it ended: positions of what slides; speeds
  // of what is in by_vector_.
  std::vector<Vector3> passed_positions_;
  std::vector<double> passed_speeds_;
  // Which of straight_ pass by their component alone, and what else of rounded_.
  std::vector<Straight> by_component_;
  std::vector<int> by_vector_;
  std::vector<double> scratch_;  ///< of turn_bodies()
};

}  // namespace sheave
