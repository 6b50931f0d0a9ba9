#pragma once
// The page that `sheave view` fills: web/page/view.html of the sources. The page lies beside the command
// in the build tree, or is installed with it.

#include <string>

namespace sheave::command {

/// The text of the page. If the page is missing, a Failure says how to build it.
[[nodiscard]] std::string read_page();

/// The page with `recording` (base64) in it. A Failure if `page` is not a page of this program.
[[nodiscard]] std::string filled_page(const std::string& page, const std::string& recording);

/// The page with the engine inside, and that page with the text of a scene in it. Failures as
/// above.
[[nodiscard]] std::string read_live_page();
[[nodiscard]] std::string filled_live_page(const std::string& page, const std::string& scene);

/// Opens a file in the user's browser; prints a note if that fails.
void open_in_browser(const std::string& path);

}  // namespace sheave::command
