#pragma once
// SIGINT and similar signals end a simulation and keep its results. A long step is interrupted
// before its end.

namespace sheave::command {

/// Installs handlers for SIGINT, SIGTERM and SIGHUP (unless ignored, as under nohup). The first
/// signal sets a flag. A second one at least 0.5 s later sets a second flag. A third one at least
/// 0.5 s after that ends the process by the signal's default action.
void catch_interrupts();
/// Whether a first signal has come.
[[nodiscard]] bool interrupted();
/// Whether a second signal has come: waiting for other programs, such as an encoder that completes
/// its video, is then given up.
[[nodiscard]] bool hurried();

}  // namespace sheave::command
