#pragma once
// Checks the content of a journal of `sheave trade --resume`.

#include <string>
#include <string_view>

#include "command/input/journal_lines.h"

namespace sheave::command {

inline constexpr JournalFormats trade_journal_formats{"sheave-trade-journal/2",
                                                      "sheave-trade-journal/1"};

/// The journal in the text of a file, as JSON. Throws a Failure (65) with all faults, located,
/// unless its lines are as they were written and every value is one that TradeJournal could have
/// written. Warns of a journal without checksums. `path` is the name of the file in errors.
[[nodiscard]] std::string checked_trade_journal(std::string_view text, const std::string& path);

}  // namespace sheave::command
