#include "cable/floor_profile.h"

#include <algorithm>
#include <cmath>

namespace sheave {
namespace {

/// Integral of T over a piece.
double area(double length, double first, double second) { return 0.5 * length * (first + second); }

}  // namespace

FloorProfile::FloorProfile(double length, double tension) {
  put({0.0, tension});
  if (length > 0.0) put({length, tension});
}

FloorProfile::FloorProfile(std::span<const double> reals) {
  const auto count = static_cast<std::size_t>(reals[0]);
  for (std::size_t i = 0; i < count; ++i) put({reals[1 + 2 * i], reals[2 + 2 * i]});
}

void FloorProfile::save(std::span<double> reals) const {
  std::fill(reals.begin(), reals.end(), 0.0);
  reals[0] = static_cast<double>(count_);
  for (std::size_t i = 0; i < count_; ++i) {
    reals[1 + 2 * i] = nodes_[i].s;
    reals[2 + 2 * i] = nodes_[i].t;
  }
}

bool FloorProfile::is_sound(std::span<const double> reals) {
  const double count = reals[0];
  if (!(count >= 1.0 && count <= most_pieces + 1.0) || count != std::floor(count)) return false;
  double last = 0.0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    const double s = reals[1 + 2 * i];
    const double t = reals[2 + 2 * i];
    if (!std::isfinite(s) || !std::isfinite(t) || t < 0.0) return false;
    if (i == 0 ? s > 0.0 || (s < 0.0 && count > 1.0) : s < last) return false;
    last = s;
  }
  return true;
}

double FloorProfile::at(double s) const {
  for (std::size_t i = 1; i < count_; ++i) {
    const Node& a = nodes_[i - 1];
    const Node& b = nodes_[i];
    if (s > b.s) continue;
    return b.s > a.s ? a.t + (b.t - a.t) * ((s - a.s) / (b.s - a.s)) : b.t;
  }
  return touch_tension();
}

double FloorProfile::sum() const {
  double sum = 0.0;
  for (std::size_t i = 1; i < count_; ++i) {
    sum += area(nodes_[i].s - nodes_[i - 1].s, nodes_[i - 1].t, nodes_[i].t);
  }
  return sum;
}

double FloorProfile::square() const {
  double sum = 0.0;
  for (std::size_t i = 1; i < count_; ++i) {
    const double a = nodes_[i - 1].t;
    const double b = nodes_[i].t;
    sum += (nodes_[i].s - nodes_[i - 1].s) * (a * a + a * b + b * b) / 3.0;
  }
  return sum;
}

FloorProfile::Front FloorProfile::front(double length, double tension, double slope) const {
  Front front;
  const double laid = length - this->length();
  if (laid >= 0.0 && std::abs(tension - touch_tension()) <= slope * laid) {
    front.laid = true;
    front.kept = count_;
    front.at = {length, tension};
    return front;
  }
  Node from = laid >= 0.0 ? nodes_[count_ - 1] : Node{length, at(length)};
  const double sense = tension >= from.t ? 1.0 : -1.0;
  front.rise = sense * slope;
  const auto limit_at = [&](double s) { return tension - front.rise * (length - s); };
  // How far the limit is beyond the old tension: it falls towards the anchor, so rope slides up to one
  // place.
  const auto excess = [&](const Node& node) { return sense * (limit_at(node.s) - node.t); };
  for (std::size_t i = count_; i-- > 0;) {
    const Node& node = nodes_[i];
    if (node.s >= from.s) continue;
    const double there = excess(node);
    if (there > 0.0) {
      from = node;
      continue;
    }
    const double here = excess(from);
    const double share = here > 0.0 ? here / (here - there) : 0.0;
    const double s = from.s - share * (from.s - node.s);
    front.kept = i + 1;
    front.at = {s, std::max(limit_at(s), 0.0)};
    return front;
  }
  front.at = {0.0, std::max(limit_at(0.0), 0.0)};
  return front;
}

FloorProfile::Sum FloorProfile::limited_sum(double length, double tension, double slope) const {
  if (this->length() < 0.0) return at_landing(length, tension).limited_sum(length, tension, slope);
  const Front end = front(length, tension, slope);
  Sum sum;
  Node last = nodes_[0];
  for (std::size_t i = 1; i < end.kept; ++i) {
    sum.sum += area(nodes_[i].s - last.s, last.t, nodes_[i].t);
    last = nodes_[i];
  }
  if (end.kept > 0) sum.sum += area(end.at.s - last.s, last.t, end.at.t);
  if (end.laid) {
    sum.by_tension = 0.5 * (length - last.s);
    sum.by_length = 0.5 * (last.t + tension);
    return sum;
  }
  sum.sum += area(length - end.at.s, end.at.t, tension);
  sum.by_tension = length - end.at.s;
  sum.by_length = end.at.t;
  return sum;
}

FloorProfile FloorProfile::without_limit(double length, double tension) const {
  FloorProfile old = *this;
  while (old.count_ > 1 && old.nodes_[old.count_ - 2].s >= length) --old.count_;
  if (old.count_ > 1 && old.length() > length) {
    const double there = at(length);
    old.nodes_[old.count_ - 1] = {length, there};
  } else if (length > old.length()) {
    old.put({length, tension});
  }
  return old;
}

FloorProfile FloorProfile::at_landing(double length, double tension) const {
  const double lifted = -this->length();
  return FloorProfile(0.0,
                      touch_tension() + (tension - touch_tension()) * (lifted / (lifted + length)));
}

double FloorProfile::limit(double length, double tension, double slope) {
  if (length <= 0.0) {
    count_ = 0;
    put({length, tension});
    return 0.0;
  }
  if (this->length() < 0.0) *this = at_landing(length, tension);
  const Front end = front(length, tension, slope);
  const FloorProfile old = without_limit(length, tension);
  const double laid = length - this->length();
  count_ = end.kept;
  if (count_ == 0 || end.at.s > nodes_[count_ - 1].s) put(end.at);
  if (!end.laid && length > nodes_[count_ - 1].s) put({length, tension});
  // The way of each place times EA, from the front on, over the pieces of the old profile.
  double way = 0.0;
  double lost = 0.0;
  Node from = end.at;
  double change = 0.0;
  for (std::size_t i = 0; !end.laid && i < old.count_; ++i) {
    const Node& node = old.nodes_[i];
    if (node.s <= from.s) {
      // A profile that slides as a whole has a change at the anchor.
      if (node.s == from.s) change = from.t - node.t;
      continue;
    }
    const double d = node.s - from.s;
    const double now = tension - end.rise * (length - node.s);
    const double next = now - node.t;
    lost += d * (way + d * (change / 3.0 + next / 6.0));
    way += 0.5 * d * (change + next);
    change = next;
    from = {node.s, now};
  }
  shorten(slope);
  return slope * std::abs(lost - 0.5 * way * laid);
}

void FloorProfile::shorten(double slope) {
  /// How far a node is beside the line between its neighbours, as an area.
  const auto beside = [&](std::size_t i) {
    const Node& a = nodes_[i - 1];
    const Node& b = nodes_[i];
    const Node& c = nodes_[i + 1];
    return area(b.s - a.s, a.t, b.t) + area(c.s - b.s, b.t, c.t) - area(c.s - a.s, a.t, c.t);
  };
  while (count_ > most_pieces + 1) {
    std::size_t best = 1;
    double least = 0.0;
    for (std::size_t i = 1; i + 2 < count_; ++i) {
      const double change = std::abs(beside(i)) + std::abs(beside(i + 1));
      if (i > 1 && change >= least) continue;
      best = i;
      least = change;
    }
    // One node for two, with the same J.
    const Node& a = nodes_[best - 1];
    const Node& b = nodes_[best];
    const Node& c = nodes_[best + 1];
    const Node& d = nodes_[best + 2];
    const double sum =
        area(b.s - a.s, a.t, b.t) + area(c.s - b.s, b.t, c.t) + area(d.s - c.s, c.t, d.t);
    const double s = 0.5 * (b.s + c.s);
    const double t = (2.0 * sum - (s - a.s) * a.t - (d.s - s) * d.t) / (d.s - a.s);
    const bool holds =
        std::abs(t - a.t) <= slope * (s - a.s) && std::abs(d.t - t) <= slope * (d.s - s);
    // Tensions that friction cannot hold change J instead.
    if (holds) nodes_[best] = {s, t};
    std::copy(nodes_.begin() + static_cast<std::ptrdiff_t>(best) + 2,
              nodes_.begin() + static_cast<std::ptrdiff_t>(count_),
              nodes_.begin() + static_cast<std::ptrdiff_t>(best) + 1);
    --count_;
  }
}

}  // namespace sheave
