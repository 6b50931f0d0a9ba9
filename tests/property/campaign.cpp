#include "tests/property/campaign.h"

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <limits>

#include <gtest/gtest.h>

#include "tests/property/known_seeds.h"
#include "tests/support/effort.h"

namespace sheave::test {
namespace {

/// A number from the environment, or `otherwise`.
std::uint64_t from_environment(const char* name, std::uint64_t otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : std::strtoull(text, nullptr, 10);
}

bool campaign_asked_for() {
  return std::getenv("SHEAVE_CASES") != nullptr || std::getenv("SHEAVE_SEED") != nullptr;
}

double share_of_limit(const Finding& finding) {
  if (finding.limit > 0.0) return finding.value / finding.limit;
  return finding.value > 0.0 ? std::numeric_limits<double>::infinity() : finding.value;
}

}  // namespace

void Finding::worsen(double new_value, double new_limit, const std::string& where) {
  Finding other{true, new_value, new_limit, where};
  const bool first = value == 0.0 && limit == 0.0;
  // A value that is not a number is worse than any other and stays.
  if (first || !(share_of_limit(other) <= share_of_limit(*this))) *this = other;
}

void run_campaign(const std::string& property, const Traits& traits,
                  const std::function<Finding(const Machine&, std::uint64_t seed)>& check) {
  run_campaign_on(
      property, instrumented || !optimised ? 10 : 100,
      [&](std::uint64_t seed) { return random_machine(seed, traits); }, check);
}

void run_campaign_on(const std::string& property, std::uint64_t usual_cases,
                     const std::function<RandomMachine(std::uint64_t seed)>& draw,
                     const std::function<Finding(const Machine&, std::uint64_t seed)>& check) {
  const std::uint64_t first = from_environment("SHEAVE_SEED", 1);
  const std::uint64_t cases = from_environment("SHEAVE_CASES", usual_cases);
  const std::map<std::uint64_t, std::string> known = known_seeds(property);
  std::uint64_t checked = 0;
  std::int64_t steps = 0;
  std::int64_t dropped = 0;
  long refused = 0;
  std::string failures;
  Finding worst;
  std::uint64_t worst_seed = 0;
  for (std::uint64_t seed = first; seed < first + cases; ++seed) {
    RandomMachine random;
    Finding finding;
    try {
      random = draw(seed);
      finding = check(random.machine, seed);
    } catch (const std::exception& error) {
      finding = {true, 1.0, 0.0, error.what()};
    }
    refused += random.refused;
    steps += finding.steps;
    dropped += finding.dropped;
    if (!finding.checked) continue;
    ++checked;
    if (known.contains(seed)) {
      EXPECT_FALSE(finding.holds())
          << property << ", seed " << seed << ": mended, but still in tests/property/known/"
          << property << ".json: " << known.at(seed);
      continue;
    }
    if (!(share_of_limit(finding) <= share_of_limit(worst)) || checked == 1) {
      worst = finding;
      worst_seed = seed;
    }
    if (finding.holds()) continue;
    failures += " " + std::to_string(seed);
    ADD_FAILURE() << property << ", seed " << seed << ": " << finding.value
                  << " instead of at most " << finding.limit << ": " << finding.what << "\n  "
                  << describe(random.machine);
  }
  // All of them refused or passed over would test nothing.
  EXPECT_GT(checked, cases / 4);
  const double part = steps > 0 ? static_cast<double>(dropped) / static_cast<double>(steps) : 0.0;
  EXPECT_LE(part, most_dropped) << dropped << " of " << steps << " steps were not compared";
  if (!campaign_asked_for()) return;
  std::printf(
      "%s: %llu cases, %llu checked, %.2g of the steps dropped, %ld refused draws, worst %.3g of "
      "limit %.3g (seed %llu: %s), failures:%s\n",
      property.c_str(), static_cast<unsigned long long>(cases),
      static_cast<unsigned long long>(checked), part, refused, worst.value, worst.limit,
      static_cast<unsigned long long>(worst_seed), worst.what.c_str(),
      failures.empty() ? " none" : failures.c_str());
}

}  // namespace sheave::test
