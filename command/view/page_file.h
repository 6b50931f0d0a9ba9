#pragma once
// The page that `sheave view` fills: built from web/ by npm, beside the command or installed with
// it.

#include <string>

namespace sheave::command {

/// The text of the page. A Failure that says how to get it if it is not there.
[[nodiscard]] std::string read_page();

/// The page with `recording` (base64) in it. A Failure if that is no page of ours.
[[nodiscard]] std::string filled_page(const std::string& page, const std::string& recording);

/// The page with the engine inside, and that with the text of a scene in it. Failures likewise.
[[nodiscard]] std::string read_live_page();
[[nodiscard]] std::string filled_live_page(const std::string& page, const std::string& scene);

/// Lets the user's browser open a file; a note if that does not work.
void open_in_browser(const std::string& path);

}  // namespace sheave::command
