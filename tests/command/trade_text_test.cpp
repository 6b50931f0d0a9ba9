// sheave trade: which setting it names, and its text.

#include <cmath>
#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "command/failure.h"
#include "command/trade/table.h"

namespace sheave::test {
namespace {

using testing::HasSubstr;
using testing::Not;

command::TradeRow trade_row(int substeps, double seconds, double error) {
  command::TradeRow row;
  row.setting.step = {0.01, substeps, 10, SolverKind::direct, IntegratorKind::xpbd};
  row.seconds = {seconds, seconds, seconds, seconds, 5};
  row.error.position = error;
  return row;
}

TEST(TradeText, ShowsFailuresAndChoosesByKnownErrors) {
  command::TradeTable table;
  table.dt = 0.01;
  table.rows = {trade_row(1, 1.0, 5e-2), trade_row(2, 2.0, 8e-3), trade_row(4, 4.0, 1e-3),
                trade_row(8, 3.0, 0.0)};
  table.rows[3].fault = "diverged: the wheel";
  table.doubt.position = 1e-4;
  command::judge(table);
  EXPECT_TRUE(table.rows[1].on_front);
  EXPECT_FALSE(table.rows[3].on_front);
  const std::string text = command::trade_text(table);
  EXPECT_THAT(text, HasSubstr("direct 8: failed: diverged: the wheel"));
  EXPECT_THAT(text, HasSubstr("cheapest setting for 1 %: direct 2: 20 ms per frame"));
  // 1e-3 is known up to 1e-4, so it may be more than 0.1 %.
  EXPECT_THAT(text, HasSubstr("cheapest setting for 0.1 %: none of these"));
  EXPECT_EQ(command::answer(table, {.seconds_per_frame = 0.025}), 1U);
  EXPECT_THAT(command::trade_chart_script(table, command::ChartFormat::svg).text(),
              HasSubstr("1 of 4 settings failed"));
}

TEST(TradeText, ChoosesByTheWorseOfPositionsAndTensions) {
  // The cheapest setting has its positions within 0.1 % and its tensions off by 45 %.
  command::TradeTable table;
  table.dt = 0.01;
  table.rows = {trade_row(1, 1.0, 5e-4), trade_row(2, 2.0, 3e-4), trade_row(4, 4.0, 1e-4)};
  table.rows[0].error.tension = 0.45;
  table.rows[1].error.tension = 0.02;
  table.rows[2].error.tension = 5e-4;
  table.doubt.tension = 1e-5;
  EXPECT_EQ(command::answer(table, {.error = 1e-3}), 2U);
  EXPECT_EQ(command::answer(table, {.error = 0.03}), 1U);
  EXPECT_EQ(command::answer(table, {.error = 1e-3, .tension_error = 0.03}), 1U);
  EXPECT_EQ(command::answer(table, {.error = 1e-3, .tension_error = 0.5}), 0U);
  EXPECT_EQ(command::answer(table, {.tension_error = 1e-3}), 2U);
  EXPECT_FALSE(command::answer(table, {.error = 1e-4}));
  // 2.5 s per second: the most accurate of two has its tensions within 2 %.
  EXPECT_EQ(command::answer(table, {.seconds_per_frame = 0.025}), 1U);
  EXPECT_EQ(command::answer(table, {.seconds_per_frame = 0.015}), 0U);
  EXPECT_THAT(command::trade_text(table),
              HasSubstr("per simulated second, position error 1.0e-04, tension error 5.0e-04"));
  // Where bodies are hit nobody knows tensions, and positions alone count, which is told.
  table.doubt.tension = 0.3;
  EXPECT_FALSE(table.tensions_known());
  EXPECT_EQ(command::answer(table, {.error = 1e-3}), 0U);
  EXPECT_FALSE(command::answer(table, {.error = 1e-3, .tension_error = 0.1}));
  EXPECT_THAT(command::trade_text(table), HasSubstr("settings are chosen by positions alone"));
  // Without cables there are none.
  for (command::TradeRow& row : table.rows) {
    row.error.tension = std::numeric_limits<double>::quiet_NaN();
  }
  table.doubt.tension = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(command::answer(table, {.error = 1e-3}), 0U);
  EXPECT_THAT(command::trade_text(table), Not(HasSubstr("tension error 5")));
}

TEST(TradeText, NamesSkippedSettingsCheapestFirst) {
  command::TradeTable table;
  table.dt = 0.01;
  table.most_minutes = 2.0;
  table.rows = {trade_row(1, 1.0, 1e-5), trade_row(8, 0.0, 0.0), trade_row(4, 0.0, 0.0)};
  table.rows[1].skipped = "takes about 80 s, and 20 s are left";
  table.rows[1].expected_seconds = 80.0;
  table.rows[2].skipped = "takes about 40 s, and 20 s are left";
  table.rows[2].expected_seconds = 40.0;
  command::judge(table);
  EXPECT_THAT(
      command::trade_text(table),
      HasSubstr("2 of 3 settings were skipped, for which 2 minutes are too few (--minutes). "
                "Their runs take about 2 min 00 s of CPU time, cheapest first: direct 4 (40 "
                "s); direct 8 (1 min 20 s)"));
  EXPECT_THAT(command::trade_csv(table), HasSubstr("\"takes about 40 s, and 20 s are left\""));
}

TEST(TradeText, ShowsTheLadderWithItsFaults) {
  command::TradeTable table;
  table.dt = 0.01;
  table.compared_seconds = 3.0;
  table.rows = {trade_row(1, 1.0, 1e-5)};
  command::TradeLadder ladder;
  ladder.setting = table.rows[0].setting;
  ladder.setting_error = 2e-4;
  ladder.seconds = {2e-3, 1.9e-3, 2.1e-3, 1.8e-3, 5};
  ladder.row_solves = 1000.0;
  ladder.absent = {"no ground"};
  command::LadderRow rigid{"rigid cables", "cables", "no compliance", 3, {}};
  rigid.difference = {1.5e-3, 2.5e-2};
  rigid.seconds = {1.5e-3, 1.4e-3, 1.6e-3, 1.4e-3, 5};
  rigid.row_solves = 900.0;
  ladder.rows = {rigid, {"massless wheels", "wheels", "", 2, "diverged: the drum"}};
  table.ladder = ladder;
  command::judge(table);
  const std::string text = command::trade_text(table);
  EXPECT_THAT(text, HasSubstr("in the first 3 s"));
  EXPECT_THAT(text, testing::ContainsRegex("rigid cables +cables: 3 +1.5e-03 +2.5e-02 +1.5 +1.4 - "
                                           "1.6 +25 % +10 %"));
  EXPECT_THAT(text, testing::ContainsRegex("massless wheels +wheels: 2 +not possible"));
  EXPECT_THAT(text, HasSubstr("massless wheels: diverged: the drum"));
  EXPECT_THAT(text, HasSubstr("nothing to change in this scene: no ground"));
  EXPECT_THAT(command::trade_markdown(table), HasSubstr("| rigid cables | cables: 3 | 1.5e-03 |"));
}

TEST(TradeText, ReadsQuestions) {
  EXPECT_DOUBLE_EQ(command::budget_seconds("2ms/frame"), 2e-3);
  EXPECT_DOUBLE_EQ(command::budget_seconds("1.5e2us/frame"), 1.5e-4);
  EXPECT_DOUBLE_EQ(command::error_share("0.1%"), 1e-3);
  EXPECT_DOUBLE_EQ(command::error_share("1e-3"), 1e-3);
  for (const char* wrong : {"", "ms/frame", "nan%", "inf", "1 %", "0x1%"}) {
    EXPECT_THROW(static_cast<void>(command::error_share(wrong)), command::Failure) << wrong;
    EXPECT_THROW(static_cast<void>(command::budget_seconds(wrong)), command::Failure) << wrong;
  }
}

}  // namespace
}  // namespace sheave::test
