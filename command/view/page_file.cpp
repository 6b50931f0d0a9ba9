// Only in builds with the renderer.
#if SHEAVE_HAS_RENDER

#include "command/view/page_file.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <string_view>
#include <system_error>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "command/failure.h"
#include "command/input/file.h"
#include "command/terminal.h"
#include "render/child_process.h"

namespace sheave::command {
namespace {

constexpr std::size_t longest_page = 64U << 20U;

std::filesystem::path command_folder() {
  std::error_code code;
  return std::filesystem::read_symlink("/proc/self/exe", code).parent_path();
}

/// Reads the page of this name; if it is missing, the Failure contains `remedy`.
std::string read_page_file(const std::string& name, const std::string& remedy) {
  const std::filesystem::path folder = command_folder();
  std::error_code code;
  // The locations in a build tree and in an installation.
  for (const char* place : {"../web", "../share/sheave"}) {
    const std::filesystem::path path = (folder / place / name).lexically_normal();
    if (std::filesystem::exists(path, code)) return read_input(path.string(), longest_page);
  }
  throw Failure(ExitCode::no_input,
                (folder / "../web" / name).lexically_normal().string() + remedy);
}

/// FNV-1a, 32 bits: each byte is taken up one to one, so a text of which one byte is another has
/// another one. web/src/recording.ts checks it.
std::string checksum_of(std::string_view text) {
  constexpr std::uint32_t prime = 0x01000193U;
  std::uint32_t value = 0x811c9dc5U;
  for (const char c : text) value = (value ^ static_cast<unsigned char>(c)) * prime;
  return fmt::format("{:08x}", value);
}

std::string replaced(const std::string& page, std::string_view mark, const std::string& content) {
  const std::size_t at = page.find(mark);
  if (at == std::string::npos) {
    throw Failure(ExitCode::internal,
                  "the page has no place for the recording; build the page again");
  }
  std::string filled;
  filled.reserve(page.size() + content.size());
  filled.append(page, 0, at);
  filled += content;
  filled.append(page, at + mark.size());
  return filled;
}

}  // namespace

std::string read_page() {
  return read_page_file(
      "view.html",
      ": the page is missing\n"
      "CMake puts it there from web/page/view.html of the sources; configure the build again");
}

std::string read_live_page() {
  return read_page_file("live.html",
                        ": the page with the engine inside is missing\n"
                        "to build it: install emscripten and npm, then tools/playground "
                        "--build-only");
}

std::string filled_page(const std::string& page, const std::string& recording) {
  return replaced(
      page, "<!--RECORDING-->",
      fmt::format(R"(<script type="text/plain" id="recording" data-checksum="{}">{}</script>)",
                  checksum_of(recording), recording));
}

std::string filled_live_page(const std::string& page, const std::string& scene) {
  // A JSON string without "<" cannot end the script element that holds it.
  std::string text =
      nlohmann::json(scene).dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
  for (std::size_t at = text.find('<'); at != std::string::npos; at = text.find('<', at)) {
    text.replace(at, 1, "\\u003c");
  }
  return replaced(page, "<!--SCENE-->",
                  "<script type=\"application/json\" id=\"scene\">" + text + "</script>");
}

void open_in_browser(const std::string& path) {
  // An absolute path begins with a slash, so xdg-open can take it neither for an option nor for the
  // address of another page.
  const std::string whole = std::filesystem::absolute(path).string();
  Result<render::ChildProcess> opener =
      render::ChildProcess::start({"xdg-open", whole}, {.leaves_programs = true});
  const Errors errors = opener ? opener->finish() : opener.errors();
  if (!errors.empty()) {
    print_warning("cannot open the browser: " + to_text(errors) + "\nplease open " + path);
  }
}

}  // namespace sheave::command

#endif  // SHEAVE_HAS_RENDER
