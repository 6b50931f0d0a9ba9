// sheave_bench: how long things take. See bench/README.md.

#include <sheave_version.h>

#include <benchmark/benchmark.h>

#include "bench/control_bench.h"
#include "bench/drives_bench.h"
#include "bench/edit_bench.h"
#include "bench/step_bench.h"

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::AddCustomContext("sheave", SHEAVE_VERSION);
#ifdef NDEBUG
  benchmark::AddCustomContext("assertions", "off");
#else
  benchmark::AddCustomContext("assertions", "ON: these times mean nothing");
#endif
  sheave::bench::register_control_benchmarks();
  sheave::bench::register_edit_benchmarks();
  sheave::bench::register_drive_benchmarks();
  sheave::bench::register_step_benchmarks();
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
