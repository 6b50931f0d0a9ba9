#pragma once
// Compiles definitions of cables to the data of the step, with every check that needs geometry;
// internal to the cable library.

#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "cable/cable_system.h"
#include "cable/link_geometry.h"
#include "cable/wheel_rope.h"

namespace sheave {

/// Builds a CableSystem cable by cable and collects all faults.
class CableCompiler {
 public:
  /// `before`: a system that was compiled for the same bodies, from which unchanged cables are
  /// copied; may be null.
  explicit CableCompiler(const BodySet& bodies, const CableSystem* before = nullptr)
      : bodies_(bodies), before_(before) {}

  void add(const CableDef& def, const CableStart& start = {});
  /// Reports knots whose forces do not balance where they are at time 0.
  void check_knot_places();
  /// `fresh`: no cable has run before.
  Result<std::unique_ptr<CableSystem>> finish(bool fresh);

 private:
  /// Computes geometry with the bodies at these poses.
  void go_to(const BodyFrames& frames);
  void fail(const std::string& field, const std::string& message);
  void check_settings(const CableDef& def);
  /// Copies cable number `then` of `before_`. Only reserves its part of the state: CableTransfer
  /// fills it.
  void take(int then);

  // Links: cable/cable_compile_links.cpp.
  void compile_links(const CableDef& def);
  /// Lays the links with the shortest side on that side: cable/cable_compile_sides.cpp.
  void choose_sides(const CableDef& def);
  /// Keeps the sides of the running cable's links.
  void keep_sides(const RunningCable& running);
  /// Lifts the links that the running cable has left, and no others.
  void lift_links(const RunningCable& running);
  /// Checks that depend on a link's place in the cable.
  void check_passage(const LinkGeometry& link, bool end, const std::string& field);
  void check_massless(const LinkGeometry& link, bool end, const std::string& field);
  /// Gives a bare drum with layers the radius, and the place of the rope, with its stored cable.
  /// `strain`: of that cable, if the drum has a groove.
  static void wind_drum(LinkGeometry& drum, double strain);
  /// Strain of a pretension in the first or the last span.
  [[nodiscard]] static double given_strain(const CableDef& def, bool first);
  void check_stored_length(const LinkGeometry& link, bool end, const std::string& field);
  [[nodiscard]] std::string link_name(int link) const;

  // Spans: cable/cable_compile_spans.cpp.
  void compile_spans(const CableDef& def);
  /// Finds the geodesics of the surface links at time 0: cable/cable_compile_surfaces.cpp.
  void lay_surfaces(bool closed);
  void guess_geodesic(int before, int link, int after);
  /// Reports that a link's point, or the end of its geodesic, lies inside the smooth body of its
  /// neighbour on the cable; false: it does not.
  bool fail_if_inside(int link, int neighbour);
  void check_surface(int link);
  /// The next link that the cable touches at time 0. A cable always touches its end links.
  [[nodiscard]] int next_touched(int link) const;
  /// Chooses a planar span if the mobilities of the bodies keep both links in one plane.
  void choose_kind(SpanSetup& setup, const LinkGeometry& a, const LinkGeometry& b) const;
  // Windings: cable/cable_compile_windings.cpp.
  void check_windings(const CableDef& def);
  void find_wrong_winding(int link, int before, int after);
  void check_span(const CableDef& def, int first, int second);
  void explain_missing_tangent(int first, int second);
  void check_rest_length(const CableDef& def, int span, const SpanGeometry& geometry);
  void check_pretension(const CableDef& def);
  // Laws of ropes: cable/cable_compile_law.cpp.
  void check_elasticity(const CableDef& def);
  /// Checks and compiles the table of tensions.
  void compile_law(const CableDef& def);
  void make_memories();
  void make_floors(bool fresh);
  /// Checks the links and bodies of a cable with a table.
  void check_law_links(const CableDef& def);
  void check_law_wraps(const CompiledCable& cable);
  // Ropes with weight: cable/cable_compile_weight.cpp.
  void check_weight(const CableDef& def);
  /// The settings and links of a rope with inertia.
  void check_inertia(const CableDef& def);
  /// The settings of a rope with a floor, and the ends of a span there.
  void check_floor(const CableDef& def);
  [[nodiscard]] bool is_anchor(const CableDef& def, bool first) const;
  void find_anchors(const CableDef& def, CompiledCable& cable);
  void check_above_floor(const CableDef& def, int first, int second);
  /// Tells whether a span between these links keeps a vertical plane, if it ends on a wheel.
  void check_heavy_span(const SpanSetup& setup, int first, int second);
  /// Whether the rope has weight.
  [[nodiscard]] bool weighs(const CableDef& def) const;
  [[nodiscard]] WheelPlane heavy_plane(const CableDef& def, int span) const;
  /// Rest length of a span of a rope with weight under a chord tension [m].
  double hanging_length(const CableDef& def, int span, double tension);
  /// Shares the rope of spans with weight that it passes freely, so that the rope rests there.
  void share_lengths(const CableDef& def);
  void share_run(const CableDef& def, const std::vector<int>& run);
  /// Strain at time 0 of rope with weight on a wheel: the mean of both sides.
  [[nodiscard]] double heavy_start_strain(const CableDef& def, int link) const;
  // Ropes in sheaths: cable/cable_compile_sheaths.cpp.
  [[nodiscard]] bool has_sheath() const;
  /// Refuses the links and settings with which a rope cannot run through a sheath.
  void check_sheaths(const CableDef& def);
  void check_reach(const LinkGeometry& link, const std::string& field);
  /// Openings: cable/cable_compile_openings.cpp.
  void check_openings(const CableDef& def);
  /// cable/cable_compile_grooves.cpp.
  void check_grooves(const CableDef& def);
  void lay_openings();
  // Knots: cable/cable_compile_knots.cpp.
  [[nodiscard]] bool on_knot(int link) const;
  void check_knots(const CableDef& def);
  void check_knotted_settings(const CableDef& def);
  void check_knotted_link(const CableDef& def, int i);
  void make_knots();
  /// Unstretched rope in a sheath at time 0, between the tensions of the spans beside it [m].
  double start_in_sheath(const CableDef& def, int link);
  void make_sheaths();
  /// Finds the rest lengths that the user gives, by lengths or by tensions.
  void give_rest_lengths(const CableDef& def);
  // One tension where rope passes freely: cable/cable_compile_strain.cpp.
  void share_strain(const CableDef& def);
  void share_run_strain(const CableDef& def, const std::vector<int>& run);
  /// A wrap of this angle or more without whole turns is taken for a mistake [rad].
  static constexpr double longest_wrap = 2.0 * pi - pi / 3.0;
  /// Angle of the cable on a wheel at time 0 without whole turns [rad], in [0, 2 pi).
  [[nodiscard]] double start_wrap(int link, const SpanGeometry& incoming,
                                  const SpanGeometry& outgoing) const;
  /// Length of cable on the wheel between the incoming and the outgoing tangent point [m].
  [[nodiscard]] double arc(int link, const SpanGeometry& incoming,
                           const SpanGeometry& outgoing) const;
  [[nodiscard]] std::vector<double> start_lengths(const CableDef& def);
  /// Strain at time 0 of the cable stored on a link: that of the adjacent span, or the mean of two
  /// adjacent spans.
  [[nodiscard]] double start_strain(const CableDef& def, int link) const;

  // Course and wraps: cable/cable_compile_course.cpp.
  /// Finds whether the mobilities keep all links in one plane, so that any two of them can be
  /// joined by a planar span.
  void find_plane(CompiledCable& cable) const;
  [[nodiscard]] bool lies_in_plane(const Vector3& normal) const;
  void find_candidates(const CableDef& def, CompiledCable& cable);
  [[nodiscard]] bool any_wrappable() const;
  [[nodiscard]] bool place_candidate(const CompiledCable& cable, WrapCandidate& candidate) const;
  void check_candidates(const CompiledCable& cable);
  /// Whether a span that passes the candidate on this side runs through it.
  [[nodiscard]] bool runs_through(const WrapCandidate& candidate, const WrapSide& side,
                                  const SpanGeometry& span) const;
  /// Finds the links that drives turn, and whether drives alone can fix the length of a span.
  void set_drives(CompiledCable& cable) const;
  void set_course(CompiledCable& cable);
  void append_places(CompiledCable& cable);
  /// Gives places for planes to the places for wraps and to the listed geodesics.
  void number_planes(CompiledCable& cable);
  void store(const CableDef& def);
  /// Allocates the arrays per span and link of a substep.
  void make_room();
  void store_strains();

  const BodySet& bodies_;
  const CableSystem* before_;
  State state_;
  std::optional<Substep> now_;
  std::unique_ptr<CableSystem> system_{new CableSystem};
  Errors errors_;
  std::set<std::string> names_;
  std::set<int> massless_wheels_;
  std::map<int, double> bare_radii_;  ///< per drum with layers, by its index among all links [m]
  std::vector<double> rest_lengths_;
  std::vector<double> remainders_;  ///< per span: rounding error of its rest length [m]
  std::vector<double> stored_lengths_;
  std::vector<double> start_strains_;           ///< per link
  std::map<int, SheathProfile> start_sheaths_;  ///< by the index among all links
  std::vector<std::int64_t> next_links_;
  int planes_ = 0;  ///< number of places for planes, over all cables
  // The cable that is being added.
  BodyFrames frames_;
  /// The cable has run before. Its present course differs from that of its definition and is
  /// checked when its state is known.
  bool runs_ = false;
  bool same_ = false;  ///< the cable has run before and was not changed
  int index_ = 0;
  std::string path_;
  std::string name_;
  std::vector<LinkGeometry> links_;
  std::vector<SpanSetup> spans_;
  std::vector<SpanGeometry> geometry_;
  std::shared_ptr<const TensionLaw> law_;     ///< null without a table
  std::shared_ptr<const RopeMemory> memory_;  ///< null of a rope without memory
  std::vector<double> given_lengths_;  ///< rest lengths that the user gives [m]; may be empty
};

}  // namespace sheave
