#pragma once
// Ctrl-C and its relatives end a simulation between two steps, so that what was computed is kept.

namespace sheave::tools {

/// From now on SIGINT, SIGTERM and SIGHUP (unless ignored, as under nohup) set a flag the first
/// time; another one half a second later or more ends the process as usual.
void catch_interrupts();
/// Whether such a signal has come.
[[nodiscard]] bool interrupted();

}  // namespace sheave::tools
