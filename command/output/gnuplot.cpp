#include "command/output/gnuplot.h"

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <vector>

#include "command/failure.h"
#include "command/interrupt.h"

#if SHEAVE_HAS_RENDER
#include "render/child_process.h"
#include "render/output_file.h"
#endif

namespace sheave::command {

#if SHEAVE_HAS_RENDER

namespace {

/// Whether a picture has the end that its format requires: gnuplot may report success after writing
/// half a picture.
bool is_whole_picture(const std::vector<std::uint8_t>& bytes, ChartFormat format) {
  constexpr std::ptrdiff_t longest = 16;
  const auto size = static_cast<std::ptrdiff_t>(bytes.size());
  const std::string tail(bytes.end() - std::min(size, longest), bytes.end());
  const std::string_view mark =
      format == ChartFormat::png ? "IEND" : (format == ChartFormat::svg ? "</svg>" : "%%EOF");
  return tail.find(mark) != std::string::npos;
}

[[noreturn]] void not_drawn(const std::string& path, const std::string& why) {
  throw Failure(ExitCode::io, path + ": " + why);
}

/// Runs a script and returns its picture.
std::vector<std::uint8_t> drawn(const std::string& path, const GnuplotScript& script) {
  // A first signal may have ended the run to be drawn; its chart is still wanted.
  const bool already = interrupted();
  const auto unwanted = [already] { return already ? hurried() : interrupted(); };
  // -d: without gnuplotrc and ~/.gnuplot. GNUTERM and GNUPLOT_... select terminals, drivers, fonts
  // and folders of scripts; FIT_..., PAGER and SHELL select files and programs.
  Result<render::ChildProcess> gnuplot = render::ChildProcess::start(
      {"gnuplot", "-d", "-"},
      {.abandon = unwanted,
       .keeps_output = true,
       .hidden_variables = {"GNUPLOT", "GNUTERM", "GNUHELP", "FIT_", "PAGER=", "SHELL="},
       .if_missing = "charts need gnuplot (Debian: apt install gnuplot-nox)"});
  if (!gnuplot) throw Failure(ExitCode::io, to_text(gnuplot.errors()));
  const std::string text = script.text();
  Errors errors = gnuplot->write(std::vector<std::uint8_t>(text.begin(), text.end()));
  if (errors.empty()) errors = gnuplot->finish();
  if (unwanted()) throw Failure(ExitCode::interrupted, path + ": not drawn: interrupted");
  if (!errors.empty()) not_drawn(path, to_text(errors));
  std::vector<std::uint8_t> picture = gnuplot->output();
  if (!is_whole_picture(picture, script.format())) {
    const std::string said = gnuplot->last_words();
    not_drawn(path, "'gnuplot' has left no picture" + (said.empty() ? "" : ": " + said));
  }
  return picture;
}

}  // namespace

void draw_with_gnuplot(const std::string& path, const GnuplotScript& script) {
  // Without handlers a signal would end this process and leave a hanging gnuplot behind.
  catch_interrupts();
  Result<render::OutputFile> file = render::OutputFile::create(path);
  if (!file) throw Failure(ExitCode::io, to_text(file.errors()));
  // This process writes the file, because gnuplot does not report a full disk.
  Errors errors = file->write(drawn(path, script));
  if (errors.empty()) errors = file->commit();
  if (!errors.empty()) throw Failure(ExitCode::io, to_text(errors));
}

#else

void draw_with_gnuplot(const std::string& path, const GnuplotScript&) {
  throw Failure(ExitCode::io, path + ": this build cannot start gnuplot (SHEAVE_RENDER is off)");
}

#endif

}  // namespace sheave::command
