#pragma once
// All cables of a world: one unilateral distance row per free span.

#include <array>
#include <cmath>
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
#include "engine/constraint_batch.h"
#include "engine/index.h"

namespace sheave {

/// The feature "cables" of a world; its state is laid out as cable/cable_state_layout.h says.
class CableSystem final : public ConstraintBatch,
                          public CableStateLayout,
                          private cable_parts::CableWork {
 public:
  /// Checks and compiles the cables; faults have paths "/cables/i/...". `starts`, per cable: see
  /// CableTransfer. `before`: what they refer to, if it was made for these bodies; it is not
  /// compiled again.
  static Result<std::unique_ptr<CableSystem>> create(const std::vector<CableDef>& cables,
                                                     const BodySet& bodies,
                                                     std::span<const CableStart> starts = {},
                                                     const CableSystem* before = nullptr);

  [[nodiscard]] const std::vector<CompiledCable>& cables() const { return cables_; }
  /// One report per cable for a state of the world this system is a feature of; `own` is the
  /// system's own part of it.
  [[nodiscard]] std::vector<CableReport> report(const BodySet& bodies, const State& state,
                                                const FeatureState& own) const;

  /// What becomes of the cables when bodies are put elsewhere, at once (cable/cable_placement.cpp).
  struct Placed {
    FeatureState own;           ///< the system's part of the state afterwards
    std::vector<double> added;  ///< per cable: length that has been put in [m]
    std::string fault;          ///< why they cannot be put there; empty: they can
  };
  /// Bodies go from where `start` has them to where `end` has them, and nothing else happens.
  /// `keeps_tension`: what the spans need for that comes in or goes out; else lengths stay.
  [[nodiscard]] Placed place(const BodySet& bodies, const State& start, const State& end,
                             const FeatureState& own, bool keeps_tension);

  /// Cuts a cable between two substeps, in the span that pulled most in the last one, and tells of
  /// it as an event. False, and nothing has changed, if it is cut already or no span has pulled.
  bool part(int cable, const BodySet& bodies, double time, FeatureState& own);

  /// Measures of each cable at the end of the last substep, whose part of the state is `own`; false
  /// if it does not know, because the course of one has changed there.
  bool gauge(const FeatureState& own, std::vector<CableGauge>& gauges) const;

  using TangentWarning = cable_parts::TangentWarning;
  [[nodiscard]] std::vector<TangentWarning> tangent_warnings() const;
  using WrapWarning = cable_parts::WrapWarning;
  [[nodiscard]] std::vector<WrapWarning> wrap_warnings() const;
  using LeanWarning = cable_parts::LeanWarning;
  [[nodiscard]] std::vector<LeanWarning> lean_warnings() const;
  using WindingWarning = cable_parts::WindingWarning;
  [[nodiscard]] const std::vector<WindingWarning>& winding_warnings() const {
    return winding_warnings_;
  }
  using LinkWarning = cable_parts::LinkWarning;
  /// Drives and feeds that would have needed cable which was not there, and did not go on
  /// (cable/cable_drives.cpp).
  [[nodiscard]] std::vector<LinkWarning> stall_warnings() const {
    return link_warnings(notes_.stalls);
  }
  /// Links that cable slid over because there was no more of it, where it ought not to slide.
  [[nodiscard]] std::vector<LinkWarning> slide_warnings() const {
    return link_warnings(notes_.slides_at);
  }
  /// Another one if there may be another warning of these kinds.
  [[nodiscard]] std::uint64_t warnings_edition() const { return notes_.edition; }
  /// What happened since the system was created, in order.
  [[nodiscard]] const std::vector<CableEvent>& events() const { return events_; }
  /// The same, and forgets them; between steps.
  [[nodiscard]] std::vector<CableEvent> take_events() { return std::exchange(events_, {}); }

  // What is wrong with setting something of a cable, or of one of its listed links
  // (cable/cable_controls.cpp); empty if nothing is. They name what they are about.
  [[nodiscard]] std::string compliance_fault(int cable, double compliance) const;
  [[nodiscard]] std::string breaking_fault(int cable, double tension) const;
  [[nodiscard]] std::string wrap_friction_fault(int cable, double friction) const;
  [[nodiscard]] std::string friction_fault(int cable, int link, double friction) const;
  [[nodiscard]] std::string feed_fault(int cable, int link) const;
  /// The feed speed of a link as it is defined [m/s].
  [[nodiscard]] double defined_feed(int cable, int link) const {
    return definitions_[at(cables_[at(cable)].first_link + link)].feed_speed;
  }
  [[nodiscard]] int link_count() const { return static_cast<int>(definitions_.size()); }

  [[nodiscard]] std::string_view name() const override { return "cables"; }
  [[nodiscard]] FeatureState initial_state() const override { return initial_; }
  [[nodiscard]] bool accepts(const FeatureState& state) const override;
  [[nodiscard]] bool accepts_controls(const Controls& controls) const override;
  [[nodiscard]] bool takes_cables() const override { return true; }
  [[nodiscard]] int row_count() const override { return static_cast<int>(multipliers_.size()); }
  [[nodiscard]] int span_count() const { return static_cast<int>(spans_.size()); }
  /// The number of the bearing that brakes the wheel of a link, for bearing_index(); -1: none does.
  [[nodiscard]] int bearing_of(int link) const { return bearing_places_[at(link)]; }
  void begin(const Substep& substep, const FeatureState& state) override;
  [[nodiscard]] double longest() const override;
  [[nodiscard]] bool limits_drives() const override { return driven_; }
  void limit_drives(Substep& substep) override;
  double sweep(Substep& substep) override;
  void linearise(Substep& substep, RowList& rows) override;
  [[nodiscard]] bool has_all_rows() const override { return true; }
  [[nodiscard]] std::span<double> multipliers() override { return multipliers_; }
  bool revise(Substep& substep) override;
  bool revise_impulses(const Substep& substep) override;
  void end_impulses() override;
  void finish(Substep& substep, FeatureState& next) override;
  [[nodiscard]] std::string dead_end(const Substep& substep) const override;
  void mark_notes(NoteMark mark) override;
  void return_to(NoteMark mark) override;
  [[nodiscard]] bool append_affine(const AffineBodies& bodies, AffineRows& rows) override;
  [[nodiscard]] bool begin_affine(const AffineSubstep& substep, const FeatureState& state,
                                  std::span<double> values, std::span<char> active) override;
  [[nodiscard]] bool finish_affine(const AffineSubstep& substep, const FeatureState& now,
                                   FeatureState& next) override;
  /// Whether every span that can pull did so in the last substep.
  [[nodiscard]] bool all_pull(const FeatureState& own) const;
  [[nodiscard]] double elastic_energy(const BodySet& bodies, const State& state,
                                      const FeatureState& own) const override;

 private:
  friend class CableCompiler;
  friend class CableTransfer;  // between two worlds
  CableSystem() = default;
  /// The row of a span; of a material what it was made of, too, if `kept` is not null.
  SpanGeometry evaluate(const Substep& substep, int span, Row& row,
                        StretchedSpan* kept = nullptr) const;
  [[nodiscard]] SpanGeometry geometry_of(const Substep& substep, int span) const;

  // What has been set: cable/cable_controls.cpp.
  /// Makes cables_, links_ and spans_ those of the state at the start of the substep.
  void follow_state(const Substep& substep, const FeatureState& state);
  /// Makes cables_ what these controls say, before the course is followed.
  void follow_controls(const Controls& controls);
  /// The same of links_, afterwards.
  void control_links(const Substep& substep, const FeatureState& state);
  /// Whether one is cut in this state.
  [[nodiscard]] bool has_cut(const FeatureState& own) const;
  /// Cables that nothing but a control could cut.
  void expect_cuts();
  [[nodiscard]] double compliance_under(const Controls& controls, int cable,
                                        double rest_length) const;
  [[nodiscard]] std::string link_fault(int cable, int link) const;
  // Placements: cable/cable_placement.cpp.
  [[nodiscard]] std::string placement_fault(const Substep& substep, const CompiledCable& cable,
                                            const FeatureState& next) const;
  // Spans of which nothing turns: cable/cable_affine.cpp, cable/cable_affine_motion.cpp.
  void begin_affine_spans(const Substep& substep);
  /// Of spans_, with bodies as at time 0. `ends_stay`: hybrid ends are what they are in links_.
  [[nodiscard]] std::vector<AffineSpan> affine_spans(const BodySet& bodies, bool ends_stay) const;
  [[nodiscard]] AffineSpan affine_span(const Substep& start, const SpanSetup& setup,
                                       bool ends_stay) const;
  /// Whether the wheels' free motion is far from drawing all of a span and what its ends store.
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
  /// Of a constant compliance: frictionless links beside drained spans that pass nothing.
  void hold_drained(const CompiledCable& cable, const FeatureState& start);
  template <class Visit>
  void for_each_run(const CompiledCable& cable, Visit visit) const;
  /// One step of XPBD for one span; returns what solve_row() does.
  double solve_span(Substep& substep, int span);
  double sweep_spans(Substep& substep, const CompiledCable& cable);
  double solve_affine(Substep& substep, int span);
  void finish_affine(const Substep& substep, int span, FeatureState& next);
  void finish_span(Substep& substep, int k, FeatureState& next);
  // Wraps on balls without friction: cable/cable_geodesics.cpp.
  [[nodiscard]] bool has_geodesics() const;
  template <class Visit>
  void for_each_geodesic(Visit visit) const;
  /// At the start of a substep, or of what else begins with references_.
  void begin_geodesics(const Substep& substep);
  /// Turns their planes to where spans are now.
  void turn_geodesics(const Substep& substep);
  /// Puts the planes into the state.
  void keep_geodesics(const Substep& substep, FeatureState& next);
  // What cannot be vouched for: cable/cable_doubts.cpp.
  /// Visits (attachment, span from it to a wheel, the wheel, the span beyond the attachment).
  template <class Visit>
  void for_each_grip(Visit visit) const;
  /// At the start of a substep: which attachments are clear of their wheels.
  void begin_grips(const Substep& substep);
  void check_grips(const Substep& substep);
  /// Of a span that has no tangent at the end of the substep.
  void note_missing_tangent(Substep& substep, int span);
  /// Of wraps in space.
  void note_leans(const Substep& substep, const CompiledCable& cable);
  void linearise_spans(Substep& substep, const CompiledCable& cable, RowList& rows);
  double sweep_runs(Substep& substep, int cable_index);
  void linearise_run(Substep& substep, const CompiledCable& cable, Run run, RowList& rows);
  void start_without_feed(int span, Row& row) const;
  /// Evaluates the spans of a run, sums their gradients body by body; returns the largest ln k_i.
  double evaluate_run(const Substep& substep, const CompiledCable& cable, Run run);
  /// Makes the weights of a run of `count` spans relative to the heaviest, so that no number of
  /// turns overflows, and returns the sum of its rows' values [m]; of a material those with the
  /// run's strain, which it finds. Damped rows it makes those of springs with the same forces.
  double weigh_run(const Substep& substep, const CompiledCable& cable, Run run, double heaviest);
  double solve_run(Substep& substep, const CompiledCable& cable, Run run);
  /// Into run_work_.spare the rest lengths before anything passes the links [m], into
  /// run_work_.lengths those with the tensions; whether any has one at the end.
  bool shorten_run(const Substep& substep, const CompiledCable& cable, Run run);
  /// The same of a material.
  bool stretch_run(const Substep& substep, const CompiledCable& cable, Run run);
  /// Per span of the run: rest length that has to leave it [m], so that all have their tensions;
  /// together what the arcs gain.
  const std::vector<double>& run_spare(const Substep& substep, const CompiledCable& cable, Run run);
  void share_lengths(Substep& substep, const CompiledCable& cable, FeatureState& next);
  void share_run(Substep& substep, const CompiledCable& cable, Run run, FeatureState& next);
  // Links with friction: cable/cable_friction.cpp.
  /// Friction times wrap angle at a link, now.
  [[nodiscard]] double friction_exponent(const Substep& substep, int link,
                                         const SpanGeometry& incoming,
                                         const SpanGeometry& outgoing) const;
  /// Keeps what the links' friction is worth where the bodies start and the spans are evaluated.
  void remember_friction(const Substep& substep, const CompiledCable& cable);
  /// Whether the run is rigid and nothing that the solver does can lengthen it.
  [[nodiscard]] bool is_open(const Substep& substep, const CompiledCable& cable, Run run) const;
  void collect_pieces(const Substep& substep, const CompiledCable& cable);
  /// Piece::grip.
  double grip(const Substep& substep, std::size_t piece);
  /// Of the links between two pieces.
  void set_slip(std::size_t from, std::size_t to, int slip);
  /// Lets cable slide into pieces that are too short and out of those too long, between dead ends.
  void serve_pieces(const Substep& substep, std::size_t first, std::size_t last);
  void serve(std::size_t index);
  void judge_links(const Substep& substep, const CompiledCable& cable, std::size_t first,
                   std::size_t last);
  /// Whether the spans of the run, of constant compliance, have no rest length left.
  [[nodiscard]] bool is_drained(const CompiledCable& cable, Run run) const;
  /// Holds a link of a ring that would all slide; returns what passes over its first one then [m].
  double hold_ring(const Substep& substep, const CompiledCable& cable, Run run,
                   const std::vector<double>& spare);
  void update_slip(const Substep& substep, const CompiledCable& cable);
  void look_at_links(const Substep& substep, const CompiledCable& cable);
  [[nodiscard]] bool may_change(int link);
  [[nodiscard]] bool may_slide_by_means(const CompiledCable& cable, int link);
  /// Makes links slide that stick and do not hold.
  void release_links(const Substep& substep, const CompiledCable& cable);
  // Tensions that no body decides: cable/cable_held.cpp.
  /// Whether the run has a wheel between its spans that can turn.
  [[nodiscard]] bool turns_wheel(const Substep& substep, const CompiledCable& cable, Run run) const;
  /// Into given_ what open runs of the cable turn wheels with.
  void find_given(const Substep& substep, const CompiledCable& cable);
  void give(const Substep& substep, const CompiledCable& cable, const RunWeights&, Row& row);
  /// Whether that is another one now.
  bool has_other_given(const Substep& substep, const CompiledCable& cable);
  /// Gives spans whose tension is open one that their neighbours hold.
  void hold_tensions(const Substep& substep, const CompiledCable& cable);
  void hold_all(const Substep& substep, const CompiledCable& cable, Held what);
  void hold_between(const Substep& substep, const CompiledCable& cable, Held what,
                    std::size_t first, std::size_t last);
  void apply_held(const Substep& substep, const CompiledCable& cable, const Piece&, double pull);
  // Bearings that brake wheels with inertia: cable/cable_bearings.cpp.
  void begin_bearings(const Substep& substep);
  /// The sum of the tensions beside its wheel, by the multipliers of now, for a whole substep.
  [[nodiscard]] double pressing(const Substep& substep, const cable_parts::Bearing&) const;
  void evaluate_bearing(const Substep& substep, std::size_t bearing, Row& row) const;
  double sweep_bearings(Substep& substep);
  /// Behind the rows of the spans, which begin at `first`.
  void linearise_bearings(const Substep& substep, std::size_t first, RowList& rows);
  bool revise_bearings(const Substep& substep);
  // Drums with layers: cable/cable_layers.cpp.
  [[nodiscard]] bool layered(int span) const;
  [[nodiscard]] LayeredSpan layered_span(const Substep& substep, int span) const;
  SpanGeometry evaluate_layered(const Substep& substep, int span, Row& row,
                                SpanTransport& transport) const;
  // Dampers of spans that share a tension: cable/cable_damping.cpp.
  /// Whether the run slides by the means of its strains.
  [[nodiscard]] bool by_means(Run run) const;
  /// Of a span whose row by itself is `row`; none where nothing is damped.
  [[nodiscard]] SpanDamping damping_of(const Substep& substep, const CompiledCable& cable,
                                       bool means, int span, const Row& row) const;
  /// Lets the damper of a row of a run count from the start of the substep.
  static void damp_row(const CompiledCable& cable, const StretchedSpan* material,
                       const SpanDamping& damping, Row& row);
  // Cable of a material on wheels: cable/cable_material.cpp.
  [[nodiscard]] StretchedSpan stretched(int span, const SpanTransport& arcs, double length) const;
  /// Strain of a span, 0 if it is slack or its cable not of a material.
  [[nodiscard]] static double strain_of(const CompiledCable& cable, double length,
                                        double rest_length);
  /// Rest length of a span [m] at the end of the substep, from its row and its length.
  [[nodiscard]] static double rest_length_of(const CompiledCable& cable, const Row& row,
                                             double length);
  [[nodiscard]] static double rest_length_under(double value, double spring_length, double length);
  /// Unstretched transport of a span of a material at the end of the substep [m]; moves strain and
  /// counts creep.
  SpanTransport material_transport(const CompiledCable& cable, int span, const SpanTransport& arcs,
                                   double length, FeatureState& next);
  [[nodiscard]] StoredStrain stored_strain(const FeatureState& own, int link) const;
  void save_strain(const StoredStrain& stored, int link, FeatureState& own) const;
  /// Whether the spans of a run have one strain (times their weights), found for all together.
  [[nodiscard]] static bool strains_runs(const CompiledCable& cable) {
    return cable.inverse_stiffness > 0.0 && !cable.frozen;
  }
  // Links over which cable of a material slides: cable/strained_arcs.cpp.
  /// Whether what lies on the link is stretched with the spans on both sides.
  [[nodiscard]] bool slides_on(int link) const {
    return strain_places_[at(link)] >= 0 && links_[at(link)].slides_over() && shared(link);
  }
  /// Into run_work_.arcs those of a run whose spans are in run_work_.stretched.
  void find_arcs(const Substep& substep, const CompiledCable& cable, Run run,
                 std::span<const double> weights);
  /// Of the arc behind a span; tensions over that of the run at its ends.
  void add_nodes(const Substep& substep, int span, double from, double to);
  void add_outline(const Substep& substep, int span, double from, double rise);
  [[nodiscard]] std::span<const cable_parts::ArcNode> nodes_of(const SlidingArc& arc) const;
  [[nodiscard]] cable_parts::ArcSum arc_with(const SlidingArc& arc, double strain) const;
  /// Adds them to the rows of the spans before them.
  void add_arcs(const Substep& substep, const CompiledCable& cable, std::span<const double> weights,
                double strain, std::span<Row> rows) const;
  [[nodiscard]] StoredStrain strained_arc(const SlidingArc& arc, double strain) const;
  /// Finds what they gain in the substep, with the strain with which the run ends.
  void settle_arcs(std::optional<double> strain);
  /// Takes this share of what arcs gain out of run_work_.spare, half from either side.
  void count_arcs(double share);
  /// What slides over the link behind a span of the run, as friction sees it [m], of the length
  /// `passed` that comes to it and becomes that which goes on from it.
  [[nodiscard]] double pass_arc(std::size_t span, double& passed) const;
  /// The same of the end of the substep: puts what stays there into the state. `moved` comes, as a
  /// multiple of the quantum; returns the one that goes on.
  double lay_arc(const CompiledCable& cable, std::size_t span, double moved, double& passed,
                 FeatureState& next);
  /// Rest length of a material's span with `strain` at the end [m], before anything passes links.
  [[nodiscard]] static double rest_length_at(const StretchedSpan& span, double strain);
  /// The strain e of a run whose spans end with what their dampers make of weight x e each; 0 if it
  /// is slack, none if it is used up.
  [[nodiscard]] std::optional<double> run_strain(std::span<const StretchedSpan> spans,
                                                 std::span<const double> weights) const;
  /// Gives the rows of a run that strain.
  void strain_rows(const Substep& substep, const CompiledCable& cable, Run run,
                   std::span<const double> weights, std::span<Row> rows);
  void strain_shared(const Substep& substep, const CompiledCable& cable, Run run,
                     std::span<Row> rows);
  /// The strain with which a run ends, with the ratios of its tensions as weights; leaves these and
  /// the spans in run_work_.weights and run_work_.stretched. None if its spans keep strains of
  /// their own.
  std::optional<double> end_strain(const Substep& substep, const CompiledCable& cable, Run run);
  void keep_end_strains(const Substep& substep);
  /// Lets the link's strain follow a stored length that has changed at `end`, by what has `strain`.
  void fit_strain(int link, StoredStrain::End end, double strain, FeatureState& own) const;
  void keep_strains(FeatureState& next);
  /// Length of the stored cable as it lies there, stretched [m].
  [[nodiscard]] double stored_arc(const FeatureState& own, int link) const;
  [[nodiscard]] double stored_energy(const FeatureState& own) const;
  // Ends that change: cable/cable_ends.cpp.
  /// Puts what follows from the cables' state into links and spans.
  void refresh(const BodySet& bodies, const FeatureState& own, std::vector<LinkGeometry>& links,
               std::vector<SpanSetup>& spans) const;
  void refresh_ends(const FeatureState& own, std::vector<LinkGeometry>& links,
                    std::vector<SpanSetup>& spans) const;
  [[nodiscard]] Geometry geometry_for(const BodySet& bodies, const FeatureState& own) const;
  /// A span whose link `index` were attached at `angle` of its rim.
  [[nodiscard]] SpanGeometry attached_span(const Substep& substep, int index, int span,
                                           double angle) const;
  void change_ends(const Substep& substep, FeatureState& next);
  /// Whether the rim that a cable ends on turns too far for its rows, which are linear.
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
  /// The first span of the cable that there is; -1 if it is cut.
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
  /// Whether they are.
  [[nodiscard]] bool follows(const FeatureState& own) const;
  // Bodies that the cable leaves and touches: cable/cable_contacts.cpp.
  void leave_and_touch(const Substep& substep, FeatureState& next);
  /// Whether it is plain that the cable leaves nothing, and that there is nothing to touch.
  [[nodiscard]] bool keeps_course(const CompiledCable& cable, const FeatureState& next) const;
  void leave_all(const Substep& substep, const CompiledCable& cable, FeatureState& next);
  void touch_all(const Substep& substep, int cable, FeatureState& next);
  /// Lets the span touch the first body that it cuts; false if there is none.
  bool touch_on_span(const Substep& substep, int cable, int span, FeatureState& next);
  [[nodiscard]] int listed_before(const CompiledCable& cable, int span) const;
  /// Winds on or off what a span's end moves along its link, of a material with `strain`; what the
  /// span gains [m].
  double shift_contact(const Substep& substep, const CompiledCable& cable, int link,
                       const SpanGeometry& from, const SpanGeometry& to, bool first, double strain,
                       FeatureState& next) const;
  [[nodiscard]] bool comes_off(const Substep& substep, int span, int link,
                               const FeatureState& next) const;
  bool leave(const Substep& substep, const CompiledCable& cable, int link, FeatureState& next);
  bool touch_listed(const Substep& substep, const CompiledCable& cable, int span, int link,
                    FeatureState& next);
  bool touch_wrappable(const Substep& substep, int cable, int span, int candidate,
                       FeatureState& next);
  void forget_plane(const CompiledCable& cable, int place, FeatureState& own) const;
  bool split(const Substep& substep, const CompiledCable& cable, int span, int link,
             FeatureState& next);
  void record(const Substep& substep, const CompiledCable& cable, int link, CableEvent::Kind kind);
  void record(const BodySet& bodies, double time, const CompiledCable& cable, int link,
              CableEvent::Kind kind);
  void remember_sides(const Substep& substep, const CompiledCable& cable);
  // Drives that need more cable than there is: cable/cable_drives.cpp.
  /// Whether no cable passes the link unless a drive turns its body, or nothing does.
  [[nodiscard]] static bool ends_chain(const BodySet& bodies, const LinkGeometry& link);
  /// Whether forces can move the link's place.
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
  /// Whether the cable ends on the link, which is not round and so cannot hold it by its rim when
  /// all is paid out.
  [[nodiscard]] bool runs_out(const CompiledCable& cable, int link) const {
    const bool end =
        !cable.closed && (link == cable.first_link || link == cable.last_listed_link());
    return end && links_[at(link)].wraps() && !definitions_[at(link)].hybrid;
  }
  /// What drives pay out from drums on which the cable ends.
  void add_stored_cable(const Substep& substep, const CompiledCable& cable);
  /// Lets the drives of a chain short of cable draw only what there is; false if it is not short.
  bool stall(Substep& substep, const Chain& chain, bool altogether);
  DriveShare& share_of(Substep& substep, const Pull& pull);
  void begin_drives(const FeatureState& state);
  void record_stalls(const Substep& substep, FeatureState& next);
  /// Which way the drive of a link turns its body in this substep: -1, 0, 1.
  [[nodiscard]] int driven_way(const Substep& substep, int link) const;
  /// Moves cable between a span and its links as the transport says, but no more than there is.
  void wind(int span, const SpanTransport& transport, FeatureState& next);
  void slide_over_ends(int span, std::array<double, 2>& moved, FeatureState& next);
  [[nodiscard]] std::vector<LinkWarning> link_warnings(const std::vector<Stall>& of_links) const;
  // Cutting: cable/cable_cut.cpp.
  void cut(const Substep& substep, FeatureState& next);
  /// The active span that pulled most; -1: there is none.
  [[nodiscard]] int strongest_span(const CompiledCable& cable, const FeatureState& own) const;
  void part_at(const CompiledCable& cable, int span, const BodySet& bodies, double time,
               FeatureState& own);
  void feed(const FeatureState& state, double h, int span);
  void turn_massless_wheel(Substep& substep, int link, double length) const;
  void stop_wheel(Substep& substep, int wheel) const;
  void count_numerical_damping(Substep& substep, const FeatureState& next) const;
  /// Energy that implicit Euler takes from a span's vibration in a substep [J], from its tensions
  /// before and now [N].
  [[nodiscard]] double numerical_damping(const CompiledCable& cable, std::array<double, 2> tensions,
                                         double stretch, double rest_length, double h) const;
  [[nodiscard]] double compliance_of(const CompiledCable& cable, double rest_length) const;
  // Reports: cable/cable_report.cpp.
  struct CableView;
  /// The link `index` with the spans before and after it; -1: none.
  [[nodiscard]] LinkReport link_report(const CableView& view, int index, int incoming,
                                       int outgoing) const;
  void append_wraps(const CableView& view, const CompiledCable& cable, CableReport& report) const;
  void measure(const CableView& view, const CompiledCable& cable, int cut_span,
               CableReport& report) const;
  /// Cable from its first link to the middle of a span [m].
  [[nodiscard]] double length_before(const FeatureState& own, const CompiledCable& cable,
                                     int span) const;
};

}  // namespace sheave

#include "cable/cable_run_visit.h"
