#pragma once
// Reads the tree of an MJCF text into a Model. One file per kind of element.

#include <map>
#include <string>
#include <vector>

#include "scenes/import/attributes.h"
#include "scenes/import/mjcf/model.h"

namespace sheave::import::mjcf {

/// Default classes: per class, per kind of element, the attributes. Classes have those of the
/// classes around them already.
class Defaults {
 public:
  /// Reads a <default> below the root; the outermost class is "main".
  void read(const xml::Element& element, Log& log);
  /// Values for an element of this kind: of its own class, else of `child_class`, else of "main".
  /// An unknown class is an error.
  [[nodiscard]] const DefaultValues* of(const xml::Element& element, std::string_view kind,
                                        const std::string& child_class, Log& log) const;
  [[nodiscard]] bool has(const std::string& name) const { return classes_.contains(name); }

 private:
  using Class = std::map<std::string, DefaultValues, std::less<>>;
  void read_class(const xml::Element& element, const std::string& name, const Class& outer,
                  Log& log);

  std::map<std::string, Class, std::less<>> classes_;
};

/// The model being read, and the defaults that apply to it; all readers of elements share it.
struct Reader {
  Model& model;
  Defaults& defaults;
  Log& log;
  std::string child_class;  ///< of the body being read

  [[nodiscard]] Attributes attributes(const xml::Element& element, std::string_view kind) const {
    return {element, defaults.of(element, kind, child_class, log), log};
  }
  /// Angle in radians.
  [[nodiscard]] double angle(double given) const {
    return model.compiler.degrees ? given * pi / 180.0 : given;
  }
  /// The number of a named thing; an error if there is none.
  [[nodiscard]] int find(const std::unordered_map<std::string, int>& names,
                         const xml::Element& element, std::string_view attribute,
                         std::string_view kind) const;
  /// Enters a name; an error if the name is taken.
  void enter(std::unordered_map<std::string, int>& names, const std::string& name, int number,
             const xml::Element& element) const;
};

/// The model of a tree, with masses; check log.failed(). `folder`: as Options::folder.
[[nodiscard]] Model read_model(const xml::Element& root, Log& log, const std::string& folder = {});

void read_compiler(const xml::Element& element, Compiler& compiler, Log& log);
void read_option(const xml::Element& element, Option& option, Log& log);
/// Reads pos and the orientation; nullopt if no attribute of an orientation is given.
[[nodiscard]] std::optional<Quaternion> read_orientation(Attributes& attributes,
                                                         const Compiler& compiler);
[[nodiscard]] Frame read_frame(Attributes& attributes, const Compiler& compiler);
/// Reads the meshes of <asset>. `left`: bytes that their files may have, which it lowers.
void read_meshes(const xml::Element& element, std::size_t& left, Reader& reader);
/// Reads <worldbody>.
void read_bodies(const xml::Element& element, Reader& reader);
void read_joint(const xml::Element& element, int body, Reader& reader);
void read_geom(const xml::Element& element, int body, Reader& reader);
void read_site(const xml::Element& element, int body, Reader& reader);
void read_inertial(const xml::Element& element, Body& body, Reader& reader);
void read_tendons(const xml::Element& element, Reader& reader);
/// Whether an actuator is a muscle.
[[nodiscard]] bool is_muscle(Attributes& attributes, const xml::Element& element);
/// The law of a muscle; nullopt if it has no counterpart, which the log tells.
[[nodiscard]] std::optional<MuscleLaw> read_muscle(Attributes& attributes,
                                                   const xml::Element& element,
                                                   const Compiler& compiler, Log& log);
void read_actuators(const xml::Element& element, Reader& reader);
void read_equalities(const xml::Element& element, Reader& reader);
void read_keyframes(const xml::Element& element, Reader& reader);
/// Sets the inertial of each body from its geoms or its <inertial>, as <compiler> says.
void find_masses(Model& model, Log& log);
/// The mass of each body with that of the bodies without joints that it carries, in its own frame.
[[nodiscard]] std::vector<Inertial> carried_masses(const Model& model);
/// Applies the options for masses that a scene cannot have; else such a mass is an error.
void mend_masses(const Options& options, Model& model, Log& log);
/// Mass of a geom's solid at this density [kg/m3], in the frame of its body; 0 if it has none.
[[nodiscard]] Inertial solid_inertial(const Geom& geom, const Model& model, double density);
/// Reads `range` and `limited`; `scale` is the unit of the range.
[[nodiscard]] std::optional<std::array<double, 2>> read_range(Attributes& attributes,
                                                              bool automatic,
                                                              std::string_view range_name,
                                                              std::string_view limited_name);

}  // namespace sheave::import::mjcf
