#include <array>
#include <charconv>
#include <cmath>

#include "command/output/file.h"
#include "command/output/table_writer.h"

namespace sheave::command {
namespace {

class CsvWriter final : public TableWriter {
 public:
  CsvWriter(const std::string& path, const std::vector<std::string>& columns) : file_(path) {
    // Names have no commas, double quotes or line breaks (scenes/format.h), and expressions of them
    // have commas.
    for (const std::string& column : columns) {
      if (!line_.empty()) line_ += ',';
      const bool quoted = column.find(',') != std::string::npos;
      line_ += quoted ? '"' + column + '"' : column;
    }
    end_line();
  }

  void write_row(std::span<const double> values) override {
    bool first = true;
    for (const double value : values) {
      if (!first) line_ += ',';
      first = false;
      if (!std::isnan(value)) append(value);
    }
    end_line();
  }

  void finish() override { file_.commit(); }

  // The first record is the line of column names.
  Salvage salvage() override { return salvage_rows(file_, file_.records() - 1); }

 private:
  void append(double value) {
    std::array<char, 32> text{};  // the longest double has 24 characters
    const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
    line_.append(text.data(), end);
  }
  void end_line() {
    line_ += '\n';
    file_.write(line_);
    line_.clear();
  }

  OutputFile file_;
  std::string line_;
};

}  // namespace

std::unique_ptr<TableWriter> open_csv(const std::string& path,
                                      const std::vector<std::string>& columns) {
  return std::make_unique<CsvWriter>(path, columns);
}

}  // namespace sheave::command
