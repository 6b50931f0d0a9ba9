#include <algorithm>
#include <string>

#include <sys/mman.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "command/bench/table.h"
#include "command/failure.h"
#include "command/input/journal_lines.h"
#include "command/sweep/journal.h"
#include "command/trade/journal.h"
#include "command/trade/journal_check.h"
#include "fuzz/target.h"

namespace sheave::fuzz {
namespace {

/// A file in memory with these bytes.
class MemoryFile {
 public:
  explicit MemoryFile(const std::string& text) : file_(memfd_create("fuzzed", 0)) {
    require(
        file_ >= 0 && write(file_, text.data(), text.size()) == static_cast<ssize_t>(text.size()),
        "no file in memory");
  }
  ~MemoryFile() { close(file_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  [[nodiscard]] std::string path() const { return "/proc/self/fd/" + std::to_string(file_); }

 private:
  int file_;
};

/// Whether `read` accepts the file; a refusal must concern its contents.
template <class Read>
bool is_taken(const Read& read) {
  try {
    read();
    return true;
  } catch (const command::Failure& failure) {
    require(failure.code() == command::ExitCode::bad_scene, "refused with another code than 65");
    require(*failure.what() != '\0', "refused without a message");
    return false;
  }
}

/// Uses an accepted journal in every way that the program does.
void use(const std::string& text) {
  const nlohmann::json data =
      nlohmann::json::parse(command::checked_trade_journal(text, "journal"), nullptr, false, true);
  const MemoryFile file(text);
  command::TradeJournal journal(file.path(), data.at("key").get<std::string>());
  static_cast<void>(journal.reference());
  std::vector<command::TradeRow> rows(2);
  for (command::TradeRow& row : rows) static_cast<void>(journal.restore(row));
  static_cast<void>(journal.restore_times(rows));
  static_cast<void>(journal.ladder(rows.front().setting));
}

/// The lines with the checksums that they must have.
std::string with_checksums(std::string_view text) {
  json::ChecksumChain chain;
  std::string marked;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    marked += command::marked_line(chain, text.substr(begin, end - begin));
    begin = end + 1;
  }
  return marked;
}

void try_lines(const std::string& text) {
  if (is_taken([&] { static_cast<void>(command::checked_trade_journal(text, "journal")); })) {
    use(text);
  }
  const MemoryFile file(text);
  is_taken([&] { static_cast<void>(command::read_sweep_journal(file.path())); });
}

}  // namespace

void try_journal(Bytes bytes) {
  const std::string text(bytes.begin(), bytes.end());
  try_lines(text);
  // With right checksums the content of the lines is read.
  try_lines(with_checksums(text));
  const MemoryFile file(text);
  is_taken([&] { static_cast<void>(command::compare_with_baseline({}, file.path(), 1.1)); });
}

}  // namespace sheave::fuzz
