#pragma once
// Journals as texts that tests change.

#include <algorithm>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "command/input/journal_lines.h"

namespace sheave::test {

/// The lines with the checksums that they must have, so that what they say is looked at.
inline std::string with_checksums(std::string_view text) {
  sheave::json::ChecksumChain chain;
  std::string marked;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size() - 1);
    marked += command::marked_line(chain, text.substr(0, end));
    text.remove_prefix(end + 1);
  }
  return marked;
}

inline std::string without_checksums(std::string_view text) {
  return command::read_journal_lines(text, "journal").text;
}

/// A journal of a trade as JSON; discarded if it is none.
inline nlohmann::json trade_journal_json(std::string_view text) {
  return nlohmann::json::parse(
      command::closed_journal(command::read_journal_lines(text, "journal"), "}}"), nullptr, false);
}

/// And the other way round.
inline std::string trade_journal_text(nlohmann::json journal) {
  const nlohmann::json rows = journal.at("rows");
  journal.erase("rows");
  std::string text = journal.dump();
  text.back() = ',';
  text += "\"rows\":{\n";
  for (const auto& [name, row] : rows.items()) {
    text += nlohmann::json(name).dump() + ":" + row.dump() + ",\n";
  }
  return with_checksums(text);
}

}  // namespace sheave::test
