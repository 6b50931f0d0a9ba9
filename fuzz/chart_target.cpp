#include <algorithm>
#include <string>
#include <vector>

#include "command/text/one_line.h"
#include "fuzz/chart_texts.h"
#include "fuzz/target.h"

namespace sheave::fuzz {
namespace {

/// Texts whose lengths the bytes determine. Each contains a mark by which it is recognised.
std::vector<std::string> texts_of(Bytes bytes, const std::string& mark) {
  std::vector<std::string> texts;
  while (!bytes.empty()) {
    const std::size_t length = std::min<std::size_t>(bytes.front(), bytes.size() - 1);
    bytes = bytes.subspan(1);
    texts.push_back(
        mark + std::string(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length)));
    bytes = bytes.subspan(length);
  }
  return texts;
}

}  // namespace

void try_chart(Bytes bytes) {
  const std::string mark = "PWN";
  const std::vector<std::string> texts = texts_of(bytes, mark);
  for (const command::GnuplotScript& chart : charts_with(texts, command::ChartFormat::svg)) {
    require_harmless(chart.text(), mark);
  }
  for (const std::string& text : texts) {
    const std::string page = command::markdown_text(text);
    require(page.find_first_of("<>\n\r") == std::string::npos, "a page has markup from outside");
  }
}

}  // namespace sheave::fuzz
