#pragma once

namespace sheave::bench {

/// Time of one call of the setters of a LiveWorld, with values that change from call to call.
void register_control_benchmarks();

}  // namespace sheave::bench
