#include "command/input/journal_lines.h"

#include <algorithm>

#include <fmt/format.h>

#include "command/failure.h"
#include "command/terminal.h"

namespace sheave::command {
namespace {

constexpr std::string_view separator = " // ";

/// A line taken apart at its mark.
struct MarkedLine {
  std::string_view content;
  std::string_view mark;
};

/// False if the line does not end as marked_line() ends it.
bool take_apart(std::string_view line, MarkedLine& parts) {
  const std::size_t at = line.rfind(separator);
  if (at == std::string_view::npos) return false;
  parts = {line.substr(0, at), line.substr(at + separator.size())};
  json::ChecksumMark mark;
  return json::is_checksum_mark(parts.mark, mark);
}

/// Whether any line has a mark: damage leaves the marks of all lines but one.
bool has_marks(std::string_view text) {
  MarkedLine parts;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    if (take_apart(text.substr(0, end), parts)) return true;
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return false;
}

[[noreturn]] void refuse(const std::string& path, std::int64_t line, const std::string& what) {
  const std::string remedy =
      line == 1 ? std::string("restore the file from a copy, or remove it and start again")
                : fmt::format(
                      "restore the file from a copy, or keep the lines before this one, which are "
                      "intact (head -n {}), and resume from them",
                      line - 1);
  throw Failure(ExitCode::bad_scene, fmt::format("{}:{}:1: {}; {}", path, line, what, remedy));
}

std::string fault_of(std::string_view line, const json::ChecksumChain& before,
                     json::ChecksumChain& after, std::string_view& content) {
  MarkedLine parts;
  if (!take_apart(line, parts)) {
    return fmt::format(
        "the line has been changed: it must end with its number and its checksum, as in \"{}{} "
        "0123456789abcdef\"",
        separator, before.lines() + 1);
  }
  after = before;
  content = parts.content;
  return json::checksum_fault(parts.mark, after.add(parts.content));
}

}  // namespace

std::string marked_line(json::ChecksumChain& chain, std::string_view line) {
  return fmt::format("{}{}{}\n", line, separator, chain.add(line));
}

JournalLines read_journal_lines(std::string_view text, const std::string& path) {
  JournalLines lines;
  lines.marked = has_marks(text);
  const std::size_t last = text.rfind('\n');
  lines.bytes = last == std::string_view::npos ? 0 : last + 1;
  lines.cut = lines.bytes < text.size();
  if (!lines.marked) {
    lines.text = text.substr(0, lines.bytes);
    return lines;
  }
  lines.text.reserve(lines.bytes);
  std::string_view rest = text.substr(0, lines.bytes);
  json::ChecksumChain after;
  std::string_view content;
  while (!rest.empty()) {
    const std::size_t end = rest.find('\n');
    const std::string fault = fault_of(rest.substr(0, end), lines.chain, after, content);
    if (!fault.empty()) refuse(path, lines.chain.lines() + 1, fault);
    lines.chain = after;
    lines.text.append(content) += '\n';
    rest.remove_prefix(end + 1);
  }
  // A line break that is another byte now: nothing that was cut off has a byte behind its mark.
  const std::string_view tail = text.substr(lines.bytes);
  if (!tail.empty() &&
      fault_of(tail.substr(0, tail.size() - 1), lines.chain, after, content).empty()) {
    refuse(path, lines.chain.lines() + 1,
           "the line has been changed: it must end with a line break");
  }
  return lines;
}

std::string closed_journal(const JournalLines& lines, std::string_view brackets) {
  if (lines.text.empty()) return {};
  std::string text = lines.text.substr(0, lines.text.size() - 1);
  if (text.ends_with(',')) text.pop_back();
  return text.append(brackets);
}

void check_journal(const JournalLines& lines, std::string_view json, const std::string& path,
                   const JournalFormats& formats, const JsonRule& rule,
                   const json::Limits& limits) {
  const bool old = !lines.marked && json.find(formats.unmarked) != std::string_view::npos;
  check_json(json, path, old ? formats.unmarked : formats.marked, rule, limits);
  if (!lines.marked && !old) {
    refuse(path, 1,
           fmt::format("the line has been changed: of the version \"{}\" each line ends with its "
                       "number and its checksum",
                       formats.marked));
  }
  if (old) {
    print_warning(
        fmt::format("{}: the file has the version \"{}\" without checksums, so changes in it "
                    "cannot be detected",
                    path, formats.unmarked));
  }
  if (lines.cut) {
    print_warning(path + ": the last line is incomplete, as after a crash, and is ignored");
  }
}

}  // namespace sheave::command
