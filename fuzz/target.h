#pragma once
// The fuzz targets. Each target accepts any bytes, makes an input for a part of the program from
// them, and throws a BrokenPromise if that part violates its contract. Memory errors and undefined
// behaviour are detected by the sanitizers.

#include <array>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace sheave::fuzz {

using Bytes = std::span<const std::uint8_t>;

/// A required property does not hold.
class BrokenPromise : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

/// Throws if `holds` is false.
inline void require(bool holds, const char* promise) {
  if (!holds) throw BrokenPromise(promise);
}
inline void require(bool holds, const std::string& promise) {
  if (!holds) throw BrokenPromise(promise);
}

/// The text of a scene. Either it loads and stays the same when it is written and loaded again, or
/// it has faults with positions within the text.
void try_scene_text(Bytes bytes);
/// A machine with all its entities and step settings (machine.h). Either it is refused with a
/// message, or it runs 20 steps without a silent error (machine_run.h).
void try_machine(Bytes bytes);
/// A damaged state file for a fixed scene. Either it is refused with a message, or the scene
/// continues from it.
void try_state(Bytes bytes);
/// A journal of `sheave trade` or a baseline of `sheave bench`: read, or refused with a message.
void try_journal(Bytes bytes);
/// Words of a command line, separated by line breaks: accepted, or refused with a message. No
/// command is executed.
void try_command_line(Bytes bytes);
/// Requests of a live session, separated by line breaks. Each is executed, or refused without a
/// change of state. Replaying the log gives the same state.
void try_live(Bytes bytes);

/// Texts in every place of a chart that accepts one: they add no commands to gnuplot's script
/// (chart_texts.h). No chart is drawn.
void try_chart(Bytes bytes);

/// Successive edits of a world that divide and join cables and add and remove bodies and joints,
/// with steps in between. Each edit is accepted or refused, and results in a topology, as the model
/// of cable/edit.h predicts (edit_model.h). A refused edit changes nothing, and every reached state
/// can be restored.
void try_edit(Bytes bytes);

/// The text of a model in XML. Either it is refused with a place, or it becomes a scene whose parts
/// are those of scenes.
void try_model(Bytes bytes);
/// A mesh file, read as STL and as OBJ. Either it is refused with a message, or its triangles have
/// their points, and the solid inside has a mass that is a number above 0, or none with a message.
void try_mesh(Bytes bytes);

/// A target with its name.
struct Target {
  std::string_view name;
  void (*run)(Bytes bytes);
};
inline constexpr std::array<Target, 10> targets{{{"scene_text", try_scene_text},
                                                 {"machine", try_machine},
                                                 {"state", try_state},
                                                 {"journal", try_journal},
                                                 {"command_line", try_command_line},
                                                 {"live", try_live},
                                                 {"chart", try_chart},
                                                 {"edit", try_edit},
                                                 {"model", try_model},
                                                 {"mesh", try_mesh}}};

}  // namespace sheave::fuzz
