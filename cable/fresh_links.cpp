#include "cable/fresh_links.h"

#include "engine/field_check.h"
#include "engine/index.h"

namespace sheave {
namespace {

/// A link and the new links behind it.
struct Group {
  std::vector<std::size_t> listed;  // indices among the listed links
  double length = 0.0;              // sum of their spans [m]
};

class FreshShare {
 public:
  FreshShare(const CompiledCable& cable, const LinkWays& ways, RunningCable& running)
      : cable_(cable), ways_(ways), running_(running) {
    for (std::size_t i = 0; i < running.links.size(); ++i) {
      if (running.links[i].is_listed()) places_.push_back(i);
    }
  }

  [[nodiscard]] std::string share() {
    for (std::size_t first = 0; first < places_.size(); ++first) {
      if (link(first).is_fresh) continue;
      const Group group = group_of(first);
      if (group.listed.size() == 1) continue;
      std::string fault = share(group);
      if (!fault.empty()) return "cable \"" + cable_.name + "\" " + fault;
    }
    return {};
  }

 private:
  [[nodiscard]] RunningLink& link(std::size_t listed) { return running_.links[places_[listed]]; }
  [[nodiscard]] double rounded(double length) const {
    return CompiledCable::quantised(length, running_.quantum, 1.0 / running_.quantum);
  }

  /// In a belt the links behind the last link are its first ones.
  [[nodiscard]] Group group_of(std::size_t first) {
    Group group;
    const std::size_t count = places_.size();
    const std::size_t end = count + (cable_.closed ? first : 0);
    for (std::size_t next = first; next < end; ++next) {
      const RunningLink& own = link(next % count);
      if (next != first && !own.is_fresh) break;
      group.listed.push_back(next % count);
      group.length += own.span.value_or(RunningSpan{}).rest_length;
    }
    return group;
  }

  [[nodiscard]] std::string share(const Group& group) {
    const std::size_t first = group.listed.front();
    const std::size_t behind = places_[group.listed.back()] + 1;
    if (behind < running_.links.size() && running_.links[behind].is_wrap()) {
      return "wraps another body behind its span " + std::to_string(first) +
             "; insert the link elsewhere";
    }
    double spans = ways_.spans[first];
    double arcs = 0.0;
    for (const std::size_t i : group.listed) {
      if (i == first) continue;
      spans += ways_.spans[i];
      arcs += ways_.arcs[i];
    }
    // With a material the cable stored on links is strained, too.
    const bool strained = cable_.inverse_stiffness > 0.0 && group.length < spans + arcs;
    const double on_links = strained ? group.length / (spans + arcs) : 1.0;
    double left = group.length;
    for (const std::size_t i : group.listed) {
      if (i == first) continue;
      link(i).stored_length = rounded(on_links * ways_.arcs[i]);
      link(i).stored_strain = strained ? 1.0 / on_links - 1.0 : 0.0;
      left -= link(i).stored_length;
    }
    if (!(left > 0.0) || !(spans > 0.0)) {
      return "has " + number_text(group.length) + " m in its span " + std::to_string(first) +
             ", too little for the inserted link";
    }
    const double part = left / spans;
    for (const std::size_t i : group.listed) {
      const bool is_last = i == group.listed.back();
      const double length = is_last ? left : rounded(part * ways_.spans[i]);
      link(i).span->rest_length = length;
      left -= length;
    }
    return {};
  }

  const CompiledCable& cable_;
  const LinkWays& ways_;
  RunningCable& running_;
  std::vector<std::size_t> places_;  // indices of the listed links among all
};

}  // namespace

std::string share_with_fresh_links(const CompiledCable& cable, const LinkWays& ways,
                                   RunningCable& running) {
  return FreshShare(cable, ways, running).share();
}

}  // namespace sheave
