#pragma once
// The journal of `sheave trade --resume FILE`: an interrupted run goes on where it was.
//
// The journal is one JSON object, except for its end, in lines with checksums
// (command/input/journal_lines.h): a key, and below the key the measured numbers. The key is a hash of
// the scene as it runs (with all overrides), of the settings of the measurement, of the processor, and
// of the program itself, byte by byte. So numbers of another scene, setting or build are never taken.
// Skipped settings are not kept, so more minutes measure more of them. Times are kept once all of them
// are measured: times of two runs would not be interleaved.
//
// The trajectory of the reference is not kept, for it may be large; where it is needed again, its
// finest run alone is repeated.

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "command/trade/table.h"

namespace sheave::command {

/// The hash, in hexadecimal.
[[nodiscard]] std::string trade_key(const Scene& scene, const TradeOptions& options);

class TradeJournal {
 public:
  /// `path` empty: nothing is kept. Reads the file if there is one; a Failure (65) if it is
  /// anything but a journal. Says so if it is one of something else, and begins anew.
  TradeJournal(std::string path, const std::string& key);
  ~TradeJournal();
  TradeJournal(const TradeJournal&) = delete;
  TradeJournal& operator=(const TradeJournal&) = delete;

  /// Keeps the reference, and the largest motion in the compared time.
  void keep(const measure::Reference& reference, double motion);
  /// The reference without its frames, and the motion.
  [[nodiscard]] std::optional<std::pair<measure::Reference, double>> reference() const;

  /// The error of a setting, or its fault.
  void keep(const TradeRow& row);
  /// Fills in the known values of row.setting. Returns whether there are any.
  [[nodiscard]] bool restore(TradeRow& row) const;

  /// The times of all rows that are measured.
  void keep_times(const std::vector<TradeRow>& rows);
  /// Whether all those are known, and then filled in.
  [[nodiscard]] bool restore_times(std::vector<TradeRow>& rows) const;

  void keep(const TradeLadder& ladder);
  /// The ladder of this setting.
  [[nodiscard]] std::optional<TradeLadder> ladder(const TradeSetting& setting) const;

  /// Writes the file if anything is new.
  void save();
  /// The same, if the last time was more than a second ago.
  void save_sometimes();

 private:
  std::string path_;
  std::unique_ptr<nlohmann::json> data_;
  bool changed_ = false;
  double saved_at_ = 0.0;
};

}  // namespace sheave::command
