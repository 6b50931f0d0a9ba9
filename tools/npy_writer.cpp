// NumPy's .npy format: magic, version, length of a header, the header (a Python dictionary, padded
// with blanks so that the data is aligned), the data. The number of rows is known only at the end,
// so the header keeps room for the largest and is written again then.

#include <bit>
#include <cstdint>
#include <cstring>

#include <fmt/format.h>

#include "tools/failure.h"
#include "tools/output_file.h"
#include "tools/table_writer.h"
#include "tools/terminal.h"

namespace sheave::tools {
namespace {

constexpr std::size_t alignment = 64;
constexpr std::size_t max_short_header = 65535;    // of version 1.0
constexpr std::size_t max_default_header = 10000;  // that numpy.load accepts without being told to

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
  for (const std::string& column : columns) text += fmt::format("('{}', '{}'), ", column, type);
  return text + "]";
}

std::string header(const std::string& descriptor, std::size_t rows) {
  // 20 places for the number of rows, so that every header of a table has the same length.
  std::string text = fmt::format("{{'descr': {}, 'fortran_order': False, 'shape': ({},), }}{:{}}",
                                 descriptor, rows, "", 20 - fmt::formatted_size("{}", rows));
  const std::size_t longest = text.size() + 1 + 12 + alignment;
  const bool short_length = longest <= max_short_header;
  const std::size_t before = short_length ? 10 : 12;
  const std::size_t padding = (alignment - (before + text.size() + 1) % alignment) % alignment;
  text += std::string(padding, ' ') + "\n";
  std::string magic = "\x93NUMPY";
  magic += short_length ? std::string("\x01\x00", 2) : std::string("\x02\x00", 2);
  return magic + little_endian(text.size(), short_length ? 2 : 4) + text;
}

class NpyWriter final : public TableWriter {
 public:
  NpyWriter(const std::string& path, const std::vector<std::string>& columns)
      : file_(path), descriptor_(description(columns)) {
    if (!file_.is_seekable()) {
      throw Failure(ExitCode::usage, path + ": a .npy file cannot be written to a pipe or device");
    }
    const std::string text = header(descriptor_, 0);
    if (text.size() > max_default_header) {
      print_note(
          fmt::format("{0}: for its {1} columns read it with "
                      "numpy.load(path, max_header_size={2})",
                      path, columns.size(), text.size()));
    }
    file_.write(text);
  }

  void write_row(std::span<const double> values) override {
    bytes_.resize(values.size_bytes());
    std::memcpy(bytes_.data(), values.data(), values.size_bytes());
    file_.write(bytes_);
    ++rows_;
  }

  void finish() override {
    file_.overwrite(0, header(descriptor_, rows_));
    file_.commit();
  }

 private:
  OutputFile file_;
  std::string descriptor_;
  std::string bytes_;
  std::size_t rows_ = 0;
};

}  // namespace

std::unique_ptr<TableWriter> open_npy(const std::string& path,
                                      const std::vector<std::string>& columns) {
  return std::make_unique<NpyWriter>(path, columns);
}

std::unique_ptr<TableWriter> open_table(const std::string& path,
                                        const std::vector<std::string>& columns) {
  if (path == "-" || path.ends_with(".csv")) return open_csv(path, columns);
  if (path.ends_with(".npy")) return open_npy(path, columns);
  throw Failure(ExitCode::usage, path + ": the name of a table must end in .csv or .npy");
}

}  // namespace sheave::tools
