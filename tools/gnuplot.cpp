#include "tools/gnuplot.h"

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <vector>

#include <fmt/format.h>

#include "tools/failure.h"

#if SHEAVE_HAS_RENDER
#include "render/child_process.h"
#include "render/output_file.h"
#endif

namespace sheave::tools {
namespace {

/// The last `count` bytes of a file, or fewer; none if it cannot be read.
[[maybe_unused]] std::string tail_of_file(const std::string& path, std::size_t count) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  const auto size = static_cast<std::streamoff>(file.tellg());
  if (size < 0) return {};
  file.seekg(std::max<std::streamoff>(0, size - static_cast<std::streamoff>(count)));
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

}  // namespace

void check_chart_name(const std::string& path) {
  if (path.ends_with(".png") || path.ends_with(".svg") || path.ends_with(".pdf")) return;
  throw Failure(ExitCode::usage, path + ": the name of a chart must end in .png, .svg or .pdf");
}

std::string gnuplot_quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("''") : std::string(1, c);
  return result + "'";
}

std::string gnuplot_terminal(const std::string& output, int height) {
  std::string kind = fmt::format("pngcairo size 1000,{} font 'DejaVu Sans,11'", height);
  if (output.ends_with(".svg")) {
    kind = fmt::format("svg size 1000,{} font 'DejaVu Sans,13' background 'white'", height);
  } else if (output.ends_with(".pdf")) {
    constexpr double pixels_per_inch = 100.0;
    kind = fmt::format("pdfcairo size 10in,{:g}in font 'DejaVu Sans,11'", height / pixels_per_inch);
  }
  return "set terminal " + kind + "\nset output " + gnuplot_quoted(output) + "\n";
}

#if SHEAVE_HAS_RENDER

namespace {

/// Whether a .png, .svg or .pdf file ends as such a file does: gnuplot ends with success on a full disk,
/// too.
bool is_whole_picture(const std::string& path) {
  constexpr std::size_t longest = 16;
  const std::string text = tail_of_file(path, longest);
  const char* const mark =
      path.ends_with(".png") ? "IEND" : (path.ends_with(".svg") ? "</svg>" : "%%EOF");
  return text.find(mark) != std::string::npos;
}

}  // namespace

void draw_with_gnuplot(const std::string& path,
                       const std::function<std::string(const std::string& output)>& script_for) {
  check_chart_name(path);
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
  const std::string script = script_for(file->temporary_path());
  const std::vector<std::uint8_t> bytes(script.begin(), script.end());
  Errors errors = gnuplot->write(bytes);
  if (errors.empty()) errors = gnuplot->finish();
  if (errors.empty() && !is_whole_picture(file->temporary_path())) {
    const std::string said = gnuplot->last_words();
    errors.push_back({"", "'gnuplot' has left no picture" + (said.empty() ? "" : ": " + said)});
  }
  if (!errors.empty()) throw Failure(ExitCode::io, path + ": " + to_text(errors));
  errors = file->commit();
  if (!errors.empty()) throw Failure(ExitCode::io, to_text(errors));
}

#else

void draw_with_gnuplot(const std::string& path,
                       const std::function<std::string(const std::string& output)>&) {
  throw Failure(ExitCode::io, path + ": this build cannot start gnuplot (SHEAVE_RENDER is off)");
}

#endif

}  // namespace sheave::tools
