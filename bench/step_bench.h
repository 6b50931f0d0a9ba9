#pragma once

namespace sheave::bench {

/// Time of World::step on scenes of one long cable: paper/simple and wheel trains.
void register_step_benchmarks();

}  // namespace sheave::bench
