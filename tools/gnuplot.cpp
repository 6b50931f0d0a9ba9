#include "tools/gnuplot.h"

#include <cstdint>
#include <vector>

#include <fmt/format.h>

#include "tools/failure.h"

#if SHEAVE_HAS_RENDER
#include "render/child_process.h"
#include "render/output_file.h"
#endif

namespace sheave::tools {

std::string chart_quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("''") : std::string(1, c);
  return result + "'";
}

std::string chart_terminal(const std::string& output, int width, int height) {
  const std::string size = fmt::format("size {},{}", width, height);
  return output.ends_with(".svg")
             ? "set terminal svg " + size + " font 'DejaVu Sans,13' background 'white'\n"
             : "set terminal pngcairo " + size + " font 'DejaVu Sans,11'\n";
}

#if SHEAVE_HAS_RENDER

void draw_with_gnuplot(const std::string& path,
                       const std::function<std::string(const std::string& output)>& script) {
  Result<render::OutputFile> file = render::OutputFile::create(path);
  if (!file) throw Failure(ExitCode::io, to_text(file.errors()));
  // Only the name was wanted: gnuplot opens the file itself. It keeps the extension.
  if (const Errors errors = file->close(); !errors.empty())
    throw Failure(ExitCode::io, to_text(errors));
  Result<render::ChildProcess> gnuplot = render::ChildProcess::start({"gnuplot", "-"});
  if (!gnuplot) {
    throw Failure(ExitCode::io, to_text(gnuplot.errors()) +
                                    "; charts need gnuplot (Debian: apt install gnuplot-nox)");
  }
  const std::string text = script(file->temporary_path());
  const std::vector<std::uint8_t> bytes(text.begin(), text.end());
  Errors errors = gnuplot->write(bytes);
  if (const Errors end = gnuplot->finish(); errors.empty()) errors = end;
  if (errors.empty()) errors = file->commit();
  if (!errors.empty()) throw Failure(ExitCode::io, path + ": " + to_text(errors));
}

#else

void draw_with_gnuplot(const std::string& path,
                       const std::function<std::string(const std::string&)>&) {
  throw Failure(ExitCode::io, path + ": this build cannot start gnuplot (SHEAVE_RENDER is off)");
}

#endif

}  // namespace sheave::tools
