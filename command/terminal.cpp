#include "command/terminal.h"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <new>
#include <string>

#include <unistd.h>

#include <fmt/format.h>

#include "command/failure.h"
#include "command/text/one_line.h"
#include "scenes/json/text.h"

namespace sheave::command {
namespace {

/// False if the text could not be written; errno says why.
bool write_all(int descriptor, std::string_view text) {
  while (!text.empty()) {
    const ssize_t count = ::write(descriptor, text.data(), text.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return false;
    text.remove_prefix(static_cast<std::size_t>(count));
  }
  return true;
}

void say_allocating(std::string_view kind, const char* color, std::string_view text) {
  std::string message = "sheave: ";
  if (!kind.empty()) {
    const bool colored = stderr_has_color();
    message += (colored ? color : "") + std::string(kind) + (colored ? "\033[0m" : "") + ": ";
  }
  message += printable(text);
  if (!message.ends_with('\n')) message += '\n';
  // If standard error is closed, no channel for a message remains.
  static_cast<void>(write_all(STDERR_FILENO, message));
}

/// Writes a message even without memory to format it.
void say(std::string_view kind, const char* color, std::string_view text) {
  try {
    say_allocating(kind, color, text);
  } catch (const std::bad_alloc&) {
    for (const std::string_view part :
         {std::string_view("sheave: "), kind, std::string_view(": ")}) {
      static_cast<void>(write_all(STDERR_FILENO, part));
    }
    // Writes single characters, because a printable copy of the text would need memory.
    for (const char c : text) {
      const bool plain = c == '\n' || (c >= ' ' && c < 0x7f);
      static_cast<void>(write_all(STDERR_FILENO, plain ? std::string_view(&c, 1) : "?"));
    }
    static_cast<void>(write_all(STDERR_FILENO, "\n"));
  }
}

}  // namespace

std::string printable(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const std::size_t length = json::character_length(text);
    const std::string_view character = text.substr(0, length);
    const bool blank = character == "\n" || character == "\t";
    if (length == 0 || (!blank && cannot_be_shown(character))) {
      for (std::size_t i = 0; i < std::max<std::size_t>(length, 1); ++i) {
        result += fmt::format("\\x{:02x}", static_cast<unsigned char>(text[i]));
      }
    } else {
      result += character;
    }
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return result;
}

std::string printable_line(std::string_view text) {
  std::string result;
  for (const char c : printable(text)) {
    result += c == '\n' ? std::string("\\x0a") : std::string(1, c);
  }
  return result;
}

void print(std::string_view text) {
  if (!write_all(STDOUT_FILENO, text)) {
    throw Failure(ExitCode::io, std::string("standard output: ") + std::strerror(errno));
  }
}

void print_error(std::string_view text) { say("error", "\033[1;31m", text); }
void print_warning(std::string_view text) { say("warning", "\033[1;33m", text); }
void print_note(std::string_view text) { say("", "", text); }

bool stderr_is_terminal() { return ::isatty(STDERR_FILENO) == 1; }

bool stderr_has_color() {
  const char* no_color = std::getenv("NO_COLOR");
  const char* terminal = std::getenv("TERM");
  const bool dumb = terminal == nullptr || std::strcmp(terminal, "dumb") == 0;
  return stderr_is_terminal() && !dumb && (no_color == nullptr || *no_color == '\0');
}

void turn_signals_into_errors() {
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

}  // namespace sheave::command
