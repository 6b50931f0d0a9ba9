// Margins of decisions in the text and the JSON of `sheave run --estimate-error`.

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/command/process.h"

namespace sheave::test {
namespace {

using nlohmann::json;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

const std::string scene_of_near_misses = SHEAVE_SOURCE_DIR "/scenes/analytic/near-misses.json";

TEST(DecisionText, TellsDecisionsThatAreCloserThanTheirErrors) {
  // With 4 substeps the ball hits the peg that it misses by 0.1 mm; with 16 it flies past.
  const ProcessResult hits =
      run_sheave({"run", scene_of_near_misses, "--substeps", "4", "--estimate-error"});
  EXPECT_THAT(hits.out, HasSubstr("decided by less than the error: contact of ball and peg"));
  EXPECT_THAT(hits.out, HasSubstr("in this run, and never in the run with 8 substeps"));
  const ProcessResult misses = run_sheave({"run", scene_of_near_misses, "--estimate-error"});
  EXPECT_THAT(misses.out, ContainsRegex("contact of ball and peg +is open +0.0001 m"));
  EXPECT_THAT(misses.out, Not(HasSubstr("decided by less")));
}

TEST(DecisionText, JsonHasAllMargins) {
  const json summary =
      json::parse(run_sheave({"run", scene_of_near_misses, "--estimate-error", "--json"}).out);
  const auto margin_of = [&](const std::string& name) {
    for (const json& own : summary["error_estimate"]["decisions"]) {
      if (own["alternative"] == name) return own["margin"].get<double>();
    }
    return -1.0;
  };
  EXPECT_NEAR(margin_of("link 1 of rope"), 0.001, 1e-6);
  EXPECT_NEAR(margin_of("friction of box and floor"), 0.001, 2e-5);
  EXPECT_NEAR(margin_of("stop upper of guide"), 1e-4, 1e-9);
  const json plain = json::parse(run_sheave({"run", scene_of_near_misses, "--json"}).out);
  EXPECT_FALSE(plain.contains("error_estimate"));
}

}  // namespace
}  // namespace sheave::test
