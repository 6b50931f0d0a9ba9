#pragma once
// Models of other programs as scenes: MuJoCo's MJCF, URDF, OpenSim, and cable robots of CASPR.
//
//   sheave::import::Outcome made = sheave::import::import_model(text, "arm.xml");
//   if (!made.errors.empty()) puts(to_string(made.errors.front()).c_str());
//   else puts(made.json.c_str());  // a scene; docs/how-to/import.md has the table of elements

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/scene.h"

namespace sheave::import {

/// How an element of a model was taken.
enum class Taken : std::uint8_t {
  same,     ///< the scene means the same
  changed,  ///< the scene has it with another meaning, which the note tells
  skipped,  ///< the scene does not have it
};

/// One line of the report.
struct Note {
  Taken taken = Taken::same;
  std::string file;     ///< as in error messages
  int line = 0;         ///< from 1
  std::string element;  ///< the element with its name, such as: joint "elbow"
  std::string text;     ///< how the element was taken, or why not
};

/// The element from which a part of the scene was made.
struct Origin {
  std::string pointer;  ///< JSON pointer of the part, such as /bodies/3
  std::string file;
  int line = 0;  ///< from 1
};

/// Limits of a model, far above any sensible one.
struct Limits {
  std::size_t bytes = std::size_t{16} << 20U;  ///< of the model and all files that it includes
  std::size_t depth = 100;                     ///< of nested elements
  std::size_t elements = 200'000;              ///< of the model with all files that it includes
  std::size_t includes = 100;                  ///< number of files that are included
  std::size_t faults = 100;                    ///< number of faults that are listed one by one
};

/// Choices of an import.
struct Options {
  /// Name or number (from 0) of the keyframe in which the scene starts; empty: the pose of the
  /// model without any.
  std::string keyframe;
  /// Text of the other one of the two files of a cable robot of CASPR; none: the file in the folder
  /// of the model.
  std::optional<std::string> other_text{};
  /// Folder in which files that the model names must lie, itself or below; empty: that of the model.
  std::string folder{};
  /// Mass of bodies that move and have none [kg], with a radius of gyration of 1 cm; 0: an error.
  double least_mass = 0.0;
  /// Replaces moments of inertia that no body has, each by the mean of the three.
  bool balances = false;
};

/// A scene made from a model, or all faults of the model.
struct Outcome {
  std::string json;                ///< text of the scene; empty if there are errors
  std::vector<SceneError> errors;  ///< with file and line, in the order of the checks
  std::vector<Note> notes;         ///< in the order of the model's text
  std::vector<Origin> origins;     ///< of the parts of the scene
};

/// Whether a text is a model in XML and no scene: its first character that is no blank is "<".
[[nodiscard]] bool is_model(std::string_view text);
/// Whether this build can read models.
[[nodiscard]] bool is_available();

/// Makes a scene from the text of a model. Files that the model includes are read from the folder
/// of `file_name` and below; links out of this folder are errors.
[[nodiscard]] Outcome import_model(std::string_view text, const std::string& file_name,
                                   const Options& options = {}, const Limits& limits = {});

/// One sentence with the numbers of elements that were taken and skipped.
[[nodiscard]] std::string summary(const Outcome& made);
/// The sentence for a run of the model itself; empty if all elements mean the same.
[[nodiscard]] std::string notice(const Outcome& made, const std::string& file_name);
/// All notes, one per line, sorted by file and line, with a heading per kind; ends with summary().
[[nodiscard]] std::string report(const Outcome& made);

/// Moves errors that are located in the made scene to the elements from which it was made.
void locate(std::vector<SceneError>& errors, const std::string& file_name, const Outcome& made);

}  // namespace sheave::import
