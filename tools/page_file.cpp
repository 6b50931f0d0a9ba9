// Only in builds with the renderer.
#if SHEAVE_HAS_RENDER

#include "tools/page_file.h"

#include <array>
#include <filesystem>
#include <string_view>
#include <system_error>

#include "render/child_process.h"
#include "tools/failure.h"
#include "tools/input_file.h"
#include "tools/terminal.h"

namespace sheave::tools {
namespace {

constexpr std::size_t longest_page = 64U << 20U;

std::filesystem::path command_folder() {
  std::error_code code;
  return std::filesystem::read_symlink("/proc/self/exe", code).parent_path();
}

}  // namespace

std::string read_page() {
  const std::filesystem::path folder = command_folder();
  std::error_code code;
  // In a build tree; installed.
  for (const char* place : {"../web/view.html", "../share/sheave/view.html"}) {
    const std::filesystem::path path = (folder / place).lexically_normal();
    if (std::filesystem::exists(path, code)) return read_input(path.string(), longest_page);
  }
  throw Failure(ExitCode::no_input,
                (folder / "../web/view.html").lexically_normal().string() +
                    ": the page is missing: this build was made without npm, or npm could not "
                    "load what web/package-lock.json names\n"
                    "to build it: install nodejs and npm, then build the CMake target web");
}

std::string filled_page(const std::string& page, const std::string& recording) {
  constexpr std::string_view mark = "<!--RECORDING-->";
  const std::size_t at = page.find(mark);
  if (at == std::string::npos) {
    throw Failure(ExitCode::internal, "view.html has no place for a recording; build it anew");
  }
  std::string filled;
  filled.reserve(page.size() + recording.size() + 100);
  filled.append(page, 0, at);
  filled += "<script type=\"text/plain\" id=\"recording\">";
  filled += recording;
  filled += "</script>";
  filled.append(page, at + mark.size());
  return filled;
}

void open_in_browser(const std::string& path) {
  Result<render::ChildProcess> opener = render::ChildProcess::start({"xdg-open", path});
  const Errors errors = opener ? opener->finish() : opener.errors();
  if (!errors.empty()) {
    print_warning("cannot open the browser: " + to_text(errors) + "\nplease open " + path);
  }
}

}  // namespace sheave::tools

#endif  // SHEAVE_HAS_RENDER
