#pragma once
// Ctrl-C and its relatives end a simulation, within a step if that takes long, so that what was
// computed is kept.

namespace sheave::command {

/// From now on SIGINT, SIGTERM and SIGHUP (unless ignored, as under nohup) set a flag the first
/// time; another one half a second later or more sets the second flag, and a third one half a
/// second after that ends the process as usual.
void catch_interrupts();
/// Whether such a signal has come.
[[nodiscard]] bool interrupted();
/// Whether a second one has come: what waits for others, an encoder that finishes its video, is
/// given up.
[[nodiscard]] bool hurried();

}  // namespace sheave::command
