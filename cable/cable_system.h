#pragma once
// All cables of a world: one unilateral distance row per free span.

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "cable/cable.h"
#include "cable/cable_report.h"
#include "cable/cable_state_layout.h"
#include "cable/cable_work.h"
#include "engine/index.h"
#include "engine/instant_feature.h"

namespace sheave {

/// The feature "cables" of a world. cable/cable_state_layout.h describes its state.
class CableSystem final : public ConstraintBatch,
                          public AffineFeature,
                          public ScheduledFeature,
                          public InstantFeature,
                          public NotedFeature,
                          public CableStateLayout,
                          private cable_parts::CableWork {
 public:
  /// Checks and compiles the cables; faults have paths "/cables/i/...". `starts`: one per cable,
  /// see CableTransfer. `before`: a system that was compiled for the same bodies, or null; the
  /// cables that `starts` refers to are copied from it instead of being compiled again.
  static Result<std::unique_ptr<CableSystem>> create(const std::vector<CableDef>& cables,
                                                     const BodySet& bodies,
                                                     std::span<const CableStart> starts = {},
                                                     const CableSystem* before = nullptr);

  [[nodiscard]] const std::vector<CompiledCable>& cables() const { return cables_; }
  /// One report per cable, for a state of the system's world and the system's part of it.
  [[nodiscard]] std::vector<CableReport> report(const BodySet&, const State&, const FeatureState&,
                                                SpanTensions = SpanTensions::multipliers) const;
  struct ReportRoom;  // the memory of CableReports (cable/cable_report.cpp)
  void report(ReportRoom& room, std::vector<CableReport>& reports) const;
  /// Result of place() (cable/cable_placement.cpp).
  struct Placed {
    FeatureState own;           ///< the system's part of the state afterwards
    std::vector<double> added;  ///< per cable: length that was added [m]
    std::string fault;          ///< why the bodies cannot be put there; empty if they can
  };
  /// Moves bodies at once from `start` to `end`. `keeps_tension`: lengths change, tensions stay.
  [[nodiscard]] Placed place(const BodySet& bodies, const State& start, const State& end,
                             const FeatureState& own, bool keeps_tension);
  /// Cuts a cable at a place, or in its tautest span; false if it is cut already, or is slack there.
  bool part(int cable, const BodySet&, double time, FeatureState& own, const CutPlace* = nullptr);
  /// Measures of each cable at the end of the last substep; `own` is the part of the state there.
  /// False if lengths of spans are not known because the course of a cable has changed there.
  bool gauge(const FeatureState& own, std::vector<CableGauge>& gauges) const;
  [[nodiscard]] std::vector<cable_parts::TangentWarning> tangent_warnings() const;
  [[nodiscard]] std::vector<cable_parts::WrapWarning> wrap_warnings() const;
  [[nodiscard]] std::vector<cable_parts::LeanWarning> lean_warnings() const;
  [[nodiscard]] std::vector<cable_parts::MisplacedWarning> misplaced_warnings() const;
  [[nodiscard]] const auto& winding_warnings() const { return winding_warnings_; }
  /// Drives and feeds that were stopped or slowed down for want of cable (cable/cable_drives.cpp).
  [[nodiscard]] std::vector<cable_parts::LinkWarning> stall_warnings() const;
  /// Links without slip over which cable slid, for want of cable; grooves that cable passed beside.
  [[nodiscard]] std::vector<cable_parts::LinkWarning> slide_warnings() const;
  [[nodiscard]] std::vector<cable_parts::LinkWarning> beside_warnings() const;
  /// Changes whenever these lists may have changed.
  [[nodiscard]] std::uint64_t warnings_edition() const { return notes_.edition; }
  /// All events since the system was created, in order of time.
  [[nodiscard]] const std::vector<CableEvent>& events() const { return events_; }
  /// Returns the events and clears the list; to be called between steps.
  [[nodiscard]] std::vector<CableEvent> take_events() { return std::exchange(events_, {}); }

  // Why a control of a cable or of its link cannot be set, or empty: cable/cable_controls.cpp.
  [[nodiscard]] std::string compliance_fault(int cable, double compliance) const;
  [[nodiscard]] std::string breaking_fault(int cable, double tension) const;
  [[nodiscard]] std::string wrap_friction_fault(int cable, double friction) const;
  [[nodiscard]] std::string friction_fault(int cable, int link, double friction) const;
  [[nodiscard]] std::string feed_fault(int cable, int link) const;
  /// The feed speed of a link in its definition [m/s].
  [[nodiscard]] double defined_feed(int cable, int link) const;
  [[nodiscard]] int link_count() const { return static_cast<int>(definitions_.size()); }
  [[nodiscard]] std::string_view name() const override { return "cables"; }
  [[nodiscard]] FeatureState initial_state() const override { return initial_; }
  [[nodiscard]] bool accepts(const FeatureState& state) const override;
  [[nodiscard]] bool accepts_controls(const Controls& controls) const override;
  [[nodiscard]] bool takes_cables() const override { return true; }
  [[nodiscard]] int row_count() const override { return static_cast<int>(multipliers_.size()); }
  [[nodiscard]] int span_count() const { return static_cast<int>(spans_.size()); }
  /// The bearing that brakes a link's wheel, for bearing_index(); -1: none.
  [[nodiscard]] int bearing_of(int link) const { return bearing_places_[at(link)]; }
  void begin(const Substep& substep, const FeatureState& state) override;
  [[nodiscard]] double longest() const override;
  [[nodiscard]] bool limits_drives() const override { return driven_; }
  void limit_drives(Substep& substep) override;
  double sweep(Substep& substep) override;
  void linearise(Substep& substep, RowList& rows) override;
  [[nodiscard]] bool has_all_rows() const override { return true; }
  [[nodiscard]] std::span<double> multipliers() override { return multipliers_; }
  [[nodiscard]] bool is_stiff() const override { return !knots_.empty(); }
  bool revise(Substep& substep) override;
  bool revise_impulses(const Substep& substep) override;
  void end_impulses() override;
  void finish(Substep& substep, FeatureState& next) override;
  [[nodiscard]] std::unique_ptr<ConstraintBatch> copy() const override;
  [[nodiscard]] std::string dead_end(const Substep& substep) const override;
  void mark_notes(NoteMark mark) override;
  void return_to(NoteMark mark) override;
  [[nodiscard]] bool has_instants() const override;
  [[nodiscard]] double next_instant(const FeatureState& own) const override;
  bool act_at(const BodySet& bodies, double time, double until, FeatureState& own) override;
  // Cables that break (cable/cable_cut.cpp); the margin is a tension [N].
  [[nodiscard]] bool watches(const Controls& controls) const override;
  void expect(const Expected* part) override;
  [[nodiscard]] double margin(const Substep&, const FeatureState&) const override;
  [[nodiscard]] bool asks_for_forces(const FeatureState& own) const override;
  void append_forces(std::vector<double>& forces) const override;
  void tell_forces(std::span<const double> forces, double length) override;
  bool arise(const BodySet& bodies, double time, FeatureState& own) override;
  [[nodiscard]] bool append_affine(const AffineBodies& bodies, AffineRows& rows) override;
  [[nodiscard]] bool begin_affine(const AffineSubstep& substep, const FeatureState& state,
                                  std::span<double> values, std::span<char> active) override;
  [[nodiscard]] bool finish_affine(const AffineSubstep& substep, const FeatureState& now,
                                   FeatureState& next) override;
  /// Whether every span that can carry tension did so in the last substep.
  [[nodiscard]] bool all_pull(const FeatureState& own) const;
  [[nodiscard]] double elastic_energy(const BodySet& bodies, const State& state,
                                      const FeatureState& own) const override;
  [[nodiscard]] double potential_energy(const BodySet& bodies, const State& state,
                                        const FeatureState& own) const override;
  [[nodiscard]] int bearing_count() const { return static_cast<int>(bearings_.size()); }

 private:
  friend class CableCompiler;
  friend class CableTransfer;  // moves cables from one world to another
  friend class DrumGrooves;
  friend class HeavySpans;
  friend class Knots;
  friend class MasslessWheels;
  friend class RopeInertia;
  friend class RopeMemories;
  friend class FloorFriction;
  friend class Sheaths;
  CableSystem() = default;
  CableSystem(const CableSystem&) = default;
  /// Evaluates a span's row. `kept`, if not null, gets the terms of a row with a material.
  SpanGeometry evaluate(const Substep& substep, int span, Row& row,
                        StretchedSpan* kept = nullptr) const;
  [[nodiscard]] SpanGeometry geometry_of(const Substep& substep, int span) const;
  // Controls: cable/cable_controls.cpp.
  /// Makes cables_, links_ and spans_ those of the state at the start of the substep.
  void follow_state(const Substep& substep, const FeatureState& state);
  void begin_moving_span(const Substep& substep, const FeatureState& state, int k);
  void follow_controls(const Controls& controls);
  void control_links(const Substep& substep, const FeatureState& state);
  [[nodiscard]] bool has_cut(const FeatureState& own) const;
  /// Lets the course of every cable change, because a control can cut it.
  void expect_cuts();
  [[nodiscard]] double compliance_under(const Controls& controls, int cable,
                                        double rest_length) const;
  [[nodiscard]] std::string link_fault(int cable, int link) const;
  // Placements: cable/cable_placement.cpp.
  [[nodiscard]] std::string placement_fault(const Substep& substep, const CompiledCable& cable,
                                            const FeatureState& next) const;
  // Spans whose geometry does not turn: cable/cable_affine.cpp, cable/cable_affine_motion.cpp.
  void begin_affine_spans(const Substep& substep);
  /// With bodies as at time 0. `ends_stay`: hybrid ends keep their present mode.
  [[nodiscard]] std::vector<AffineSpan> affine_spans(const BodySet& bodies, bool ends_stay) const;
  [[nodiscard]] AffineSpan affine_span(const Substep& start, const SpanSetup& setup,
                                       bool ends_stay) const;
  [[nodiscard]] bool feeds(const MovingSpan& span, const FeatureState& state,
                           std::span<const double> motion, double rest_length) const;
  [[nodiscard]] bool finish_affine_cable(const CompiledCable& cable, const AffineSubstep& substep,
                                         const FeatureState& now, FeatureState& next);
  [[nodiscard]] double affine_damping(const AffineSubstep& substep, const FeatureState& now,
                                      const FeatureState& next) const;
  void end_slides_and_stalls();
  [[nodiscard]] MovingSpan moving_span(const AffineBodies& bodies, const State& initial,
                                       const AffineSpan& affine, int index) const;
  // Cable that passes between spans: cable/cable_runs.cpp.
  [[nodiscard]] int next_span(const CompiledCable& cable, int span) const;
  [[nodiscard]] bool shared(int link) const;
  void hold_drained(const CompiledCable& cable, const FeatureState& start);
  template <class Visit>
  void for_each_run(const CompiledCable& cable, Visit visit) const;
  double solve_span(Substep& substep, int span);
  double sweep_spans(Substep& substep, const CompiledCable& cable);
  double solve_affine(Substep& substep, int span);
  void finish_affine(const Substep& substep, int span, FeatureState& next);
  void finish_span(Substep& substep, int k, FeatureState& next);
  // Wraps on smooth bodies: cable/cable_geodesics.cpp.
  template <class Visit>
  void for_each_geodesic(Visit visit) const;
  /// Finds the geodesics, and the places in openings, of all cables for the present positions.
  void settle_geodesics(const Substep& substep, std::vector<LinkGeometry>& links,
                        const std::vector<SpanSetup>& spans) const;
  void begin_geodesics(const Substep& substep);
  void turn_geodesics(const Substep& substep);
  void keep_geodesics(FeatureState& next) const;
  /// Before and after a change of a cable's course: moves the growth of geodesics to their links.
  void remember_geodesics();
  void shift_geodesics(const Substep& substep, const CompiledCable& cable, FeatureState& next);
  // Ropes with weight: cable/cable_weight.cpp.
  [[nodiscard]] bool hangs(const Substep& substep, int span) const {
    return weighs_ && weighs_now(substep, cables_[at(spans_[at(span)].cable)]);
  }
  [[nodiscard]] bool weighs_now(const Substep& substep, const CompiledCable& cable) const;
  // Attachments that reach a wheel: cable/cable_arrival.cpp; other doubts: cable/cable_doubts.cpp.
  template <class Visit>
  void for_each_grip(Visit visit) const;
  void begin_arrivals(const Substep& substep);
  void check_arrivals(const Substep& substep);
  [[nodiscard]] bool arrives(const Substep& substep, int span) const;
  [[nodiscard]] bool reaches_eye(const Substep& substep, int span) const;
  void note_missing_tangent(Substep& substep, int span);
  /// Notes wraps in space that have left their plane, or the end of their bar.
  void note_leans(const Substep& substep, const CompiledCable& cable);
  void linearise_spans(Substep& substep, const CompiledCable& cable, RowList& rows);
  double sweep_runs(Substep& substep, int cable_index);
  void linearise_run(Substep& substep, const CompiledCable& cable, Run run, RowList& rows);
  void start_without_feed(int span, Row& row) const;
  /// Evaluates the spans of a run, sums their gradients per body; returns the largest ln k_i.
  double evaluate_run(const Substep& substep, const CompiledCable& cable, Run run);
  /// Divides the weights of the run by the largest, exp(heaviest), so that nothing overflows. Rows of
  /// a material get the run's strain; a damped row becomes that of a spring with the same force.
  /// Returns the sum of the rows' values [m].
  double weigh_run(const Substep& substep, const CompiledCable& cable, Run run, double heaviest);
  double solve_run(Substep& substep, const CompiledCable& cable, Run run);
  /// Writes the rest lengths before anything passes the links into run_work_.spare [m], those with
  /// the tensions into run_work_.lengths [m]. Returns whether any span has a tension at the end.
  bool shorten_run(const Substep& substep, const CompiledCable& cable, Run run);
  /// The same for a cable with a material.
  bool stretch_run(const Substep& substep, const CompiledCable& cable, Run run);
  /// Per span of the run: rest length that has to leave the span [m] so that all spans get their
  /// tensions. The sum is the length that the arcs gain.
  const std::vector<double>& run_spare(const Substep& substep, const CompiledCable& cable, Run run);
  void share_lengths(Substep& substep, const CompiledCable& cable, FeatureState& next);
  void share_run(Substep& substep, const CompiledCable& cable, Run run, FeatureState& next);
  // Links with friction: cable/cable_friction.cpp.
  /// Friction times wrap angle at a link, in the present pose.
  [[nodiscard]] double friction_exponent(const Substep& substep, int link,
                                         const SpanGeometry& incoming,
                                         const SpanGeometry& outgoing) const;
  /// Keeps the friction exponents of the links where the bodies start and the spans are evaluated.
  void remember_friction(const Substep& substep, const CompiledCable& cable);
  /// Whether the run is rigid and no motion of a body that the solver can find lengthens it.
  [[nodiscard]] bool is_open(const Substep& substep, const CompiledCable& cable, Run run) const;
  void collect_pieces(const Substep& substep, const CompiledCable& cable);
  double grip(const Substep& substep, std::size_t piece);
  /// For the links between two pieces.
  void set_slip(std::size_t from, std::size_t to, int slip);
  /// Lets cable slide into pieces that are too short and out of those too long, between dead ends.
  void serve_pieces(const Substep& substep, std::size_t first, std::size_t last);
  void serve(std::size_t index);
  void judge_links(const Substep& substep, const CompiledCable& cable, std::size_t first,
                   std::size_t last);
  /// Whether the spans of the run, with a constant compliance, have no rest length left.
  [[nodiscard]] bool is_drained(const CompiledCable& cable, Run run) const;
  /// Holds one link of a ring that would all slide; returns the passage over its first link [m].
  double hold_ring(const Substep& substep, const CompiledCable& cable, Run run,
                   const std::vector<double>& spare);
  void update_slip(const Substep& substep, const CompiledCable& cable);
  void look_at_links(const Substep& substep, const CompiledCable& cable);
  [[nodiscard]] bool may_change(int link);
  [[nodiscard]] bool may_slide_by_means(const CompiledCable& cable, int link);
  /// Lets those links slide that stick although their tensions exceed the bound.
  void release_links(const Substep& substep, const CompiledCable& cable);
  // Tensions that no body determines: cable/cable_held.cpp.
  /// Whether a wheel that can turn lies between the spans of the run.
  [[nodiscard]] bool turns_wheel(const Substep& substep, const CompiledCable& cable, Run run) const;
  /// Writes into given_ the tensions with which open runs of the cable turn wheels.
  void find_given(const Substep& substep, const CompiledCable& cable);
  void give(const Substep& substep, const CompiledCable& cable, const RunWeights&, Row& row);
  /// Whether these tensions have changed.
  bool has_other_given(const Substep& substep, const CompiledCable& cable);
  /// Gives a span whose tension is undetermined one that its neighbours' friction can hold.
  void hold_tensions(const Substep& substep, const CompiledCable& cable);
  void hold_all(const Substep& substep, const CompiledCable& cable, Held what);
  void hold_between(const Substep& substep, const CompiledCable& cable, Held what,
                    std::size_t first, std::size_t last);
  void apply_held(const Substep& substep, const CompiledCable& cable, const Piece&, double pull);
  // Bearings that brake wheels with inertia: cable/cable_bearings.cpp.
  void begin_bearings(const Substep& substep);
  void find_pin(const Substep& substep, cable_parts::Bearing& bearing) const;
  /// Pressure by the present multipliers, for a whole substep; its part that rows of spans lack.
  [[nodiscard]] double pressing(const Substep& substep, const cable_parts::Bearing&) const;
  [[nodiscard]] double above_chords(const Substep&, const cable_parts::Bearing&) const;
  void evaluate_bearing(const Substep& substep, std::size_t bearing, Row& row) const;
  double sweep_bearings(Substep& substep);
  /// Appends the rows behind those of the spans, which begin at `first`.
  void linearise_bearings(const Substep& substep, std::size_t first, RowList& rows);
  bool revise_bearings(const Substep& substep);
  bool revise_pins(const Substep& substep);  // after the impulses of `rattle`
  // Drums with layers: cable/cable_layers.cpp.
  [[nodiscard]] bool layered(int span) const;
  [[nodiscard]] LayeredSpan layered_span(const Substep& substep, int span) const;
  SpanGeometry evaluate_layered(const Substep& substep, int span, Row& row,
                                SpanTransport& transport) const;
  // Dampers of spans that share a tension: cable/cable_damping.cpp.
  /// Whether a link of the run slides by the mean strains of the substep.
  [[nodiscard]] bool by_means(Run run) const;
  /// The damper of a span; `row` is the span's row by itself. No damping if the cable has none.
  [[nodiscard]] SpanDamping damping_of(const Substep& substep, const CompiledCable& cable,
                                       bool means, int span, const Row& row) const;
  /// Makes the damper of a row of a run count from the start of the substep.
  static void damp_row(const CompiledCable& cable, const StretchedSpan* material,
                       const SpanDamping& damping, Row& row);
  // Cable with a material on wheels: cable/cable_material.cpp.
  [[nodiscard]] StretchedSpan stretched(int span, const SpanTransport& arcs, double length) const;
  /// Strain of a span; 0 if the span is slack or the cable has no material.
  [[nodiscard]] static double strain_of(const CompiledCable& cable, double length,
                                        double rest_length);
  /// Rest length of a span at the end of the substep [m], from its row and its length.
  [[nodiscard]] static double rest_length_of(const CompiledCable& cable, const Row& row,
                                             double length);
  [[nodiscard]] static double rest_length_under(double value, double spring_length, double length);
  /// Unstretched transport of a span at the end of the substep [m], for a cable with a material.
  /// Moves the strain with it and counts the loss by creep.
  SpanTransport material_transport(const CompiledCable& cable, int span, const SpanTransport& arcs,
                                   double length, FeatureState& next);
  [[nodiscard]] StoredStrain stored_strain(const FeatureState& own, int link) const;
  void save_strain(const StoredStrain& stored, int link, FeatureState& own) const;
  /// Whether the strain of a run is found for all its spans together (times their weights).
  [[nodiscard]] static bool strains_runs(const CompiledCable& cable) {
    return cable.inverse_stiffness > 0.0 && !cable.frozen;
  }
  // Links over which cable with a material slides: cable/strained_arcs.cpp.
  /// Whether the cable stored on the link is stretched together with the spans on both sides.
  [[nodiscard]] bool slides_on(int link) const {
    return strain_places_[at(link)] >= 0 && links_[at(link)].slides_over() && shared(link);
  }
  /// Writes the arcs of a run into run_work_.arcs; its spans are in run_work_.stretched.
  void find_arcs(const Substep& substep, const CompiledCable& cable, Run run,
                 std::span<const double> weights);
  /// For the arc behind a span; `from` and `to` are tensions at its ends over that of the run.
  void add_nodes(const Substep& substep, int span, double from, double to);
  void add_outline(const Substep& substep, int span, double from, double rise);
  [[nodiscard]] std::span<const cable_parts::ArcNode> nodes_of(const SlidingArc& arc) const;
  [[nodiscard]] cable_parts::ArcSum arc_with(const SlidingArc& arc, double strain) const;
  void add_arcs(const Substep& substep, const CompiledCable& cable, std::span<const double> weights,
                double strain, std::span<Row> rows) const;
  [[nodiscard]] StoredStrain strained_arc(const SlidingArc& arc, double strain) const;
  /// Finds the gains of the arcs in the substep, with the run's strain at the end.
  void settle_arcs(std::optional<double> strain);
  /// Takes the fraction `share` of the arcs' gains out of run_work_.spare, half from each side, and
  /// passes on the same fraction of the cable that their surfaces carry.
  void count_arcs(double share);
  /// Length that slides over the link behind a span of the run, as friction counts it [m].
  /// `passed`: the length that comes to the link; on return the length that goes on from it.
  [[nodiscard]] double pass_arc(std::size_t span, double& passed) const;
  /// `moved`: the incoming length as a multiple of the quantum; returns the outgoing one.
  double lay_arc(const CompiledCable& cable, std::size_t span, double moved, double& passed,
                 FeatureState& next);
  /// The strain e of a run whose spans end with the stretch that their dampers make of weight x e;
  /// 0 if the run is slack, none if its cable is used up.
  [[nodiscard]] std::optional<double> run_strain(std::span<const StretchedSpan> spans,
                                                 std::span<const double> weights) const;
  /// Gives the rows of a run the run's strain.
  void strain_rows(const Substep& substep, const CompiledCable& cable, Run run,
                   std::span<const double> weights, std::span<Row> rows);
  void strain_shared(const Substep& substep, const CompiledCable& cable, Run run,
                     std::span<Row> rows);
  /// The strain of a run at the end, with the ratios of its tensions as weights. Leaves the weights
  /// and the spans in run_work_.weights and run_work_.stretched. None if the spans keep strains of
  /// their own.
  std::optional<double> end_strain(const Substep& substep, const CompiledCable& cable, Run run);
  void keep_end_strains(const Substep& substep);
  /// Adapts the stored strain to a stored length that cable with `strain` has changed at `end`.
  void fit_strain(int link, StoredStrain::End end, double strain, FeatureState& own) const;
  void keep_strains(FeatureState& next);
  /// Stretched length of the stored cable [m].
  [[nodiscard]] double stored_arc(const FeatureState& own, int link) const;
  [[nodiscard]] double stored_energy(const FeatureState& own) const;
  // Ends that change: cable/cable_ends.cpp.
  /// Applies the state of the cables to links and spans.
  void refresh(const BodySet& bodies, const FeatureState& own, std::vector<LinkGeometry>& links,
               std::vector<SpanSetup>& spans) const;
  void refresh_ends(const FeatureState& own, std::vector<LinkGeometry>& links,
                    std::vector<SpanSetup>& spans) const;
  void find_geometry(const Substep& now, const FeatureState& own, Geometry& geometry) const;
  /// The span as it would be if its link `index` were attached at the angle `angle` of its rim.
  [[nodiscard]] SpanGeometry attached_span(const Substep& substep, int index, int span,
                                           double angle) const;
  void change_ends(const Substep& substep, FeatureState& next);
  /// Whether the rim to which a cable's end is fixed turns too far in the substep for linear rows.
  [[nodiscard]] bool turns_too_far(const Substep& substep) const;
  [[nodiscard]] bool end_turns_too_far(const Substep& substep, int index, int span,
                                       bool first) const;
  void change_end(const Substep& substep, const CompiledCable& cable, int index, int span,
                  bool first, FeatureState& next);
  // The order in which a cable runs over its links: cable/cable_course.cpp.
  [[nodiscard]] static int span_before(const CompiledCable& cable, int link,
                                       const std::vector<SpanSetup>& spans);
  [[nodiscard]] static int span_after(const CompiledCable& cable, int link) {
    return cable.first_span + link - cable.first_link;
  }
  /// The first active span of the cable; -1 if there is none because the cable is cut.
  [[nodiscard]] static int first_active_span(const CompiledCable& cable,
                                             const std::vector<SpanSetup>& spans);
  void connect_spans(const FeatureState& own, const std::vector<LinkGeometry>& links,
                     std::vector<SpanSetup>& spans) const;
  [[nodiscard]] bool keeps_plane(const CompiledCable& cable, int link,
                                 const FeatureState& own) const;
  void place_wraps(const BodySet& bodies, const FeatureState& own,
                   std::vector<LinkGeometry>& links) const;
  void insert_link(const CompiledCable& cable, int after, int link, FeatureState& own) const;
  void remove_link(int before, int link, FeatureState& own) const;
  /// Makes links_ and spans_ those of a state with another course.
  void follow_course(const BodySet& bodies, const FeatureState& own);
  /// Whether links_ and spans_ have the course of this state.
  [[nodiscard]] bool follows(const FeatureState& own) const;
  // Bodies that the cable leaves and touches: cable/cable_contacts.cpp.
  void leave_and_touch(const Substep& substep, FeatureState& next);
  /// Whether a cheap test shows that the cable leaves nothing and touches nothing.
  [[nodiscard]] bool keeps_course(const CompiledCable& cable, const FeatureState& next) const;
  void leave_all(const Substep& substep, const CompiledCable& cable, FeatureState& next);
  void touch_all(const Substep& substep, int cable, FeatureState& next);
  /// Makes the span touch the first body that it cuts; false if it cuts none.
  bool touch_on_span(const Substep& substep, int cable, int span, FeatureState& next);
  [[nodiscard]] int listed_before(const CompiledCable& cable, int span) const;
  /// Winds onto or off the link the length between two contacts of a span's end, with the strain
  /// `strain` for a cable with a material. Returns the span's gain [m].
  double shift_contact(const Substep& substep, const CompiledCable& cable, int link,
                       const SpanGeometry& from, const SpanGeometry& to, bool first, double strain,
                       FeatureState& next) const;
  [[nodiscard]] bool comes_off(const Substep& substep, int span, int link,
                               const FeatureState& next) const;
  bool leave(const Substep& substep, const CompiledCable& cable, int link, FeatureState& next);
  bool touch_listed(const Substep& substep, const CompiledCable& cable, int span, int link,
                    FeatureState& next);
  bool touch_wrappable(const Substep&, int cable, int span, int candidate, FeatureState& next);
  void put_plane(int place, const WrapPlane& plane, FeatureState& own) const;
  template <class Visit>
  bool for_each_lifted(const CompiledCable&, int span, const FeatureState&, Visit) const;
  bool split(const Substep& substep, const CompiledCable& cable, int span, int link,
             FeatureState& next);
  void record(const Substep&, const CompiledCable&, int link, CableEvent::Kind);
  void record(const BodySet&, double time, const CompiledCable&, int link, CableEvent::Kind);
  void remember_sides(const Substep&, const CompiledCable&, const FeatureState&);
  // Drives that need more cable than there is: cable/cable_drives.cpp.
  /// Whether cable passes the link only when a drive turns its body, or never.
  [[nodiscard]] static bool ends_chain(const BodySet& bodies, const LinkGeometry& link);
  /// Whether forces can move the link.
  [[nodiscard]] static bool can_move(const BodySet& bodies, const LinkGeometry& link);
  /// False if there is more than enough cable next to each drive.
  [[nodiscard]] bool may_fall_short(const Substep& substep, const CompiledCable& cable) const;
  void find_chains(Substep& substep, const CompiledCable& cable);
  void begin_chain(const Substep& substep, const CompiledCable& cable, int link,
                   ChainLengths& lengths);
  void end_chain(const Substep& substep, const CompiledCable& cable, int link,
                 ChainLengths& lengths);
  void add_drum(const Substep& substep, const CompiledCable& cable, int link,
                ChainLengths& lengths) const;
  void add_to_chain(const Substep& substep, int span, ChainLengths& lengths);
  void add_pull(const Pull& pull);
  /// Whether the cable ends on a link that is not round: its rim cannot hold the cable's end.
  [[nodiscard]] bool runs_out(const CompiledCable& cable, int link) const;
  /// Adds the cable that drives pay out from drums on which the cable ends.
  void add_stored_cable(const Substep& substep, const CompiledCable& cable);
  /// Limits the drives of a chain to the available cable; false: it lacks none.
  bool stall(Substep& substep, const Chain& chain, bool altogether);
  DriveShare& share_of(Substep& substep, const Pull& pull);
  void begin_drives(const FeatureState& state);
  void record_stalls(const Substep& substep, FeatureState& next);
  /// Direction in which the drive of a link turns its body in this substep: -1, 0, 1.
  [[nodiscard]] int driven_way(const Substep& substep, int link) const;
  /// Moves transported length between a span and its links; a search for equilibrium has no limit.
  void wind(int span, const SpanTransport& transport, bool searches, FeatureState& next);
  void slide_over_ends(int span, std::array<double, 2>& moved, FeatureState& next);
  [[nodiscard]] std::vector<cable_parts::LinkWarning> link_warnings(
      const std::vector<Stall>& of_links) const;
  // Cutting: cable/cable_cut.cpp.
  void cut(const Substep& substep, FeatureState& next);
  /// Tension at the end [N]; where no state determines it that of the substep.
  [[nodiscard]] double end_tension(const Substep&, int span, const FeatureState& next) const;
  [[nodiscard]] int strongest_span(const CompiledCable& cable, const FeatureState& own) const;
  void part_at(const CompiledCable& cable, const CutPlace& place, const BodySet& bodies,
               double time, FeatureState& own);
  void feed(const FeatureState& state, double h, int span);
  void count_numerical_damping(Substep& substep, const FeatureState& next) const;
  /// Energy that implicit Euler takes from a span's vibration in a substep [J]. `tensions`: at the
  /// start and at the end [N].
  [[nodiscard]] double numerical_damping(const CompiledCable& cable, std::array<double, 2> tensions,
                                         double stretch, double rest_length, double remembered,
                                         double h) const;
  [[nodiscard]] double compliance_of(const CompiledCable& cable, double rest_length) const;
  struct CableView;
  [[nodiscard]] SpanReport span_report(const CableView& view, int k) const;
  /// The link `index` with the spans before and after it; -1: there is no such span.
  void report_link(const CableView& view, int index, std::array<int, 2> ways, LinkReport&) const;
  void report_wraps(const CableView& view, const CompiledCable& cable, CableReport& report) const;
  void measure(const CableView& view, const CompiledCable& cable, CableReport& report) const;
};

}  // namespace sheave

#include "cable/cable_run_visit.h"
