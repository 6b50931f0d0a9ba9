#pragma once

namespace sheave::bench {

/// Time of a step of worlds with 1,000 driven bodies, all of which are set anew before it, against
/// the same worlds left alone.
void register_drive_benchmarks();

}  // namespace sheave::bench
