// sheave live: holds a world and serves another program by lines on standard input and output.

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <memory>
#include <optional>

#include <poll.h>
#include <unistd.h>

#include <CLI/CLI.hpp>

#include "command/command_line.h"
#include "command/interrupt.h"
#include "command/live/line_reader.h"
#include "command/live/line_writer.h"
#include "command/live/pacer.h"
#include "command/output/faults.h"
#include "command/output/file.h"
#include "command/output/paths.h"
#include "command/registry.h"
#include "command/run/player.h"
#include "command/scene_options.h"
#include "command/terminal.h"
#include "live/session.h"
#include "scenes/start_warnings.h"

namespace sheave::command {
namespace {

constexpr double idle = 0.1;  // [s]; short, because a signal just before a wait does not end it

struct LiveOptions {
  SceneOptions scene;
  std::optional<double> realtime;
  std::string log;
  bool schema = false;
  bool answer_schema = false;
  bool reference = false;
};

/// The requests of a session, in a file that another session can replay.
class RequestLog {
 public:
  RequestLog(const std::string& path, OutputFaults& faults) : faults_(faults) {
    if (!path.empty()) file_.emplace(path);
  }
  [[nodiscard]] bool is_open() const { return file_.has_value(); }
  void write(const std::string& line) {
    attempt([&] { file_->write(line + "\n"); });
  }
  void flush() {
    attempt([&] { file_->flush(); });
  }
  void finish() {
    attempt([&] { file_->commit(); });
    file_.reset();
  }

 private:
  void attempt(const std::function<void()>& action) {
    if (!file_ || faults_.attempt(action)) return;
    faults_.attempt([&] { file_->salvage(); });
    file_.reset();
  }

  OutputFaults& faults_;
  std::optional<OutputFile> file_;
};

/// A session between standard input and standard output.
class LiveServer {
 public:
  LiveServer(const LiveOptions& options, const Scene& scene, Simulation simulation)
      : realtime_(options.realtime),
        log_(options.log, faults_),
        writer_(STDOUT_FILENO, live::dropped_event),
        reader_(STDIN_FILENO, live::Limits{}.line_bytes, "standard input"),
        step_pacer_(scene.model.step.dt),
        run_pacer_(scene.model.step.dt),
        step_(scene.model.step.dt),
        session_(scene, std::move(simulation), hooks(), {}, start_warnings(scene)) {
    step_pacer_.set_pace(realtime_);
  }

  ExitCode serve() {
    faults_.attempt([&] {
      while (!is_over()) turn();
    });
    session_.finish_log();
    log_.finish();
    writer_.finish();
    if (!writer_.fault().empty()) faults_.add(writer_.fault());
    return faults_.report(interrupted() ? ExitCode::interrupted : ExitCode::done);
  }

 private:
  [[nodiscard]] bool is_over() const {
    return ends() || session_.has_quit() || (reader_.at_end() && !has_lines_);
  }
  [[nodiscard]] bool ends() const { return interrupted() || !writer_.fault().empty(); }

  live::Hooks hooks() {
    live::Hooks hooks;
    hooks.event = [this](const std::string& line, bool needed) {
      if (needed) writer_.write(line);
      if (!needed) writer_.offer(line);
    };
    if (log_.is_open()) hooks.log = [this](const std::string& line) { log_.write(line); };
    hooks.before_step = [this](double time) {
      while (!ends()) {
        const double wait = step_pacer_.until(time);
        if (wait <= 0.0) return true;
        writer_.wait(wait);
      }
      return false;
    };
    hooks.stop = [this] { return ends(); };
    return hooks;
  }

  /// Answers pending requests, waits for more, and steps a running world.
  void turn() {
    const std::optional<LineReader::Line> line = reader_.next();
    has_lines_ = line.has_value();
    if (line) {
      writer_.write(line->too_long ? session_.answer_to_long_line() : session_.answer(line->text));
    } else {
      log_.flush();
    }
    const double wait = session_.is_running() ? time_to_step() : idle;
    if (!has_lines_ && !reader_.at_end()) wait_for_input(std::min(wait, idle));
    if (session_.is_running() && !ends() && time_to_step() <= 0.0) session_.advance();
  }

  double time_to_step() {
    run_pacer_.set_pace(session_.pace() ? session_.pace() : realtime_);
    return run_pacer_.until(session_.world().time() + step_);
  }

  void wait_for_input(double seconds) {
    const short wanted = writer_.has_pending() ? POLLOUT : 0;
    std::array<pollfd, 2> files{{{STDIN_FILENO, POLLIN, 0}, {STDOUT_FILENO, wanted, 0}}};
    // A positive time must not be rounded down to 0.
    const int milliseconds = seconds > 0.0 ? static_cast<int>(1e3 * seconds) + 1 : 0;
    if (::poll(files.data(), files.size(), milliseconds) <= 0) return;
    if (files[0].revents != 0) {
      reader_.read();
      has_lines_ = true;  // the bytes read may complete a line
    }
    // A program that has ended has closed both pipes.
    const bool broken = (files[1].revents & (POLLERR | POLLNVAL)) != 0;
    if (broken && !reader_.at_end()) writer_.break_off();
    if (files[1].revents != 0) writer_.wait(0.0);
  }

  std::optional<double> realtime_;
  OutputFaults faults_;
  RequestLog log_;
  LineWriter writer_;
  LineReader reader_;
  Pacer step_pacer_;  // for requests to step
  Pacer run_pacer_;   // for a world that runs by itself
  double step_;
  bool has_lines_ = true;
  live::Session session_;
};

ExitCode run_live(const LiveOptions& options) {
  if (options.schema) {
    print(live::protocol_schema());
    return ExitCode::done;
  }
  if (options.answer_schema) {
    print(live::answer_schema());
    return ExitCode::done;
  }
  if (options.reference) {
    print(live::protocol_reference());
    return ExitCode::done;
  }
  if (options.scene.path.empty()) {
    throw Failure(ExitCode::usage, "SCENE is required\nSee sheave live --help");
  }
  if (options.scene.path == "-") {
    throw Failure(ExitCode::usage, "standard input is for requests; the scene must be a file");
  }
  check_paths({{"the scene", options.scene.path},
               {"--load-state", options.scene.load_state},
               {"standard input", "-"}},
              {{"--log", options.log}}, true);
  const Scene scene = load(options.scene);
  for (const Warning& warning : magnitude_warnings(scene)) print_warning(warning.message);
  Simulation simulation = make_simulation(scene);
  catch_interrupts();
  LiveServer server(options, scene, std::move(simulation));
  return server.serve();
}

}  // namespace

Action declare_live(CLI::App& app) {
  auto options = std::make_shared<LiveOptions>();
  add_scene_options(app, options->scene);
  app.get_option("scene")->required(false)->description("Scene file (JSON)");
  app.add_option("--realtime", options->realtime,
                 "step with the clock, or FACTOR simulated seconds per second of the clock")
      ->expected(0, 1)
      ->default_str("1")
      ->check(number_between(1e-6, 1e6))
      ->option_text("[FACTOR]");
  app.add_option("--log", options->log,
                 "write the requests and their steps to a file, which another session can replay")
      ->option_text("FILE");
  app.add_flag("--schema", options->schema,
               "print the JSON Schema (draft-07) of requests, and nothing else");
  app.add_flag("--answer-schema", options->answer_schema,
               "print the JSON Schema (draft-07) of answers and events, and nothing else");
  app.add_flag("--reference", options->reference,
               "print the reference of requests (Markdown), and nothing else");
  app.footer(R"(Examples:
  sheave live scenes/machines/crane.json
  sheave live crane.json --realtime 0.5 --log session.jsonl
  sheave live crane.json < session.jsonl

Requests come in on standard input, one JSON object per line, e.g.
  {"type":"set","controls":[{"type":"speed","body":"hoist winch","value":1.2}]}
  {"type":"step","count":10}
  {"type":"observe","quantities":["hoist cable.2.tension"]}
and each is answered by one line on standard output. docs/reference/live.md lists all of them.

Exit codes: 0 at the end of input or by the request "quit", 2 wrong usage, 65 bad scene, 66 no such
file, 70 internal error, 74 input or output failed, for example because nobody reads the
answers, 130 interrupted. A wrong request gets an error as its answer, and the session goes on.)");
  return [options] { return run_live(*options); };
}

}  // namespace sheave::command
