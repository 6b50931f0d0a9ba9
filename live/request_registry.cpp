// The types of requests: one line each.

#include <array>

#include "live/request.h"

namespace sheave::live {

std::span<const TypeEntry<Request>> request_types() {
  static const std::array types{
      hello_request(),   describe_request(),  step_request(),        run_request(),
      pause_request(),   set_request(),       clear_request(),       place_request(),
      release_request(), lock_request(),      cut_request(),         edit_request(),
      observe_request(), subscribe_request(), unsubscribe_request(), snapshot_request(),
      restore_request(), forget_request(),    hash_request(),        quit_request(),
  };
  return types;
}

std::span<const Field> Request::common_field_table() {
  static const std::array table{
      field<&Request::id>("id", "", any_number(), optional,
                          "the answer repeats it; up to 2^53 integers are exact"),
      field<&Request::at_step>("at_step", "", at_least(0.0), optional,
                               "the request is refused unless the world is at this step"),
      field<&Request::checksum>("checksum", "", any_number(), optional,
                                "of a line of a log, at its end: its number and the checksum of "
                                "the log up to it; the request is refused unless all lines with "
                                "one are as they were written"),
  };
  return table;
}

}  // namespace sheave::live
