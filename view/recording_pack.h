#pragma once
// Recordings in few bytes.
//
// A value becomes a whole number of quanta q, and of those numbers the differences of order 0 to 3
// are kept, of whichever order needs the fewest bytes. Smooth motion sampled densely has third
// differences of a few quanta, rest has none; both then compress to next to nothing.
//
// How exact it is: a value is off by at most q / 2. For lengths, angles (and parts of quaternions)
// and forces q = 1e-6 min(1, s), with s the largest size that any value of the kind has in the
// recording; for all others the same with s that of the channel. So what is read back is within
// 5e-7 of the unit, and within 5e-7 of the scale of machines that are smaller than it. Only where s
// is above 2.8e8 units q grows as s 2^-48, because numbers of quanta must stay exact in doubles;
// the error then is below 2e-15 s. Channels of whole numbers have q = 1; those that do not change
// and those with values that are not finite are kept as they are.

#include <string>

#include "view/machine_json.h"
#include "view/recording.h"

namespace sheave::view {

/// What web/src/recording.ts unpacks, compressed by zlib: the length of a JSON head (4 bytes,
/// little-endian), the head, then the stream that recording.ts describes. `machine` is
/// machine_json().
[[nodiscard]] std::string pack(const Json& machine, const Recording& recording);

/// RFC 4648, with padding.
[[nodiscard]] std::string base64(const std::string& bytes);

}  // namespace sheave::view
