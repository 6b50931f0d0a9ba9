#pragma once

namespace sheave::bench {

/// "edit_*": one cable of a world changes while it runs.
void register_edit_benchmarks();

}  // namespace sheave::bench
