// What an edited journal of trade --resume meets.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/command/journal_text.h"
#include "tests/command/process.h"
#include "tests/command/scenes.h"

namespace sheave::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

TEST(TradeJournal, IsReadAsStrictlyAsAScene) {
  const TemporaryFolder folder;
  const std::string path = folder.write("weights.json", atwood_scene);
  const std::string journal = folder.path("weights.trade");
  const std::vector<std::string> command{"trade",  path,
                                         "--json", "--resume",
                                         journal,  "--solver",
                                         "direct", "--substeps",
                                         "1",      "--reference-seconds",
                                         "1e6",    "--repetitions",
                                         "1"};
  ASSERT_EQ(run_sheave(command).exit_code, 0);
  const json good = trade_journal_json(read_file(journal));
  const auto refused = [&](const char* pointer, const json& value, const char* message) {
    json bad = good;
    const json::json_pointer place(pointer);
    if (value.is_discarded()) {
      bad.at(place.parent_pointer()).erase(place.back());
    } else {
      bad[place] = value;
    }
    const std::string text = trade_journal_text(bad);
    folder.write("weights.trade", text);
    const ProcessResult result = run_sheave(command);
    EXPECT_EQ(result.exit_code, 65) << pointer << result.err;
    EXPECT_THAT(result.err, HasSubstr(message)) << pointer;
    EXPECT_THAT(result.err, testing::ContainsRegex("weights.trade:[0-9]+:[0-9]+: /")) << pointer;
    EXPECT_EQ(read_file(journal), text) << "what is wrong is not written over";
  };
  const json gone = json::parse("", nullptr, false);
  refused("/reference/integrator", 7, "from 0 to 1");
  refused("/reference/integrator", "rattle", "must be a number");
  refused("/reference/substeps", 0, "from 1 to");
  refused("/reference/substeps", 1.5, "a whole number");
  refused("/reference/order", gone, "\"order\" is missing");
  refused("/reference/estimate", json::array({1.0}), "must have 4 elements; it has 1");
  refused("/reference/differences/0", "many", "\"nan\"");
  refused("/reference/godo", true, "did you mean \"good\"?");
  refused("/rows/direct 1", json::object(), "\"fault\" is missing");
  refused("/rows/direct 1/error", gone, "\"error\" is missing");
  refused("/rows/direct 1/fallbacks", -1, "from 0 to");
  refused("/times/direct 1", 3, "must be an array");
  refused("/ladder/rows/0/seconds/4", 1e300, "a whole number from 0 to");
  json later = good;
  later["format"] = "sheave-trade-journal/3";
  folder.write("weights.trade", later.dump());
  const ProcessResult other = run_sheave(command);
  EXPECT_EQ(other.exit_code, 65);
  EXPECT_THAT(other.err, HasSubstr("sheave-trade-journal/3"));
  EXPECT_THAT(other.err, HasSubstr("sheave-trade-journal/2"));
}

}  // namespace
}  // namespace sheave::test
