#pragma once
// Recordings in few bytes.
//
// A value is rounded to an integer number of quanta q. For each channel the differences of order 0
// to 3 of these integers are computed, and the order that needs the fewest bytes is stored. Smooth
// motion sampled densely has third differences of a few quanta, and rest has none; both compress to
// almost nothing.
//
// Accuracy: a value is wrong by at most q / 2. For lengths, angles (including components of
// quaternions) and forces q = 1e-6 min(1, s), where s is the largest absolute value of that kind in
// the recording. For all other channels s is that of the channel. The error is therefore at most
// 5e-7 of the unit, and at most 5e-7 of the scale of a machine smaller than the unit. Only if s
// exceeds 2.8e8 units, q grows as s 2^-48, because the integers must be exact in doubles; the error
// is then below 2e-15 s. Channels of integers have q = 1. Constant channels and channels with
// non-finite values are stored without rounding.

#include <string>

#include "view/machine_json.h"
#include "view/recording.h"

namespace sheave::view {

/// The data that web/src/recording.ts unpacks, compressed by zlib: the length of a JSON head (4
/// bytes, little-endian), the head, then the stream that recording.ts describes. `machine` is
/// machine_json().
[[nodiscard]] std::string pack(const Json& machine, const Recording& recording);

/// RFC 4648, with padding.
[[nodiscard]] std::string base64(const std::string& bytes);

}  // namespace sheave::view
