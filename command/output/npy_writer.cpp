// NumPy's .npy format: magic, version, length of the header, the header (a Python dictionary,
// padded with blanks so that the data is aligned), the data. The header has room for any number of
// rows and always holds the number of rows in the file, even during writing.

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstdint>
#include <cstring>

#include <fmt/format.h>

#include "command/failure.h"
#include "command/output/file.h"
#include "command/output/table_writer.h"
#include "command/terminal.h"

namespace sheave::command {
namespace {

constexpr std::size_t alignment = 64;
constexpr std::size_t max_short_header = 65535;    // of version 1.0
constexpr std::size_t max_default_header = 10000;  // limit of numpy.load without max_header_size

/// Low byte first.
std::string little_endian(std::size_t value, int bytes) {
  std::string text;
  for (int i = 0; i < bytes; ++i) text += static_cast<char>(value >> (8 * i) & 0xffU);
  return text;
}

/// The type of the array's elements, in Python.
std::string description(const std::vector<std::string>& columns) {
  const char* type = std::endian::native == std::endian::little ? "<f8" : ">f8";
  std::string text = "[";
  for (const std::string& column : columns) {
    // Expressions may have single quotes, and no double ones.
    const char quote = column.find('\'') == std::string::npos ? '\'' : '"';
    text += fmt::format("({0}{1}{0}, '{2}'), ", quote, column, type);
  }
  return text + "]";
}

/// Length of the text behind the opening bracket of the shape. During writing the number stands at
/// its right end, so that only digits change; in the completed table the text has NumPy's own form.
constexpr std::size_t rows_size = 25;
using RowsText = std::array<char, rows_size>;
/// Does not allocate: the number must be written even after memory has run out.
RowsText rows_text(std::int64_t rows, bool complete) {
  constexpr std::string_view end = ",), }";
  RowsText text;
  text.fill(' ');
  std::array<char, rows_size> digits{};
  const char* const last = std::to_chars(digits.begin(), digits.end(), rows).ptr;
  const auto count = static_cast<std::size_t>(last - digits.data());
  char* const at = text.data() + (complete ? 0 : rows_size - end.size() - count);
  std::copy_n(digits.begin(), count, at);
  std::copy_n(end.begin(), end.size(), at + count);
  return text;
}

struct Header {
  std::string text;
  std::size_t rows_at = 0;  // offset of rows_text()
};

Header header(const std::string& descriptor) {
  std::string text = fmt::format("{{'descr': {}, 'fortran_order': False, ", descriptor);
  const std::string shape = "'shape': (";
  const std::size_t longest = text.size() + shape.size() + rows_size + 1 + 12 + 2 * alignment;
  const bool short_length = longest <= max_short_header;
  const std::size_t before = short_length ? 10 : 12;
  // The text lies within one page of the file: if the process is killed, a write may be cut between
  // two pages.
  constexpr std::size_t page = 4096;
  const std::size_t place = before + text.size() + shape.size();
  if (place / page != (place + rows_size - 1) / page) text += std::string(rows_size, ' ');
  text += shape;
  const std::size_t rows_at = before + text.size();
  const RowsText no_rows = rows_text(0, false);
  text.append(no_rows.data(), no_rows.size());
  const std::size_t padding = (alignment - (before + text.size() + 1) % alignment) % alignment;
  text += std::string(padding, ' ') + "\n";
  std::string magic = "\x93NUMPY";
  magic += short_length ? std::string("\x01\x00", 2) : std::string("\x02\x00", 2);
  return {magic + little_endian(text.size(), short_length ? 2 : 4) + text, rows_at};
}

class NpyWriter final : public TableWriter {
 public:
  NpyWriter(const std::string& path, const std::vector<std::string>& columns) : file_(path) {
    if (!file_.is_seekable()) {
      throw Failure(ExitCode::usage, path + ": a .npy file cannot be written to a pipe or device");
    }
    const Header start = header(description(columns));
    rows_at_ = start.rows_at;
    if (start.text.size() > max_default_header) {
      print_note(
          fmt::format("{0}: for its {1} columns read it with "
                      "numpy.load(path, max_header_size={2})",
                      path, columns.size(), start.text.size()));
    }
    header_size_ = start.text.size();
    file_.write(start.text);
    file_.flush();
  }

  void write_row(std::span<const double> values) override {
    bytes_.resize(values.size_bytes());
    std::memcpy(bytes_.data(), values.data(), values.size_bytes());
    file_.write(bytes_);
    // Writes the rows before their number, so that the number never exceeds the rows in the file.
    if (written() != told_) tell_rows(false);
  }

  void finish() override {
    file_.flush();
    tell_rows(true);
    file_.commit();
  }

  Salvage salvage() override {
    try {
      tell_rows(true);
    } catch (const Failure&) {
      // The file keeps the rows that the last number counts.
      file_.keep_at_most(header_size_ + static_cast<std::size_t>(told_) * bytes_.size());
    }
    return salvage_rows(file_, told_);
  }

 private:
  /// The first record is the header.
  [[nodiscard]] std::int64_t written() const { return file_.records() - 1; }
  void tell_rows(bool complete) {
    const std::int64_t rows = written();
    const RowsText text = rows_text(rows, complete);
    file_.overwrite(rows_at_, {text.data(), text.size()});
    told_ = rows;
  }

  OutputFile file_;
  std::string bytes_;
  std::size_t header_size_ = 0;
  std::size_t rows_at_ = 0;
  std::int64_t told_ = 0;
};

}  // namespace

std::unique_ptr<TableWriter> open_npy(const std::string& path,
                                      const std::vector<std::string>& columns) {
  return std::make_unique<NpyWriter>(path, columns);
}

Salvage salvage_rows(OutputFile& file, std::int64_t rows) {
  if (file.path() == "-")
    return {rows, fmt::format("{} rows were written to it", std::max<std::int64_t>(rows, 0))};
  // The fault has already named the temporary file.
  if (file.is_elsewhere()) return {};
  if (rows <= 0) return {0, "no row of it is kept"};
  file.salvage();
  return {rows, fmt::format("its first {} rows are kept", rows)};
}

std::unique_ptr<TableWriter> open_table(const std::string& path,
                                        const std::vector<std::string>& columns) {
  if (path == "-" || path.ends_with(".csv")) return open_csv(path, columns);
  if (path.ends_with(".npy")) return open_npy(path, columns);
  throw Failure(ExitCode::usage, path + ": the name of a table must end in .csv or .npy");
}

}  // namespace sheave::command
