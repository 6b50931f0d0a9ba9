#pragma once
// From what a user says about cables to what the step needs, with every check that needs geometry;
// internal to the cable library.

#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "cable/cable_system.h"
#include "cable/link_geometry.h"

namespace sheave {

/// Builds a CableSystem cable by cable and collects all faults.
class CableCompiler {
 public:
  /// `before`: cables that were compiled for the same bodies, of which those that stay are taken;
  /// may be null.
  explicit CableCompiler(const BodySet& bodies, const CableSystem* before = nullptr)
      : bodies_(bodies), before_(before) {}

  void add(const CableDef& def, const CableStart& start = {});
  Result<std::unique_ptr<CableSystem>> finish();

 private:
  /// Looks at bodies as they were then.
  void go_to(const BodyFrames& frames);
  void fail(const std::string& field, const std::string& message);
  void check_settings(const CableDef& def);
  /// A cable that has been compiled before. Of its part of the state it only makes room:
  /// CableTransfer fills it.
  void take(int then);

  // Links: cable/cable_compile_links.cpp.
  void compile_links(const CableDef& def);
  /// Those that the cable has left are off it, and no others.
  void lift_links(const RunningCable& running);
  /// What depends on where in the cable a link stands.
  void check_passage(const LinkGeometry& link, bool end, const std::string& field);
  void check_massless(const LinkGeometry& link, bool end, const std::string& field);
  /// Of a drum with layers, whose radius is the bare drum's, with what is on it at time 0; with its
  /// sign [m].
  [[nodiscard]] static double wound_radius(const LinkGeometry& drum);
  void check_stored_length(const LinkGeometry& link, bool end, const std::string& field);
  [[nodiscard]] std::string link_name(int link) const;

  // Spans: cable/cable_compile_spans.cpp.
  void compile_spans(const CableDef& def);
  /// The next link that the cable touches at time 0; the ends of a cable always do.
  [[nodiscard]] int next_touched(int link) const;
  /// Planar if the geometry of the bodies' mobilities guarantees it for ever.
  void choose_kind(SpanSetup& setup, const LinkGeometry& a, const LinkGeometry& b) const;
  // Windings: cable/cable_compile_windings.cpp.
  void check_windings(const CableDef& def);
  void find_wrong_winding(int link, int before, int after);
  void check_span(const CableDef& def, int first, int second);
  void explain_missing_tangent(int first, int second);
  void check_rest_length(const CableDef& def, int span, const SpanGeometry& geometry);
  /// From here on a wrap without whole turns is one that the cable would not have [rad].
  static constexpr double longest_wrap = 2.0 * pi - pi / 3.0;
  /// Angle of the cable on a wheel at time 0 without its whole turns, in [0, 2 pi) [rad].
  [[nodiscard]] double start_wrap(int link, const SpanGeometry& incoming,
                                  const SpanGeometry& outgoing) const;
  /// Cable on the wheel between the incoming and the outgoing tangent.
  [[nodiscard]] double arc(int link, const SpanGeometry& incoming,
                           const SpanGeometry& outgoing) const;
  [[nodiscard]] std::vector<double> start_lengths(const CableDef& def);
  /// Strain at time 0 of what lies on a link: that of the spans beside it, between two their mean.
  [[nodiscard]] double start_strain(const CableDef& def, int link) const;

  // Course and wraps: cable/cable_compile_course.cpp.
  /// Whether all links stay in one plane for ever, so that any two of them can be joined by a
  /// planar span.
  void find_plane(CompiledCable& cable) const;
  [[nodiscard]] bool lies_in_plane(const Vector3& normal) const;
  void find_candidates(const CableDef& def, CompiledCable& cable);
  [[nodiscard]] bool any_wrappable() const;
  [[nodiscard]] bool place_candidate(const CompiledCable& cable, WrapCandidate& candidate) const;
  void check_candidates(const CompiledCable& cable);
  /// What drives can do to it.
  void set_drives(CompiledCable& cable) const;
  void set_course(CompiledCable& cable);
  void append_places(CompiledCable& cable);
  void store(const CableDef& def);
  /// Gives links of cables of a material their places for strain, after the planes of wraps.
  /// For what a substep keeps per span and link.
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
  std::map<int, double> bare_radii_;  ///< of drums with layers, by their index among all links
  std::vector<double> rest_lengths_;
  std::vector<double> remainders_;  ///< per span what its rest length is rounded by [m]
  std::vector<double> stored_lengths_;
  std::vector<double> start_strains_;  ///< per link
  std::vector<std::int64_t> next_links_;
  int planes_ = 0;  ///< places for wraps of all cables
  // Of the cable that is being added.
  BodyFrames frames_;
  /// It has run before: where it is now is not where it began, and is checked when its state is
  /// known.
  bool runs_ = false;
  bool same_ = false;  ///< and has not been changed
  int index_ = 0;
  std::string path_;
  std::string name_;
  std::vector<LinkGeometry> links_;
  std::vector<SpanSetup> spans_;
  std::vector<SpanGeometry> geometry_;
};

}  // namespace sheave
