// sheave live, between two pipes.

#include <chrono>
#include <csignal>
#include <thread>

#include <fcntl.h>
#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "command/failure.h"
#include "command/live/line_reader.h"
#include "command/live/pacer.h"
#include "tests/command/piped_process.h"
#include "tests/command/scenes.h"

namespace sheave::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

/// Runs a session to the end of its input.
ProcessResult hold(const std::vector<std::string>& arguments, const std::string& input) {
  std::vector<std::string> words{"live"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  return run_sheave(words, {.input = input});
}

std::vector<json> parsed_lines(const std::string& text) {
  EXPECT_TRUE(text.empty() || text.back() == '\n');
  std::vector<json> lines;
  for (const std::string& line : split(text, '\n')) {
    json parsed = json::parse(line, nullptr, false);
    EXPECT_FALSE(parsed.is_discarded()) << line;
    lines.push_back(std::move(parsed));
  }
  return lines;
}

// What is read goes to where there is room: a stack of 64 KiB is enough for a session.
TEST(Live, NeedsLittleStack) {
  if (SHEAVE_SANITIZED) GTEST_SKIP() << "sanitizers need a stack of their own";
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  const std::string requests = "{\"type\":\"step\"}\n{\"type\":\"hash\"}\n";
  const ProcessResult little =
      run_sheave({"live", scene}, {.input = requests, .stack_limit = 64 * 1024});
  EXPECT_EQ(little.exit_code, 0) << little.signal;
  EXPECT_EQ(little.out, hold({scene}, requests).out);
}

TEST(Live, SubscribersGetTheWarningsOfTheStartWithTheFirstStep) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("drawn.json", R"({"format": "sheave-scene/1",
    "gravity": [0, -10, 0], "duration": 1, "bodies": [
    {"name": "load", "mobility": "slider", "axis": [0, 1, 0], "mass": 2, "position": [0, -2, 0]}],
    "cables": [{"name": "rope", "axial_stiffness": 1e4, "rest_lengths": [1], "links": [
      {"type": "attachment", "body": "world"}, {"type": "attachment", "body": "load"}]}]})");
  const ProcessResult result = hold({scene}, R"({"type":"subscribe","name":"s","events":true})"
                                             "\n{\"type\":\"step\"}\n{\"type\":\"step\"}\n");
  std::vector<json> warnings;
  for (const json& line : parsed_lines(result.out)) {
    if (line.value("event", "") == "warning") warnings.push_back(line);
  }
  ASSERT_EQ(warnings.size(), 1U) << result.out;
  EXPECT_EQ(warnings[0]["kind"], "strained_start");
  EXPECT_EQ(warnings[0]["step"], 1);
  EXPECT_THAT(result.err, HasSubstr("stretched by 100 % in span 0"));
}

TEST(Live, AnswersEachLineAsItComes) {
  const TemporaryFolder folder;
  PipedProcess process({"live", folder.write("atwood.json", atwood_scene)});
  // The other end waits for each answer before it asks again.
  ASSERT_TRUE(process.write("{\"id\":1,\"type\":\"hello\"}\n"));
  EXPECT_EQ(json::parse(process.read_line())["protocol"], "sheave-live/1");
  ASSERT_TRUE(process.write("{\"id\":2,\"type\":\"step\",\"count\":100}\n"));
  EXPECT_EQ(json::parse(process.read_line())["step"], 100);
  ASSERT_TRUE(process.write("{\"id\":3,\"type\":\"observe\",\"quantities\":[\"light.vy\"]}\n"));
  const json seen = json::parse(process.read_line());
  EXPECT_EQ(seen["id"], 3);
  EXPECT_NEAR(seen["values"]["light.vy"].get<double>(), 2.0, 0.02);  // as the scene's check
  process.close_input();
  EXPECT_EQ(process.read_line(), "");
  EXPECT_EQ(process.wait().exit_code, 0);
}

TEST(Live, GarbageIsAnsweredLineByLine) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  std::string input = "{\"type\":\"hash\"}\nnonsense\n\n[1,2]\r\n";
  input += std::string(3 << 20, 'x') + "\n";
  input += "\xff\xfe\x80\n";
  input += std::string("a\0b", 3) + "\n";
  input += "{\"type\":\"hash\"}";  // without the end of its line
  const ProcessResult result = hold({scene}, input);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, IsEmpty());
  const std::vector<json> lines = parsed_lines(result.out);
  ASSERT_EQ(lines.size(), 8U);
  for (std::size_t i = 1; i < 7; ++i) EXPECT_EQ(lines[i]["ok"], false) << i;
  EXPECT_EQ(lines[4]["errors"][0]["code"], "too-large");
  EXPECT_EQ(lines[0], lines[7]);
  EXPECT_EQ(hold({scene}, "").exit_code, 0);
}

TEST(Live, QuitEndsTheSessionBeforeLaterRequests) {
  const TemporaryFolder folder;
  PipedProcess process({"live", folder.write("atwood.json", atwood_scene)});
  ASSERT_TRUE(process.write("{\"type\":\"quit\"}\n{\"type\":\"step\"}\n"));
  EXPECT_EQ(parsed_lines(process.read_rest()).size(), 1U);
  EXPECT_EQ(process.wait().exit_code, 0);
}

TEST(Live, WrongUseHasItsExitCodes) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  EXPECT_EQ(hold({}, "").exit_code, 2);
  EXPECT_EQ(hold({"-"}, "").exit_code, 2);
  EXPECT_EQ(hold({scene, "--realtime", "0"}, "").exit_code, 2);
  EXPECT_EQ(hold({scene, "--log", scene}, "").exit_code, 2);
  EXPECT_EQ(hold({folder.path("none.json")}, "").exit_code, 66);
  EXPECT_EQ(hold({folder.write("bad.json", "{}")}, "").exit_code, 65);
  EXPECT_EQ(hold({scene, "--load-state", scene}, "").exit_code, 65);
  EXPECT_EQ(hold({scene, "--log", folder.path("none/log")}, "").exit_code, 74);
  EXPECT_EQ(hold({scene, "--set", "/bodies/light/mass=-1"}, "").exit_code, 2);
  const ProcessResult schema = hold({"--schema"}, "");
  EXPECT_EQ(schema.exit_code, 0);
  EXPECT_TRUE(json::parse(schema.out).contains("oneOf"));
  const ProcessResult answers = hold({"--answer-schema"}, "");
  EXPECT_EQ(answers.exit_code, 0);
  EXPECT_TRUE(json::parse(answers.out)["definitions"].contains("answer-to-step"));
}

TEST(Live, ALogLeadsToTheSameState) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("jointed.json", jointed_scene);
  const std::string log = folder.path("log.jsonl");
  ASSERT_EQ(run_sheave({"run", scene, "-q", "--steps", "7", "--save-state", folder.path("a.state")})
                .exit_code,
            0);
  const ProcessResult first =
      hold({scene, "--load-state", folder.path("a.state"), "--log", log},
           R"({"type":"set","controls":[{"type":"gravity","value":[0,-3,0]}]}
{"type":"step","count":20}
wrong
{"type":"snapshot","name":"a"}
{"type":"set","controls":[{"type":"force","body":"stone","force":[5,0,1]}]}
{"type":"step","until":0.9}
{"type":"restore","name":"a"}
{"type":"step","count":5}
{"type":"hash"}
)");
  ASSERT_EQ(first.exit_code, 0) << first.err;
  const ProcessResult again = hold({scene, "--load-state", folder.path("a.state")}, read_file(log));
  const json hash = parsed_lines(first.out).back();
  EXPECT_EQ(hash["step"], 32);
  EXPECT_EQ(parsed_lines(again.out).back()["hash"], hash["hash"]);
  EXPECT_EQ(split(read_file(log), '\n').size(), 8U) << "all but the wrong one";
  for (const json& line : parsed_lines(read_file(log))) EXPECT_TRUE(line.contains("at_step"));
}

/// Waits until a file in the folder, of whatever name, has this text; false if the process ends
/// before.
bool wait_for_text(const TemporaryFolder& folder, const PipedProcess& process,
                   const std::string& text) {
  while (process.running()) {
    for (const std::string& name : folder.entries()) {
      if (read_file(folder.path(name)).find(text) != std::string::npos) return true;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

constexpr const char* wide_subscription =
    R"({"type":"subscribe","name":"all","quantities":["light.y","light.vy","heavy.y","heavy.vy","wheel.angle","wheel.wz",)"
    R"("rope.0.tension","rope.1.tension","energy.total"]})"
    "\n";

TEST(Live, ASlowReaderGetsWholeLinesAndTheNumberOfOmittedOnes) {
  const TemporaryFolder logs;
  const TemporaryFolder folder;
  PipedProcess process({"live", folder.write("atwood.json", atwood_scene), "--set",
                        "/gravity=[0,0,0]", "--log", logs.path("log")});
  // 10 000 lines of more than 200 bytes are much more than a pipe and the command's own memory of
  // lines take.
  ASSERT_TRUE(process.write(std::string(wide_subscription) +
                            "{\"id\":5,\"type\":\"step\",\"count\":10000}\n"));
  // The log says when it has been done; until then nobody reads.
  ASSERT_TRUE(wait_for_text(logs, process, "10000"));
  process.close_input();
  const std::vector<json> lines = parsed_lines(process.read_rest());
  EXPECT_EQ(process.wait().exit_code, 0);
  std::int64_t told = 0;
  std::int64_t dropped = 0;
  int answers = 0;
  std::int64_t last = 0;
  for (const json& line : lines) {
    if (line.contains("ok")) {
      ++answers;
    } else if (line["event"] == "dropped") {
      dropped += line["count"].get<std::int64_t>();
    } else {
      ++told;
      EXPECT_GT(line["step"].get<std::int64_t>(), last);
      last = line["step"].get<std::int64_t>();
    }
  }
  EXPECT_EQ(answers, 2) << "answers are never left out";
  EXPECT_EQ(lines.back()["id"], 5);
  EXPECT_GT(dropped, 0);
  EXPECT_EQ(told + dropped, 10000);
}

TEST(Live, AClosedOutputEndsTheCommandWith74) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  // While it answers, while it steps, and while it waits.
  for (const char* input : {"{\"type\":\"hash\"}\n", "{\"type\":\"run\"}\n", ""}) {
    PipedProcess process({"live", scene});
    ASSERT_TRUE(process.write("{\"type\":\"hello\"}\n"));
    EXPECT_NE(process.read_line(), "");
    process.close_output();
    process.write(input);
    const ProcessResult result = process.wait();
    EXPECT_EQ(result.exit_code, 74) << input;
    EXPECT_THAT(result.err, HasSubstr("standard output: Broken pipe"));
  }
  EXPECT_EQ(run_sheave({"live", scene}, {.input = "{\"type\":\"hash\"}\n", .closed_stdout = true})
                .exit_code,
            74);
}

TEST(Live, SignalsEndTheCommandCleanly) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("endless.json", endless_scene);
  for (const int signal : {SIGINT, SIGTERM}) {
    for (const char* busy :
         {"", "{\"type\":\"run\"}\n", "{\"type\":\"step\",\"count\":1000000}\n"}) {
      const TemporaryFolder logs;
      PipedProcess process({"live", scene, "--realtime", "--log", logs.path("log")});
      ASSERT_TRUE(
          process.write("{\"type\":\"subscribe\",\"name\":\"a\",\"quantities\":[\"t\"]}\n"));
      EXPECT_NE(process.read_line(), "");
      ASSERT_TRUE(process.write(busy));
      // It is at work, or waits.
      if (*busy != '\0') {
        EXPECT_NE(process.read_line(), "");
      }
      process.send(signal);
      const std::vector<json> rest = parsed_lines(process.read_rest());
      EXPECT_EQ(process.wait().exit_code, 130);
      if (std::string_view(busy).find("step") != std::string_view::npos) {
        ASSERT_FALSE(rest.empty());
        EXPECT_EQ(rest.back()["ended"], "interrupted");
      }
      // What has been done is in the log, which leads to where it was.
      const ProcessResult again =
          hold({scene}, read_file(logs.path("log")) + "{\"type\":\"hash\"}\n");
      for (const json& line : parsed_lines(again.out)) EXPECT_TRUE(line.value("ok", true)) << line;
    }
  }
}

TEST(Live, ASignalEndsTheCommandEvenIfNobodyReads) {
  const TemporaryFolder folder;
  const TemporaryFolder logs;
  PipedProcess process({"live", folder.write("atwood.json", atwood_scene), "--set",
                        "/gravity=[0,0,0]", "--log", logs.path("log")});
  ASSERT_TRUE(
      process.write(std::string(wide_subscription) + "{\"type\":\"step\",\"count\":9000}\n"));
  ASSERT_TRUE(wait_for_text(logs, process, "9000"));
  process.send(SIGTERM);
  EXPECT_EQ(process.wait().exit_code, 130);
  // All lines that have an end are whole.
  std::string text = process.read_rest();
  text.resize(text.rfind('\n') + 1);
  EXPECT_GT(parsed_lines(text).size(), 10U);
}

TEST(Live, RealtimeIsNeverFasterThanTheClock) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("endless.json", endless_scene);
  const auto start = std::chrono::steady_clock::now();
  // 20 steps of 10 ms at half the speed of the clock.
  const ProcessResult result =
      hold({scene, "--realtime", "0.5"}, "{\"type\":\"step\",\"count\":20}\n");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_GE(std::chrono::steady_clock::now() - start, std::chrono::milliseconds(400));
  EXPECT_EQ(parsed_lines(result.out)[0]["step"], 20);
}

TEST(Live, ARunningWorldAcceptsRequests) {
  const TemporaryFolder folder;
  // What paces requests to step, here to one in three hours, is not for runs with a pace of their
  // own.
  PipedProcess process({"live", folder.write("endless.json", endless_scene), "--realtime", "1e-6"});
  ASSERT_TRUE(
      process.write("{\"type\":\"subscribe\",\"name\":\"a\",\"every\":10,\"quantities\":[\"t\"]}\n"
                    "{\"type\":\"run\",\"pace\":5}\n"));
  EXPECT_TRUE(json::parse(process.read_line())["ok"].get<bool>());
  EXPECT_TRUE(json::parse(process.read_line())["running"].get<bool>());
  for (int i = 1; i <= 3; ++i) EXPECT_EQ(json::parse(process.read_line())["step"], 10 * i);
  ASSERT_TRUE(process.write("{\"id\":1,\"type\":\"pause\"}\n"));
  json line;
  do {
    line = json::parse(process.read_line());
  } while (!line.contains("id"));
  // It stands still.
  ASSERT_TRUE(process.write("{\"id\":2,\"type\":\"hash\"}\n"));
  EXPECT_EQ(json::parse(process.read_line())["step"], line["step"]);
}

TEST(LineReader, ALineWithoutEndIsAFailure) {
  const int zeros = ::open("/dev/zero", O_RDONLY | O_CLOEXEC);
  ASSERT_GE(zeros, 0);
  command::LineReader reader(zeros, 5, "the input");
  // Twice as many reads as the limit has blocks of 64 KiB.
  int reads = 2 * static_cast<int>(command::LineReader::most_skipped >> 16U);
  std::string message;
  try {
    for (; reads > 0; --reads) {
      EXPECT_FALSE(reader.next());
      reader.read();
    }
  } catch (const command::Failure& failure) {
    message = failure.what();
    EXPECT_EQ(failure.code(), command::ExitCode::io);
  }
  EXPECT_GT(reads, 0);
  EXPECT_THAT(message, HasSubstr("the input: a line has more than 64 MiB"));
  ::close(zeros);
}

TEST(LineReader, AssemblesLinesFromAnyPieces) {
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe(ends.data()), 0);
  command::LineReader reader(ends[0], 5, "the pipe");
  const auto give = [&](std::string_view text) {
    ASSERT_EQ(::write(ends[1], text.data(), text.size()), static_cast<ssize_t>(text.size()));
    reader.read();
  };
  EXPECT_FALSE(reader.next());
  give("ab");
  EXPECT_FALSE(reader.next());
  give("c\n\n12345\n123456\n1234");
  EXPECT_EQ(reader.next()->text, "abc");
  EXPECT_EQ(reader.next()->text, "");
  EXPECT_EQ(reader.next()->text, "12345");
  EXPECT_TRUE(reader.next()->too_long);
  EXPECT_FALSE(reader.next());
  give("56");
  EXPECT_FALSE(reader.next());
  give("789");
  EXPECT_FALSE(reader.next());
  give("0\nlast");
  EXPECT_TRUE(reader.next()->too_long);
  EXPECT_FALSE(reader.next());
  ::close(ends[1]);
  reader.read();
  EXPECT_EQ(reader.next()->text, "last");
  EXPECT_FALSE(reader.next());
  EXPECT_TRUE(reader.at_end());
  ::close(ends[0]);
}

TEST(Pacer, WaitsForEachStepAndDoesNotCatchUpAfterAJump) {
  command::Pacer pacer(0.1);
  EXPECT_EQ(pacer.until(0.1), 0.0) << "as fast as it can";
  pacer.set_pace(1e-3);  // a step takes 100 s, so that no clock of this test matters
  EXPECT_NEAR(pacer.until(0.1), 100.0, 30.0);
  EXPECT_NEAR(pacer.until(0.2), 200.0 - 100.0, 30.0) << "put ahead, it begins anew";
  EXPECT_EQ(pacer.until(-5.0), 0.0) << "put back, it is late, and begins anew there";
  EXPECT_NEAR(pacer.until(-4.9), 100.0, 30.0);
  pacer.set_pace({});
  EXPECT_EQ(pacer.until(1e9), 0.0);
}

}  // namespace
}  // namespace sheave::test
