#include "cable/running_cable.h"

#include <algorithm>

namespace sheave {

std::size_t RunningCable::place_of(int listed) const {
  std::size_t place = 0;
  for (int left = listed; place < links.size(); ++place) {
    if (links[place].is_listed() && left-- == 0) break;
  }
  return place;
}

int RunningCable::listed_count() const {
  return static_cast<int>(std::count_if(links.begin(), links.end(),
                                        [](const RunningLink& link) { return link.is_listed(); }));
}

double RunningCable::length() const {
  double length = 0.0;
  for (const RunningLink& link : links) {
    length += link.stored_length;
    if (link.span) length += link.span->rest_length;
  }
  return length;
}

}  // namespace sheave
