#pragma once
// What a journal of `sheave trade --resume` may hold.

#include <string>
#include <string_view>

namespace sheave::command {

inline constexpr std::string_view trade_journal_format = "sheave-trade-journal/1";

/// Throws a Failure (65) with all faults, located, unless `text` is a journal in which every value
/// is one that TradeJournal could have written. `path` is what errors call it.
void check_trade_journal(std::string_view text, const std::string& path);

}  // namespace sheave::command
