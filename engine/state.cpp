#include "engine/state.h"

#include <cstring>
#include <utility>

#include "engine/control_members.h"
#include "engine/math/bits.h"

namespace sheave {
namespace {

constexpr std::uint64_t tag_with_step_size = 0x35'45'54'41'54'53'48'53;    // "SHSTATE5"
constexpr std::uint64_t format_tag = 0x34'45'54'41'54'53'48'53;            // "SHSTATE4"
constexpr std::uint64_t tag_without_history = 0x33'45'54'41'54'53'48'53;   // "SHSTATE3"
constexpr std::uint64_t tag_without_checksum = 0x32'45'54'41'54'53'48'53;  // "SHSTATE2"
constexpr std::uint64_t tag_without_controls = 0x31'45'54'41'54'53'48'53;  // "SHSTATE1"

/// Follows the tag. Versions without a checksum have the number of steps here, which is never -1. A
/// file of this version whose tag has been changed to an older one is therefore detected.
constexpr std::uint64_t no_older_version = ~std::uint64_t{0};

/// FNV-1a, word by word. For a given previous value, each word enters by a one-to-one function. Two
/// lists that differ in a single word therefore never have the same hash.
class WordHash {
 public:
  void add(std::uint64_t word) {
    // FNV-1a multiplies after every byte. With a multiplication per word, the high bits would never
    // reach the low ones, so they are folded back.
    value_ = (value_ ^ word) * 0x100000001b3;
    value_ ^= value_ >> 32;
  }
  [[nodiscard]] std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325;
};

/// Files are little-endian on every machine.
std::uint64_t little_endian(std::uint64_t word) {
  if constexpr (__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__) return word;
  std::uint64_t turned = 0;
  for (int byte = 0; byte < 8; ++byte) {
    turned = turned << 8U | (word >> (8U * static_cast<unsigned>(byte)) & 0xffU);
  }
  return turned;
}

/// Calls visit(word) for each word of a member of a control.
template <class Visit>
struct MemberWords {
  const Visit& visit;
  void operator()(bool b) const { visit(static_cast<std::uint64_t>(b)); }
  void operator()(double x) const { visit(bits_of(x)); }
  void operator()(ForceFrame frame) const { visit(static_cast<std::uint64_t>(frame)); }
  void operator()(const Vector3& v) const {
    for (const double x : v) (*this)(x);
  }
  void operator()(const Quaternion& q) const {
    for (const double x : q.coeffs()) (*this)(x);
  }
};

template <class Control, class Visit>
void for_each_word_of(const Control& control, const Visit& visit) {
  ControlMembers<Control>::visit(control, MemberWords<Visit>{visit});
}

/// Calls visit(word) for the controls that are set. A table whose entries have been cleared gives
/// the same words as an empty one.
template <class Visit>
void for_each_word_set(const Controls& controls, const Visit& visit) {
  if (controls.empty()) return;
  const MemberWords<Visit> words{visit};
  words(controls.has_gravity);
  if (controls.has_gravity) words(controls.gravity);
  visit_tables(controls, [&]<class Control>(const ControlTable<Control>& table) {
    std::uint64_t index = 0;
    std::uint64_t set = 0;
    for (const Control& control : table.entries()) {
      if (control.is_set()) {
        ++set;
        visit(index);
        for_each_word_of(control, visit);
      }
      ++index;
    }
    visit(set);
  });
}

/// The tables with their sizes, for a file.
template <class Visit>
void for_each_word(const Controls& controls, const Visit& visit) {
  const MemberWords<Visit> words{visit};
  words(controls.has_gravity);
  if (controls.has_gravity) words(controls.gravity);
  visit_tables(controls, [&]<class Control>(const ControlTable<Control>& table) {
    visit(static_cast<std::uint64_t>(table.entries().size()));
    for (const Control& control : table.entries()) {
      words(control.is_set());
      if (control.is_set()) for_each_word_of(control, visit);
    }
  });
}

/// Calls visit(word) for every number of a state except its controls, in a fixed order. hash() and
/// to_bytes() share the function, so neither can omit a member.
template <class Visit>
void for_each_word(const State& state, const Visit& visit) {
  const auto real = [&](double x) { visit(bits_of(x)); };
  const auto integer = [&](std::int64_t i) { visit(static_cast<std::uint64_t>(i)); };
  const auto count = [&](std::size_t n) { visit(static_cast<std::uint64_t>(n)); };
  const auto vector = [&](const Vector3& v) {
    for (const double x : v) real(x);
  };
  integer(state.steps);
  real(state.time);
  count(state.bodies.size());
  for (const BodyState& body : state.bodies) {
    vector(body.position);
    for (const double x : body.orientation.coeffs()) real(x);
    vector(body.velocity);
    vector(body.angular_velocity);
    real(body.angle);
  }
  count(state.features.size());
  for (const FeatureState& feature : state.features) {
    count(feature.reals.size());
    for (const double x : feature.reals) real(x);
    count(feature.integers.size());
    for (const std::int64_t i : feature.integers) integer(i);
  }
}

/// Calls visit(word) for the history of motion; one word if it is empty.
template <class Visit>
void for_each_word(const MotionHistory& history, const Visit& visit) {
  visit(static_cast<std::uint64_t>(history.known));
  if (history.known == 0) return;
  visit(static_cast<std::uint64_t>(history.order));
  visit(bits_of(history.step));
  visit(static_cast<std::uint64_t>(history.differences.size()));
  for (const double x : history.differences) visit(bits_of(x));
}

/// Calls visit(word) for the lengths of substeps.
template <class Visit>
void for_each_word(const StepSizeMemory& size, const Visit& visit) {
  visit(static_cast<std::uint64_t>(size.level));
  for (const double x : {size.middle, size.window, size.jerk_before, size.jerk,
                         size.acceleration_before, size.acceleration}) {
    visit(bits_of(x));
  }
  visit(static_cast<std::uint64_t>(size.accelerations.size()));
  for (const double x : size.accelerations) visit(bits_of(x));
}

/// Reads words back; a read past the end or an impossible count sets `failed_`.
class Reader {
 public:
  explicit Reader(const std::string& bytes) : bytes_(bytes) {}
  std::uint64_t word() {
    std::uint64_t result = 0;
    if (position_ + sizeof result > bytes_.size()) {
      failed_ = true;
      return 0;
    }
    std::memcpy(&result, bytes_.data() + position_, sizeof result);
    position_ += sizeof result;
    return little_endian(result);
  }
  double real() { return double_of(word()); }
  std::int64_t integer() { return static_cast<std::int64_t>(word()); }
  /// The length of a list whose elements take at least `words` words each; a length beyond the end
  /// of the bytes is an error.
  std::size_t count(std::size_t words) {
    const std::uint64_t n = word();
    const std::size_t left = (bytes_.size() - position_) / (sizeof(std::uint64_t) * words);
    if (n > left) failed_ = true;
    return failed_ ? 0 : static_cast<std::size_t>(n);
  }
  Vector3 vector() {
    Vector3 v;
    for (double& x : v) x = real();
    return v;
  }
  bool flag() {
    const std::uint64_t b = word();
    if (b > 1) failed_ = true;
    return b == 1;
  }
  // The members of controls.
  void read(bool& b) { b = flag(); }
  void read(double& x) { x = real(); }
  void read(ForceFrame& frame) { frame = flag() ? ForceFrame::body : ForceFrame::world; }
  void read(Vector3& v) { v = vector(); }
  void read(Quaternion& q) {
    for (double& x : q.coeffs()) x = real();
  }
  template <class Control>
  void read(ControlTable<Control>& table) {
    std::vector<Control> entries(count(1));
    for (Control& entry : entries) {
      if (!flag()) continue;
      ControlMembers<Control>::visit(entry, [this](auto& member) { this->read(member); });
      if (!entry.is_set()) failed_ = true;
    }
    table.assign(std::move(entries));
  }
  [[nodiscard]] bool complete() const { return !failed_ && position_ == bytes_.size(); }

 private:
  const std::string& bytes_;
  std::size_t position_ = 0;
  bool failed_ = false;
};

}  // namespace

std::uint64_t hash(const State& state) {
  WordHash result;
  const auto add = [&](std::uint64_t word) { result.add(word); };
  for_each_word(state, add);
  for_each_word_set(state.controls, add);
  for (const double x : state.memory) add(bits_of(x));
  if (state.history.known > 0) for_each_word(state.history, add);
  if (!state.step_size.empty()) for_each_word(state.step_size, add);
  return result.value();
}

std::string to_bytes(const State& state, const StateOrigin& origin) {
  std::string bytes;
  WordHash sum;
  const auto append = [&](std::uint64_t word) {
    sum.add(word);
    word = little_endian(word);
    char buffer[sizeof word];
    std::memcpy(buffer, &word, sizeof word);
    bytes.append(buffer, sizeof word);
  };
  // Programs that know no tolerance read the states of fixed substeps.
  append(state.step_size.empty() ? format_tag : tag_with_step_size);
  append(no_older_version);
  append(origin.scene);
  append(origin.layout);
  for_each_word(state, append);
  for_each_word(state.controls, append);
  append(static_cast<std::uint64_t>(state.memory.size()));
  for (const double x : state.memory) append(bits_of(x));
  for_each_word(state.history, append);
  if (!state.step_size.empty()) for_each_word(state.step_size, append);
  sum.add(bytes.size() / sizeof(std::uint64_t));
  append(sum.value());
  return bytes;
}

namespace {

/// Whether the last word is the checksum of the preceding words and of their number. Without the
/// number, adding the checksum itself to the hash would leave 0, and an appended 0 would be
/// accepted.
bool has_right_sum(const std::string& bytes) {
  constexpr std::size_t word_size = sizeof(std::uint64_t);
  const std::size_t words = bytes.size() / word_size;
  if (bytes.size() % word_size != 0 || words == 0) return false;
  Reader reader(bytes);
  WordHash sum;
  for (std::size_t i = 1; i < words; ++i) sum.add(reader.word());
  sum.add(words - 1);
  return reader.word() == sum.value();
}

}  // namespace

/// A history as for_each_word() gives it.
MotionHistory read_history(Reader& reader) {
  MotionHistory history;
  history.known = reader.integer();
  if (history.known == 0) return history;
  history.order = reader.integer();
  history.step = reader.real();
  history.differences.resize(reader.count(1));
  for (double& x : history.differences) x = reader.real();
  return history;
}

/// Lengths of substeps as for_each_word() gives them.
StepSizeMemory read_step_size(Reader& reader) {
  StepSizeMemory size;
  size.level = reader.integer();
  for (double* x : {&size.middle, &size.window, &size.jerk_before, &size.jerk,
                    &size.acceleration_before, &size.acceleration}) {
    *x = reader.real();
  }
  size.accelerations.resize(reader.count(1));
  for (double& x : size.accelerations) x = reader.real();
  return size;
}

Result<State> state_from_bytes(const std::string& bytes) {
  Result<SavedState> saved = saved_state_from_bytes(bytes);
  if (!saved) return saved.errors();
  return std::move(saved->state);
}

Result<SavedState> saved_state_from_bytes(const std::string& bytes) {
  Reader reader(bytes);
  const std::uint64_t first = reader.word();
  const bool with_history = first == format_tag || first == tag_with_step_size;
  const bool summed = with_history || first == tag_without_history;
  if (!summed && first != tag_without_checksum && first != tag_without_controls) {
    constexpr std::size_t tag_size = 8;
    const std::string tag = bytes.substr(0, tag_size);
    const bool version = tag.starts_with("SHSTATE") && tag.back() > ' ' && tag.back() < 0x7f;
    if (version && tag.size() == tag_size) {
      return Error{"", "a saved state of another version: it is " + tag +
                           "; this program reads SHSTATE1 to SHSTATE5"};
    }
    return Error{
        "",
        "not a saved state of this program: the first eight bytes must be SHSTATE4 or SHSTATE5"};
  }
  SavedState saved;
  State& state = saved.state;
  if (summed) {
    if (!has_right_sum(bytes)) {
      return Error{"",
                   "a saved state must be as it was written: the checksum at the end of these " +
                       std::to_string(bytes.size()) +
                       " bytes is wrong; the bytes are truncated or have been changed"};
    }
    saved.checked = reader.word() == no_older_version;
    saved.origin.scene = reader.word();
    saved.origin.layout = reader.word();
  }
  state.steps = reader.integer();
  state.time = reader.real();
  state.bodies.resize(reader.count(14));
  for (BodyState& body : state.bodies) {
    body.position = reader.vector();
    for (double& x : body.orientation.coeffs()) x = reader.real();
    body.velocity = reader.vector();
    body.angular_velocity = reader.vector();
    body.angle = reader.real();
  }
  state.features.resize(reader.count(2));
  for (FeatureState& feature : state.features) {
    feature.reals.resize(reader.count(1));
    for (double& x : feature.reals) x = reader.real();
    feature.integers.resize(reader.count(1));
    for (std::int64_t& i : feature.integers) i = reader.integer();
  }
  if (first != tag_without_controls) {
    state.controls.has_gravity = reader.flag();
    if (state.controls.has_gravity) reader.read(state.controls.gravity);
    visit_tables(state.controls, [&](auto& table) { reader.read(table); });
    state.memory.resize(reader.count(1));
    for (double& x : state.memory) x = reader.real();
  }
  if (with_history) state.history = read_history(reader);
  if (first == tag_with_step_size) state.step_size = read_step_size(reader);
  if (summed) static_cast<void>(reader.word());
  const bool older = !summed && state.steps >= 0;
  if (!reader.complete() || !(saved.checked || older)) {
    return Error{"", "a saved state must be complete: these " + std::to_string(bytes.size()) +
                         " bytes are truncated or hold something else"};
  }
  return saved;
}

}  // namespace sheave
