#include "view/recording_pack.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <new>
#include <string_view>

#include <zlib.h>

namespace sheave::view {
namespace {

constexpr double tolerance = 1e-6;
constexpr int most_order = 3;

/// Appends eight bytes, least significant first, on every machine.
void append_double(double value, std::string& out) {
  std::uint64_t bits = 0;
  static_assert(sizeof bits == sizeof value);
  std::memcpy(&bits, &value, sizeof bits);
  for (int i = 0; i < 8; ++i) out += static_cast<char>((bits >> (8U * i)) & 0xFFU);
}

/// Appends seven bits per byte, the sign last.
void append_integer(std::int64_t value, std::string& out) {
  const auto u = static_cast<std::uint64_t>(value);
  std::uint64_t zigzag = (u << 1U) ^ (value < 0 ? ~std::uint64_t{0} : 0);
  for (; zigzag >= 128; zigzag >>= 7U) out += static_cast<char>((zigzag & 127U) | 128U);
  out += static_cast<char>(zigzag);
}

/// Replaces the values by their differences; the first value is its difference to 0.
void differentiate(std::vector<std::int64_t>& values) {
  for (std::size_t k = values.size(); k-- > 1;) values[k] -= values[k - 1];
}

double cost(const std::vector<std::int64_t>& values) {
  double bits = 0.0;
  for (const std::int64_t v : values) bits += std::log2(1.0 + std::abs(static_cast<double>(v)));
  return bits;
}

double largest_size(const std::vector<double>& values) {
  double largest = 0.0;
  for (const double v : values) {
    if (std::isfinite(v)) largest = std::max(largest, std::abs(v));
  }
  return largest;
}

bool is_whole(double v) { return std::abs(v) < 0x1p48 && v == std::nearbyint(v); }

class Packer {
 public:
  explicit Packer(const Recording& recording) : recording_(recording) {
    const auto& channels = recording.channels().channels();
    for (std::size_t i = 0; i < channels.size(); ++i) {
      double& scale = scales_[static_cast<std::size_t>(channels[i].kind)];
      scale = std::max(scale, largest_size(recording.columns()[i]));
    }
  }

  /// The head of a channel; its values are appended to the stream.
  Json pack(std::size_t index) {
    const FrameChannel& channel = recording_.channels().channels()[index];
    const std::vector<double>& values = recording_.columns()[index];
    const auto known =
        std::find_if(values.begin(), values.end(), [](double v) { return !std::isnan(v); });
    Json head = channel_json(channel);
    if (known != values.begin()) head["missing"] = known - values.begin();
    const std::vector<double> rest(known, values.end());
    if (std::all_of(rest.begin(), rest.end(), [&](double v) { return v == rest.front(); })) {
      head["packing"] = "constant";
      if (!rest.empty() && std::isfinite(rest.front())) head["value"] = rest.front();
    } else if (!std::all_of(rest.begin(), rest.end(), [](double v) { return std::isfinite(v); })) {
      head["packing"] = "exact";
      for (const double v : rest) append_double(v, stream_);
    } else {
      pack_steps(channel, rest, head);
    }
    return head;
  }

  void append_times() {
    for (const double time : recording_.times()) append_double(time, stream_);
  }
  [[nodiscard]] const std::string& stream() const { return stream_; }

 private:
  [[nodiscard]] double quantum(const FrameChannel& channel,
                               const std::vector<double>& values) const {
    if (std::all_of(values.begin(), values.end(), is_whole)) return 1.0;
    const double own = largest_size(values);
    const double scale =
        channel.kind == ChannelKind::other ? own : scales_[static_cast<std::size_t>(channel.kind)];
    return std::max(tolerance * std::min(1.0, scale), own * 0x1p-48);
  }

  void pack_steps(const FrameChannel& channel, const std::vector<double>& values, Json& head) {
    const double q = quantum(channel, values);
    std::vector<std::int64_t> numbers;
    numbers.reserve(values.size());
    for (const double v : values) numbers.push_back(std::llround(v / q));
    std::vector<std::int64_t> best = numbers;
    int best_order = 0;
    double least = cost(numbers);
    for (int order = 1; order <= most_order; ++order) {
      differentiate(numbers);
      const double bits = cost(numbers);
      if (bits >= least) continue;
      least = bits;
      best = numbers;
      best_order = order;
    }
    head["packing"] = "steps";
    head["quantum"] = q;
    head["order"] = best_order;
    for (const std::int64_t number : best) append_integer(number, stream_);
  }

  const Recording& recording_;
  std::array<double, 4> scales_{};
  std::string stream_;
};

std::string compressed(const std::string& bytes) {
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::string out(size, '\0');
  // compress2 fails only for lack of memory, which throws everywhere else, too.
  if (compress2(reinterpret_cast<Bytef*>(out.data()), &size,
                reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uLong>(bytes.size()),
                Z_DEFAULT_COMPRESSION) != Z_OK) {
    throw std::bad_alloc();
  }
  out.resize(size);
  return out;
}

}  // namespace

std::string pack(const Json& machine, const Recording& recording) {
  Packer packer(recording);
  packer.append_times();
  Json channels = Json::array();
  for (std::size_t i = 0; i < recording.columns().size(); ++i) channels.push_back(packer.pack(i));
  Json events = Json::array();
  for (const RecordedEvent& event : recording.events()) {
    events.push_back({{"time", event.time}, {"kind", event.kind}, {"text", event.text}});
  }
  const Json head{{"machine", machine},
                  {"events", events},
                  {"frames", recording.times().size()},
                  {"channels", channels}};
  const std::string text = head.dump(-1, ' ', false, Json::error_handler_t::replace);
  std::string bytes;
  for (int i = 0; i < 4; ++i) bytes += static_cast<char>((text.size() >> (8U * i)) & 0xFFU);
  return compressed(bytes + text + packer.stream());
}

std::string base64(const std::string& bytes) {
  constexpr std::string_view digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  const auto byte = [&](std::size_t k) {
    return k < bytes.size() ? static_cast<unsigned>(static_cast<unsigned char>(bytes[k])) : 0U;
  };
  for (std::size_t k = 0; k < bytes.size(); k += 3) {
    const unsigned group = (byte(k) << 16U) | (byte(k + 1) << 8U) | byte(k + 2);
    out += digits[group >> 18U];
    out += digits[(group >> 12U) & 63U];
    out += k + 1 < bytes.size() ? digits[(group >> 6U) & 63U] : '=';
    out += k + 2 < bytes.size() ? digits[group & 63U] : '=';
  }
  return out;
}

}  // namespace sheave::view
