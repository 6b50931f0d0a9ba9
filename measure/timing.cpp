#include "measure/timing.h"

#include <algorithm>

#include "measure/instruction_counter.h"

namespace sheave::measure {
namespace {

constexpr std::int64_t warm_up_frames = 60;

/// Result of one sample, per frame.
struct Sample {
  double seconds = 0.0;
  std::optional<double> instructions;
  bool failed = false;
};

bool run(const Contender& contender, std::int64_t frames) {
  bool good = true;
  for (std::int64_t i = 0; i < frames; ++i) good = contender.frame() && good;
  return good;
}

Sample take_sample(const Contender& contender, const TimingOptions& options,
                   const InstructionCounter& counter) {
  Sample sample;
  double total = 0.0;
  double instructions = 0.0;
  bool counted = counter.available();
  std::int64_t frames = 0;
  do {
    contender.restart();
    const std::optional<std::uint64_t> first = counter.read();
    const double start = options.clock.cpu();
    sample.failed = !run(contender, contender.frames);
    total += options.clock.cpu() - start;
    const std::optional<std::uint64_t> last = counter.read();
    counted = counted && first && last;
    if (counted) instructions += static_cast<double>(*last - *first);
    frames += contender.frames;
  } while (total < options.least_sample && !sample.failed);
  sample.seconds = total / static_cast<double>(frames);
  if (counted) sample.instructions = instructions / static_cast<double>(frames);
  return sample;
}

Timing summary(const std::vector<Sample>& samples) {
  std::vector<double> seconds;
  std::vector<double> instructions;
  Timing timing;
  for (const Sample& sample : samples) {
    seconds.push_back(sample.seconds);
    if (sample.instructions) instructions.push_back(*sample.instructions);
    timing.failed = timing.failed || sample.failed;
  }
  timing.seconds = spread_of(seconds);
  if (instructions.size() == samples.size()) timing.instructions = quantile(instructions, 0.5);
  return timing;
}

}  // namespace

std::vector<Timing> time_interleaved(const std::vector<Contender>& contenders,
                                     const TimingOptions& options) {
  const InstructionCounter counter;
  std::vector<std::vector<Sample>> samples(contenders.size());
  const auto rounds = static_cast<std::int64_t>(options.repetitions);
  const auto count = static_cast<std::int64_t>(contenders.size());
  for (std::int64_t round = 0; round < rounds; ++round) {
    for (std::int64_t i = 0; i < count; ++i) {
      const Contender& contender = contenders[static_cast<std::size_t>(i)];
      if (options.observe && !options.observe(round * count + i, rounds * count, contender.name)) {
        return {};
      }
      if (round == 0 && options.warm_up) {
        contender.restart();
        run(contender, std::min(contender.frames, warm_up_frames));
      }
      samples[static_cast<std::size_t>(i)].push_back(take_sample(contender, options, counter));
    }
  }
  std::vector<Timing> timings;
  for (const std::vector<Sample>& own : samples) timings.push_back(summary(own));
  return timings;
}

}  // namespace sheave::measure
