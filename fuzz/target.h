#pragma once
// What fuzzing tries. Each target takes any bytes, makes of them what a part of the program reads,
// and throws a BrokenPromise if that part does not do what it promises. Faults of memory and
// undefined behaviour are for the sanitizers to see.

#include <array>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace sheave::fuzz {

using Bytes = std::span<const std::uint8_t>;

/// What ought to hold does not.
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

/// The text of a scene: it loads, and is the same when written and loaded again, or has faults at
/// places within it.
void try_scene_text(Bytes bytes);
/// A machine with all that there is, and what its step settings are (machine.h): it is refused with
/// a message, or runs 20 steps in which nothing is silently wrong (machine_run.h).
void try_machine(Bytes bytes);
/// A state file, damaged, for a fixed scene: it is refused with a message, or the scene goes on
/// from it.
void try_state(Bytes bytes);
/// A journal of `sheave trade` or a baseline of `sheave bench`: read, or refused with a message.
void try_journal(Bytes bytes);
/// Words of a command line, separated by line breaks: accepted, or refused with a message. Nothing
/// is run.
void try_command_line(Bytes bytes);
/// Requests of a live session, separated by line breaks: each is done or refused, and what is
/// refused changes nothing; the log leads to the same state.
void try_live(Bytes bytes);

/// Texts, in every place where a chart can have one: gnuplot's script has no more commands than
/// without them (chart_texts.h). Nothing is drawn.
void try_chart(Bytes bytes);

/// Edits of a world, one after the other, that take cables apart and put them together, with bodies
/// and joints that come and go and steps in between: each is accepted or refused, and leads to the
/// topology, as a model of what cable/edit.h says (edit_model.h); what is refused changes nothing,
/// and every state that there is can be gone back to.
void try_edit(Bytes bytes);

/// A target by its name.
struct Target {
  std::string_view name;
  void (*run)(Bytes bytes);
};
inline constexpr std::array<Target, 8> targets{{{"scene_text", try_scene_text},
                                                {"machine", try_machine},
                                                {"state", try_state},
                                                {"journal", try_journal},
                                                {"command_line", try_command_line},
                                                {"live", try_live},
                                                {"chart", try_chart},
                                                {"edit", try_edit}}};

}  // namespace sheave::fuzz
