// Any edits in any order: length is kept to the last bit, what is refused changes nothing, and the
// machine goes on.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>

#include <gtest/gtest.h>

#include "cable/edit.h"
#include "cable/links/pinhole.h"
#include "cable/live_world.h"
#include "engine/body_set.h"
#include "engine/index.h"
#include "tests/support/builders.h"
#include "tests/support/effort.h"

namespace sheave {
namespace {

/// Lengths as whole numbers of 2^-55 m: sums of these are exact.
std::int64_t units(double length) {
  const double scaled = std::ldexp(length, 55);
  EXPECT_EQ(std::round(scaled), scaled) << "finer than any quantum here";
  return static_cast<std::int64_t>(scaled);
}

class Editor {
 public:
  explicit Editor(std::uint64_t seed) : random_(seed), world_(start()) {}

  /// Does or is refused one edit; then lengths must add up.
  void edit() {
    const std::int64_t before = total();
    const std::uint64_t state = hash(world_.state());
    std::int64_t told = 0;
    const Result<EditReport> done = world_.edit([&](Edit& e) { change(e); });
    ++edits_;
    if (done) {
      ++done_;
      for (const EditReport::Cable& cable : done->cables) told += units(cable.added);
      for (const CableDef& cable : *world_.simulation().cable_definitions) {
        if (cable.closed) ++with_belts_;
      }
    } else {
      ASSERT_EQ(hash(world_.state()), state) << done.errors()[0].message;
    }
    ASSERT_EQ(total(), before + told);
  }
  void step() {
    const std::int64_t before = total();
    for (int i = 0; i < 3; ++i) {
      const LiveReport report = world_.step();
      if (report.ok()) continue;
      ASSERT_EQ(total(), before);
      return take_out_what_has_arrived(*report.divergence);
    }
    ASSERT_EQ(total(), before);
    if (take_out_what_is_impossible()) return;
    const std::optional<Certificate> certificate = world_.simulation().certificate();
    ASSERT_TRUE(certificate.has_value());
    if (!certificate->clean()) {
      ++doubtful_;
      last_doubt_ = certificate->worst()->sentence();
    }
  }
  [[nodiscard]] int done() const { return done_; }
  [[nodiscard]] int with_belts() const { return with_belts_; }
  [[nodiscard]] int doubtful() const { return doubtful_; }
  [[nodiscard]] const std::string& last_doubt() const { return last_doubt_; }

 private:
  /// An attachment can come to a wheel or a pinhole here, which ends the step by name.
  void take_out_what_has_arrived(const Divergence& divergence) {
    const std::string& why = divergence.message;
    ASSERT_NE(why.find("has reached the "), std::string::npos) << why;
    const std::size_t begin = why.find('"') + 1;
    const Result<CableHandle> cable = world_.cable(why.substr(begin, why.find('"', begin) - begin));
    ASSERT_TRUE(cable.ok()) << why;
    ASSERT_TRUE(world_.edit([&](Edit& e) { e.remove(*cable); }).ok());
  }
  /// An eyelet can swing into a wheel here, and then there is no way for a cable; whether there was
  /// one.
  bool take_out_what_is_impossible() {
    const std::vector<CableReport> reports = world_.simulation().cable_reports();
    std::vector<std::string> without_way;
    for (const CableReport& cable : reports) {
      const auto no_tangent = [](const SpanReport& span) { return !span.has_tangent; };
      if (std::any_of(cable.spans.begin(), cable.spans.end(), no_tangent)) {
        without_way.emplace_back(cable.name);
      }
    }
    for (const std::string& name : without_way) {
      const CableHandle cable = *world_.cable(name);
      EXPECT_TRUE(world_.edit([&](Edit& e) { e.remove(cable); }).ok()) << name;
    }
    return !without_way.empty();
  }
  static LiveWorld start() {
    test::Machine machine;
    machine.model.gravity = test::down;
    machine.model.step = test::direct_settings(IntegratorKind::rattle, 0.01);
    machine.model.bodies = {test::wheel("left", {-1.0, 0.0, 0.0}, 0.2, 0.02),
                            test::wheel("right", {1.0, 0.3, 0.0}, 0.3, 0.03),
                            test::lump("a", {-1.5, -2.0, 0.0}, 1.0),
                            test::lump("b", {1.6, -2.0, 0.0}, 2.0)};
    for (int i = 2; i < 4; ++i) machine.model.bodies[at(i)].damping = 3.0;
    CableDef rope = test::cable(
        "rope",
        {test::attach(BodyId{2}), test::roll(BodyId{0}, test::right), test::attach(BodyId{3})});
    rope.rest_lengths = {2.5, 4.5};
    machine.cables = {rope};
    Result<LiveWorld> world = LiveWorld::create(machine.model, machine.cables);
    EXPECT_TRUE(world.ok());
    return std::move(*world);
  }
  int pick(int count) { return std::uniform_int_distribution<int>(0, count - 1)(random_); }
  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  Vector3 somewhere() { return {between(-2.0, 2.0), between(-2.0, 1.0), between(-0.5, 0.5)}; }
  Winding some_winding() { return pick(2) == 0 ? test::left : test::right; }
  CableHandle some_cable() {
    const std::vector<CableHandle> all = world_.cables();
    return all.empty() ? CableHandle{} : all[at(pick(static_cast<int>(all.size())))];
  }
  BodyId some_body() {
    const std::vector<BodyHandle> all = world_.bodies();
    const int which = pick(static_cast<int>(all.size()) + 2);
    return which < static_cast<int>(all.size()) ? BodyId{all[at(which)].slot} : BodyId::world();
  }
  CableEnd some_end() { return pick(2) == 0 ? CableEnd::first : CableEnd::last; }
  std::string new_name() { return "thing " + std::to_string(++names_); }
  Vector3 place_on(BodyId body) {
    if (body.is_world()) return somewhere();
    return {between(-0.1, 0.1), between(-0.1, 0.1), between(-0.1, 0.1)};
  }

  void change(Edit& e) {
    const int several = pick(4) == 0 ? 1 + pick(3) : 1;
    for (int i = 0; i < several; ++i) one_change(e);
  }
  void one_change(Edit& e) {
    const CableHandle cable = some_cable();
    switch (pick(21)) {
      case 0:
      case 1:
        if (world_.cables().size() < 8) split(e, cable, 3);
        return;
      case 2:
      case 3:
        return e.join(cable, some_cable());
      case 4:
        return e.detach(cable, some_end());
      case 5:
      case 6:
      case 7:
        return tie(e, cable, some_end());
      case 8: {
        const int span = pick(3);
        return e.pay_out(cable, span, between(-0.2, 0.4));
      }
      case 9:
        return insert(e, cable);
      case 10:
        return e.remove_link(cable, 1 + pick(2));
      case 11:
      case 12: {  // an end goes elsewhere
        const CableEnd end = some_end();
        e.detach(cable, end);
        return tie(e, cable, end);
      }
      case 13:
      case 14:  // led over something, with enough for the way
        e.pay_out(cable, 0, between(1.0, 3.0));
        return insert(e, cable);
      case 15: {  // cut out of the middle, and spliced
        const CableHandle rest = split(e, cable, 2);
        return e.join(cable, rest);
      }
      case 16: {  // hauled in
        const int span = pick(2);
        return e.pay_out(cable, span, -between(0.0, 2.0));
      }
      case 17: {
        if (world_.cables().size() >= 8) return;
        CableDef belt = test::cable(
            new_name(), {test::roll(BodyId{0}, test::left), test::roll(BodyId{1}, test::left)});
        belt.closed = true;
        return static_cast<void>(e.add(belt));
      }
      case 18:  // a belt is opened and tied to something
        open(e, cable);
        for (const CableEnd end : {CableEnd::first, CableEnd::last}) tie(e, cable, end);
        return;
      case 19:
        open(e, cable);
        return e.join(cable, cable);
      default:
        return come_or_go(e, cable);
    }
  }
  // The draws are statements of their own: in which order arguments are evaluated is up to the
  // compiler.
  CableHandle split(Edit& e, CableHandle cable, int spans) {
    const int span = pick(spans);
    const double share = between(0.0, 1.0);
    return e.split(cable, span, share, new_name());
  }
  void open(Edit& e, CableHandle cable) {
    const int span = pick(3);
    e.open(cable, span, between(0.0, 1.0));
  }
  void tie(Edit& e, CableHandle cable, CableEnd end) {
    const BodyId body = some_body();
    e.attach(cable, end, body, place_on(body));
  }
  void insert(Edit& e, CableHandle cable) {
    const bool over_a_wheel = pick(2) == 0;
    const int span = pick(2);
    if (over_a_wheel) {
      const int wheel = pick(2);
      return e.insert(cable, span, test::roll(BodyId{wheel}, some_winding()));
    }
    auto eyelet = std::make_shared<PinholeLink>();
    eyelet->body = some_body();
    eyelet->point = place_on(eyelet->body);
    e.insert(cable, span, eyelet);
  }
  void come_or_go(Edit& e, CableHandle cable) {
    const int which = pick(5);
    if (which == 0 && world_.cables().size() > 4) return e.remove(cable);
    if (which == 1 && world_.cables().size() < 8) {
      const auto from = test::attach(BodyId::world(), somewhere());
      CableDef rope = test::cable(new_name(), {from, test::attach(some_body())});
      rope.rest_lengths = {between(4.0, 6.0)};
      e.add(rope);
    }
    if (which == 2 && world_.bodies().size() < 8) {
      BodyDef body = test::lump(new_name(), somewhere(), 0.5);
      body.damping = 3.0;
      e.add(body);
    }
    if (which == 3 && world_.bodies().size() > 4) {
      const std::vector<BodyHandle> all = world_.bodies();
      e.remove(all[at(pick(static_cast<int>(all.size())))]);
    }
  }
  [[nodiscard]] std::int64_t total() const {
    std::int64_t sum = 0;
    for (const CableHandle cable : world_.cables()) sum += units(*world_.length(cable));
    return sum;
  }

  std::mt19937_64 random_;
  LiveWorld world_;
  int names_ = 0;
  int edits_ = 0;
  int done_ = 0;
  int with_belts_ = 0;
  int doubtful_ = 0;
  std::string last_doubt_;
};

class EditProperty : public testing::TestWithParam<int> {};

TEST_P(EditProperty, LengthIsKeptToTheLastBit) {
  Editor editor(static_cast<std::uint64_t>(GetParam()));
  for (int i = 0; i < 11000; ++i) {
    editor.edit();
    if (i % 10 == 9) editor.step();
    if (HasFatalFailure()) FAIL() << "at edit " << i;
  }
  EXPECT_GT(editor.done(), 1500);
  EXPECT_GT(editor.with_belts(), 50);
  EXPECT_EQ(editor.doubtful(), 0) << editor.last_doubt();
}

// Under the sanitizers fuzz/ tries edits, too, and a seed takes a quarter of a minute.
INSTANTIATE_TEST_SUITE_P(Seeds, EditProperty, testing::Range(1, test::instrumented ? 3 : 11));

}  // namespace
}  // namespace sheave
