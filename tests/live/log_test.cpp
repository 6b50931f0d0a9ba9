// What is written into a log, given to another session, leads to the same state.

#include <gmock/gmock.h>

#include "tests/live/live_scenes.h"
#include "tests/support/random.h"

namespace sheave::test {
namespace {

using nlohmann::json;
using testing::ElementsAre;

/// A session that writes a log.
struct Logged {
  std::vector<std::string> log;
  live::Session session;
  explicit Logged(const live::Limits& limits = {})
      : session(session_of(live_scene,
                           {.log = [this](const std::string& line) { log.push_back(line); }},
                           limits)) {}

  /// The hash that its log leads to in a new session, which writes the same log.
  std::uint64_t replayed() {
    session.finish_log();
    Logged again;
    for (const std::string& line : log) done(again.session, line);
    again.session.finish_log();
    EXPECT_EQ(again.log, log);
    return hash_of(again.session);
  }
};

TEST(LiveLog, HasTheRequestsWithTheStepsAtWhichTheyCame) {
  Logged logged;
  done(logged.session, R"(  {"id":1, "type":"hello"} )");
  done(logged.session, R"({"type":"step","until":0.04})");
  EXPECT_EQ(ask(logged.session, R"({"type":"stpe"})")["ok"], false);
  done(logged.session, R"({"type":"snapshot","name":"a","at_step":4})");
  done(logged.session, R"({"type":"run"})");
  for (int i = 0; i < 3; ++i) logged.session.advance();
  done(logged.session, R"({"type":"set","controls":[]})");
  for (int i = 0; i < 2; ++i) logged.session.advance();
  done(logged.session, R"({"type":"pause"})");
  done(logged.session, R"({"type":"restore","name":"a"})");
  done(logged.session, R"({"type":"step"})");
  EXPECT_THAT(logged.log, ElementsAre(R"({"at_step":0,"id":1, "type":"hello"})",
                                      R"({"at_step":0,"type":"step","count":4})",
                                      R"({"type":"snapshot","name":"a","at_step":4})",
                                      R"({"at_step":4,"type":"step","count":3})",
                                      R"({"at_step":7,"type":"set","controls":[]})",
                                      R"({"at_step":7,"type":"step","count":2})",
                                      R"({"at_step":9,"type":"restore","name":"a"})",
                                      R"({"at_step":4,"type":"step","count":1})"));
  EXPECT_EQ(logged.replayed(), hash_of(logged.session));
}

TEST(LiveLog, ReplaysRandomSessions) {
  Random random(3);
  for (int round = 0; round < 20; ++round) {
    Logged logged;
    for (int i = 0; i < 60; ++i) {
      const double x = random.between(-1.0, 1.0);
      const auto number = [&] { return json(x).dump(); };
      const std::string lines[] = {
          R"({"type":"set","controls":[{"type":"speed","body":"drum","value":)" + number() +
              R"(},{"type":"force","body":"load","force":[)" + number() + ",0,0]}]}",
          R"({"type":"set","controls":[{"type":"motion","body":"hand","position":[3,)" + number() +
              R"(,0],"over":0.3}]})",
          R"({"type":"clear","controls":[{"type":"force","body":"load"},{"type":"motion","body":"hand"}]})",
          R"({"type":"place","body":"load","keep":"tension","position":[0,)" +
              json(x - 4.0).dump() + ",0]}",
          R"({"type":"snapshot","name":"a"})",
          R"({"type":"restore","name":"a"})",
          R"({"type":"step","count":3})",
          R"({"type":"observe","poses":["load"]})",
          R"({"type":"run"})",
          R"({"type":"pause"})"};
      // Some of them cannot be done, and do nothing here as there.
      static_cast<void>(ask(logged.session, lines[random.below(10)]));
      if (logged.session.is_running()) logged.session.advance();
    }
    ASSERT_EQ(logged.replayed(), hash_of(logged.session)) << "round " << round;
  }
}

TEST(LiveLog, ReplaysWhatEndedEarly) {
  for (const char* fatal :
       {R"({"type":"set","controls":[{"type":"angle","body":"dial","value":10,"over":0.1}]})",
        R"({"type":"set","controls":[{"type":"force","body":"load","force":[1e15,0,0]}]})"}) {
    for (const bool runs : {false, true}) {
      Logged logged;
      done(logged.session, R"({"type":"step","count":3})");
      done(logged.session, fatal);
      if (runs) {
        done(logged.session, R"({"type":"run"})");
        for (int i = 0; i < 100 && logged.session.is_running(); ++i) logged.session.advance();
        EXPECT_FALSE(logged.session.is_running());
      } else {
        EXPECT_TRUE(done(logged.session, R"({"type":"step","count":100})").contains("ended"));
      }
      EXPECT_EQ(logged.replayed(), hash_of(logged.session)) << fatal << runs;
    }
  }
}

TEST(LiveLog, DividesStepsThatAreTooManyForARequest) {
  live::Limits limits;
  limits.steps = 4;
  Logged logged(limits);
  done(logged.session, R"({"type":"run"})");
  for (int i = 0; i < 10; ++i) logged.session.advance();
  logged.session.finish_log();
  EXPECT_THAT(logged.log, ElementsAre(R"({"at_step":0,"type":"step","count":4})",
                                      R"({"at_step":4,"type":"step","count":4})",
                                      R"({"at_step":8,"type":"step","count":2})"));
}

}  // namespace
}  // namespace sheave::test
