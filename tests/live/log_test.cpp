// What is written into a log, given to another session, leads to the same state.

#include <map>

#include <gmock/gmock.h>

#include "tests/live/live_scenes.h"
#include "tests/support/effort.h"
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

/// Lines without their checksums.
std::vector<std::string> requests_of(std::vector<std::string> log) {
  for (std::string& line : log) line = line.substr(0, line.rfind(",\"checksum\":\"")) + "}";
  return log;
}

TEST(LiveLog, HasEachRequestWithItsStep) {
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
  EXPECT_THAT(requests_of(logged.log), ElementsAre(R"({"at_step":0,"id":1, "type":"hello"})",
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
  for (int round = 0; round < (test::instrumented ? 4 : 20); ++round) {
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

TEST(LiveLog, ReplaysSessionsThatEndedEarly) {
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

TEST(LiveLog, DividesMoreStepsThanARequestMayHave) {
  live::Limits limits;
  limits.steps = 4;
  Logged logged(limits);
  done(logged.session, R"({"type":"run"})");
  for (int i = 0; i < 10; ++i) logged.session.advance();
  logged.session.finish_log();
  EXPECT_THAT(requests_of(logged.log), ElementsAre(R"({"at_step":0,"type":"step","count":4})",
                                                   R"({"at_step":4,"type":"step","count":4})",
                                                   R"({"at_step":8,"type":"step","count":2})"));
}

/// A log with lines of each kind.
std::vector<std::string> small_log() {
  Logged logged;
  done(logged.session, R"({"type":"set","controls":[{"type":"speed","body":"drum","value":0.5}]})");
  done(logged.session, R"({"type":"step","count":2})");
  done(logged.session, R"({"type":"snapshot","name":"a"})");
  done(logged.session, R"({"type":"step"})");
  return logged.log;
}

/// Gives a log to a session; the lines that are refused, counted from 0, with the faults.
std::map<std::size_t, json> refused_of(live::Session& session,
                                       const std::vector<std::string>& log) {
  std::map<std::size_t, json> refused;
  for (std::size_t i = 0; i < log.size(); ++i) {
    const json answer = ask(session, log[i]);
    if (!answer["ok"]) refused[i] = answer["errors"];
  }
  return refused;
}

/// The line and all behind it are refused, the first of them because of what the text says.
void expect_refused_from(std::size_t line, const std::map<std::size_t, json>& refused,
                         std::size_t lines, const char* text) {
  ASSERT_EQ(refused.size(), lines - line);
  ASSERT_EQ(refused.begin()->first, line);
  EXPECT_THAT(refused.begin()->second.dump(), testing::HasSubstr(text));
}

TEST(LiveLog, AnyChangedByteIsRefusedWithAllLinesBehindIt) {
  const std::vector<std::string> good = small_log();
  live::Session session = session_of(live_scene);
  const std::size_t first = refused_of(session, good).size();
  ASSERT_EQ(first, 0U);
  // A session in which no line of a log has been done yet: where all are refused it stays one.
  live::Session fresh = session_of(live_scene);
  const std::uint64_t hash = hash_of(fresh);
  for (std::size_t i = 0; i < good[0].size(); ++i) {
    for (const char other :
         {static_cast<char>(good[0][i] ^ 1), static_cast<char>(good[0][i] ^ 16), ' ', '}', '0'}) {
      if (other == good[0][i]) continue;
      std::vector<std::string> bad = good;
      bad[0][i] = other;
      ASSERT_EQ(refused_of(fresh, bad).size(), good.size()) << bad[0];
    }
  }
  EXPECT_EQ(hash_of(fresh), hash);
  // Of the last line, after the others.
  const std::string& last = good.back();
  for (std::size_t i = 0; i < last.size(); i += 3) {
    std::vector<std::string> bad = good;
    bad.back()[i] = static_cast<char>(last[i] ^ 1);
    live::Session own = session_of(live_scene);
    ASSERT_EQ(refused_of(own, bad).size(), 1U) << bad.back();
  }
}

TEST(LiveLog, EachLineOccursOnceAndInOrder) {
  const std::vector<std::string> good = small_log();
  const char* const text = "lines were removed, repeated or moved";
  for (std::size_t i = 0; i < good.size(); ++i) {
    const auto place = static_cast<std::ptrdiff_t>(i);
    std::vector<std::string> bad = good;
    bad.erase(bad.begin() + place);
    live::Session without = session_of(live_scene);
    if (i + 1 < good.size()) expect_refused_from(i, refused_of(without, bad), bad.size(), text);
    if (i + 1 < good.size()) {
      bad = good;
      std::swap(bad[i], bad[i + 1]);
      live::Session swapped = session_of(live_scene);
      const std::map<std::size_t, json> refused = refused_of(swapped, bad);
      ASSERT_FALSE(refused.empty());
      EXPECT_EQ(refused.begin()->first, i);
    }
    bad = good;
    bad.insert(bad.begin() + place, good[i]);
    live::Session doubled = session_of(live_scene);
    const std::map<std::size_t, json> refused = refused_of(doubled, bad);
    // The second of both does nothing, and the others do what they did.
    ASSERT_EQ(refused.size(), 1U);
    EXPECT_EQ(refused.begin()->first, i + 1);
    EXPECT_THAT(refused.begin()->second.dump(), testing::HasSubstr(text));
  }
}

// A person may go on where a log ends, and requests without a checksum are as they always were.
TEST(LiveLog, OtherRequestsNeedNoChecksum) {
  live::Session session = session_of(live_scene);
  ASSERT_TRUE(refused_of(session, small_log()).empty());
  done(session, R"({"type":"step"})");
  const json answer = ask(session, R"({"type":"step","checksum":"some"})");
  EXPECT_THAT(answer.dump(), testing::HasSubstr("the line has been changed"));
}

}  // namespace
}  // namespace sheave::test
