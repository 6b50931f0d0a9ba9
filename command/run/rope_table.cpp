// The history of ropes as a table: a line per section.

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <set>

#include <fmt/format.h>

#include "command/output/file.h"
#include "command/run/rope_files.h"

namespace sheave::command {
namespace {

constexpr double empty_cell = std::numeric_limits<double>::quiet_NaN();

/// A line of the table, cell by cell.
class RopeLine {
 public:
  explicit RopeLine(const std::string& first) : text_(first) {}
  void add(const std::string& name) { text_ += "," + name; }
  /// The shortest decimals that read back as the same double; nothing for NaN.
  void add(double value) {
    text_ += ',';
    if (std::isnan(value)) return;
    std::array<char, 32> digits{};
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
    text_.append(digits.data(), end);
  }
  [[nodiscard]] std::string text() const { return text_ + "\n"; }

 private:
  std::string text_;
};

/// The wheels that have bent a section of any cable, by their index in the list of links.
std::set<int> bending_links(const std::vector<measure::CableHistory>& cables) {
  std::set<int> links;
  for (const measure::CableHistory& cable : cables) {
    for (const measure::SectionHistory& section : cable.sections) {
      for (const measure::SectionBends& one : section.bends) links.insert(one.link);
    }
  }
  return links;
}

std::string head_line(const RopeOptions& options, const std::set<int>& links) {
  RopeLine line("cable");
  for (const char* name :
       {"section", "from [m]", "to [m]", "simple_bends", "reverse_bends", "least_D [m]",
        "least_D/d", "bend_tension [N]", "least_tension [N]", "mean_tension [N]",
        "most_tension [N]", "tension_range [N]", "cycles", "largest_cycle [N]"}) {
    line.add(name);
  }
  if (!options.life.empty()) {
    for (const char* name : {"simple_damage", "reverse_damage", "damage"}) line.add(name);
  }
  for (const int link : links) {
    for (const char* name : {"simple_bends", "reverse_bends", "D [m]", "D/d", "bend_tension [N]"}) {
      line.add(fmt::format("link{}.{}", link, name));
    }
  }
  return line.text();
}

/// Bends, diameters and tension of one wheel, or of all.
void add_bends(const measure::SectionBends& bends, const RopeOptions& options, RopeLine& line) {
  const bool bent = bends.bends > 0;
  line.add(bends.bends - bends.reverse);
  line.add(bends.reverse);
  line.add(bent ? bends.least_diameter : empty_cell);
  line.add(bent && options.diameter ? bends.least_diameter / *options.diameter : empty_cell);
  line.add(bent ? bends.most_tension : empty_cell);
}

std::string section_line(const measure::CableHistory& cable, std::size_t index,
                         const RopeOptions& options, const std::set<int>& links) {
  const measure::SectionHistory& section = cable.sections[index];
  const measure::SectionBends all = section.all_bends();
  RopeLine line(cable.cable);
  line.add(static_cast<double>(index));
  line.add(section.from);
  line.add(section.to);
  add_bends(all, options, line);
  line.add(section.least_tension);
  line.add(section.mean_tension);
  line.add(section.most_tension);
  line.add(section.most_tension - section.least_tension);
  double count = 0.0;
  double largest = 0.0;
  for (const measure::LoadCycle& cycle : section.cycles) {
    count += cycle.count;
    largest = std::max(largest, cycle.range);
  }
  line.add(count);
  line.add(largest);
  if (!options.life.empty()) {
    line.add(all.simple_damage);
    line.add(all.reverse_damage);
    line.add(section.damage());
  }
  for (const int link : links) {
    const auto found =
        std::find_if(section.bends.begin(), section.bends.end(),
                     [&](const measure::SectionBends& one) { return one.link == link; });
    add_bends(found == section.bends.end() ? measure::SectionBends{} : *found, options, line);
  }
  return line.text();
}

}  // namespace

void write_rope_table(const std::string& path, const RopeOptions& options,
                      const std::vector<measure::CableHistory>& cables) {
  const std::set<int> links = bending_links(cables);
  OutputFile file(path);
  file.write(head_line(options, links));
  for (const measure::CableHistory& cable : cables) {
    for (std::size_t i = 0; i < cable.sections.size(); ++i) {
      file.write(section_line(cable, i, options, links));
    }
  }
  file.commit();
}

}  // namespace sheave::command
