#pragma once
// Short loops whose length the compiler knows.
//
// Rows touch few degrees of freedom, and columns of their factors have few entries. A loop over
// two to eight of them counts and branches as much as it computes, so the loop is written out.

#include <utility>

namespace sheave {

/// body(0), body(1), ..., body(count - 1).
template <int... I, class Body>
[[gnu::always_inline]] inline void each_of(std::integer_sequence<int, I...> /*indices*/,
                                           const Body& body) {
  (body(I), ...);
}

/// Calls body(i) for i = 0 ... count - 1, without a loop if `count` is at most 8.
template <class Body>
[[gnu::always_inline]] inline void for_few(int count, const Body& body) {
  switch (count) {
    case 0:
      return;
    case 1:
      return each_of(std::make_integer_sequence<int, 1>{}, body);
    case 2:
      return each_of(std::make_integer_sequence<int, 2>{}, body);
    case 3:
      return each_of(std::make_integer_sequence<int, 3>{}, body);
    case 4:
      return each_of(std::make_integer_sequence<int, 4>{}, body);
    case 5:
      return each_of(std::make_integer_sequence<int, 5>{}, body);
    case 6:
      return each_of(std::make_integer_sequence<int, 6>{}, body);
    case 7:
      return each_of(std::make_integer_sequence<int, 7>{}, body);
    case 8:
      return each_of(std::make_integer_sequence<int, 8>{}, body);
    default:
      for (int i = 0; i < count; ++i) body(i);
  }
}

}  // namespace sheave
