#include "engine/field.h"

#include <array>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace sheave {
namespace {

constexpr double endless = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double largest = std::numeric_limits<double>::max();
constexpr double smallest = std::numeric_limits<double>::denorm_min();

TEST(Range, NeverContainsNonFiniteNumbers) {
  for (const Range range : {any_number(), at_least(0.0), above(0.0), between(-1.0, 1.0),
                            Range{.minimum = -endless, .maximum = endless}}) {
    EXPECT_FALSE(range.contains(nan));
    EXPECT_FALSE(range.contains(-nan));
    EXPECT_FALSE(range.contains(endless));
    EXPECT_FALSE(range.contains(-endless));
  }
}

TEST(Range, AnyNumberHasNoBounds) {
  for (const double value : {-largest, -1.0, -0.0, 0.0, smallest, largest}) {
    EXPECT_TRUE(any_number().contains(value)) << value;
  }
}

TEST(Range, AtLeastContainsItsBound) {
  EXPECT_TRUE(at_least(0.0).contains(0.0));
  EXPECT_TRUE(at_least(0.0).contains(-0.0));
  EXPECT_TRUE(at_least(0.0).contains(largest));
  EXPECT_FALSE(at_least(0.0).contains(-smallest));
  EXPECT_TRUE(at_least(2.0).contains(2.0));
  EXPECT_FALSE(at_least(2.0).contains(std::nextafter(2.0, 0.0)));
}

TEST(Range, AboveExcludesItsBound) {
  EXPECT_FALSE(above(0.0).contains(0.0));
  EXPECT_FALSE(above(0.0).contains(-0.0));
  EXPECT_TRUE(above(0.0).contains(smallest));
  EXPECT_FALSE(above(2.0).contains(2.0));
  EXPECT_TRUE(above(2.0).contains(std::nextafter(2.0, 3.0)));
}

TEST(Range, BetweenContainsBothBounds) {
  const Range range = between(-1.0, 0.3);
  EXPECT_TRUE(range.contains(-1.0));
  EXPECT_TRUE(range.contains(0.3));
  EXPECT_FALSE(range.contains(std::nextafter(-1.0, -2.0)));
  EXPECT_FALSE(range.contains(std::nextafter(0.3, 1.0)));
}

TEST(Range, UpperBoundCanBeExcluded) {
  const Range range{.minimum = 0.0, .maximum = 1.0, .maximum_allowed = false};
  EXPECT_TRUE(range.contains(0.0));
  EXPECT_TRUE(range.contains(std::nextafter(1.0, 0.0)));
  EXPECT_FALSE(range.contains(1.0));
}

enum class Mode { off, slow, fast };

/// One member of every kind, and two of one kind that must not be mixed up.
struct Sample {
  double number = 1.5;
  double other_number = 2.5;
  int count = 3;
  bool flag = true;
  std::string text = "text";
  Vector3 vector = Vector3(1.0, 2.0, 3.0);
  Quaternion rotation = Quaternion::Identity();
  BodyId body{4};
  std::optional<double> maybe_number;
  std::optional<Vector3> maybe_vector;
  std::optional<BodyId> maybe_body;
  std::vector<double> numbers{1.0, 2.0};
  std::vector<Vector3> vectors{Vector3::UnitX()};
  Mode mode = Mode::slow;

  static constexpr std::array<std::string_view, 3> modes{"off", "slow", "fast"};
  static std::span<const Field> field_table() {
    static constexpr std::array table{
        field<&Sample::number>("number", "m", above(0.0), required, "a number"),
        field<&Sample::other_number>("other_number", "kg", any_number(), optional, "another"),
        choice_field<&Sample::mode>("mode", modes, optional, "a choice"),
    };
    return table;
  }
};

template <auto Member>
FieldSlot slot_of(Sample& sample) {
  return field<Member>("name", "", any_number(), optional, "").slot(&sample);
}

template <auto Member>
void expect_reaches_member(Sample& sample) {
  using Type = decltype(detail::member_of(Member));
  const FieldSlot slot = slot_of<Member>(sample);
  ASSERT_TRUE(std::holds_alternative<Type*>(slot));
  EXPECT_EQ(std::get<Type*>(slot), &(sample.*Member));
}

TEST(FieldSlot, ReachesTheMemberOfEveryKind) {
  Sample sample;
  expect_reaches_member<&Sample::number>(sample);
  expect_reaches_member<&Sample::other_number>(sample);
  expect_reaches_member<&Sample::count>(sample);
  expect_reaches_member<&Sample::flag>(sample);
  expect_reaches_member<&Sample::text>(sample);
  expect_reaches_member<&Sample::vector>(sample);
  expect_reaches_member<&Sample::rotation>(sample);
  expect_reaches_member<&Sample::body>(sample);
  expect_reaches_member<&Sample::maybe_number>(sample);
  expect_reaches_member<&Sample::maybe_vector>(sample);
  expect_reaches_member<&Sample::maybe_body>(sample);
  expect_reaches_member<&Sample::numbers>(sample);
  expect_reaches_member<&Sample::vectors>(sample);
}

TEST(FieldSlot, WritesToTheGivenObjectOnly) {
  Sample one;
  Sample two;
  *std::get<double*>(slot_of<&Sample::number>(one)) = 9.0;
  EXPECT_EQ(one.number, 9.0);
  EXPECT_EQ(one.other_number, 2.5);
  EXPECT_EQ(two.number, 1.5);
}

struct Before {
  double before = 0.5;
};
/// Its part that is a Sample does not lie at its own address.
struct Extended : Before, Sample {
  double own = 3.5;
};

TEST(FieldSlot, ReachesAMemberThatComesFromABase) {
  Extended extended;
  void* object = &extended;
  const Field number =
      field<&Sample::number, Extended>("number", "m", any_number(), optional, "a number");
  EXPECT_EQ(std::get<double*>(number.slot(object)), &extended.number);
  const Field mode =
      choice_field<&Sample::mode, Extended>("mode", Sample::modes, optional, "a choice");
  const ChoiceSlot slot = std::get<ChoiceSlot>(mode.slot(object));
  slot.set(slot.object, 2);
  EXPECT_EQ(extended.mode, Mode::fast);
  EXPECT_EQ(slot.get(slot.object), 2);
}

TEST(FieldTable, JoinsInOrder) {
  constexpr std::array table =
      joined(std::array{field<&Sample::count>("count", "", any_number(), optional, "a count")},
             std::array{field<&Sample::flag>("flag", "", {}, optional, "a flag"),
                        field<&Sample::text>("text", "", {}, optional, "a text")});
  ASSERT_EQ(table.size(), 3U);
  EXPECT_EQ(table[0].name, "count");
  EXPECT_EQ(table[1].name, "flag");
  EXPECT_EQ(table[2].name, "text");
}

TEST(FieldTable, KeepsItsFields) {
  const std::span<const Field> table = Sample::field_table();
  ASSERT_EQ(table.size(), 3U);
  EXPECT_EQ(table[0].name, "number");
  EXPECT_EQ(table[0].unit, "m");
  EXPECT_EQ(table[0].presence, Presence::required);
  EXPECT_EQ(table[0].meaning, "a number");
  EXPECT_FALSE(table[0].range.contains(0.0));
  EXPECT_TRUE(table[0].choices.empty());
  EXPECT_EQ(table[1].presence, Presence::optional);
  EXPECT_EQ(table[2].choices.size(), 3U);
  EXPECT_EQ(table[2].choices[2], "fast");
  Sample sample;
  EXPECT_EQ(std::get<double*>(table[1].slot(&sample)), &sample.other_number);
}

TEST(ChoiceField, GetsAndSetsTheEnumerationByIndex) {
  Sample sample;
  const ChoiceSlot slot = std::get<ChoiceSlot>(Sample::field_table()[2].slot(&sample));
  EXPECT_EQ(slot.object, &sample);
  EXPECT_EQ(slot.get(slot.object), 1);
  slot.set(slot.object, 2);
  EXPECT_EQ(sample.mode, Mode::fast);
  EXPECT_EQ(slot.get(slot.object), 2);
  slot.set(slot.object, 0);
  EXPECT_EQ(sample.mode, Mode::off);
  EXPECT_EQ(sample.number, 1.5);
}

struct Picky {
  std::optional<Mode> mode;
};

TEST(ChoiceField, OfAnOptionalEnumerationMayHaveNoValue) {
  Picky picky;
  const Field field = choice_field<&Picky::mode>("mode", Sample::modes, optional, "a choice");
  const ChoiceSlot slot = std::get<ChoiceSlot>(field.slot(&picky));
  EXPECT_TRUE(slot.may_be_absent);
  EXPECT_EQ(slot.get(slot.object), ChoiceSlot::absent);
  slot.set(slot.object, 2);
  EXPECT_EQ(picky.mode, Mode::fast);
  EXPECT_EQ(slot.get(slot.object), 2);
  slot.set(slot.object, ChoiceSlot::absent);
  EXPECT_EQ(picky.mode, std::nullopt);
  Sample sample;
  EXPECT_FALSE(std::get<ChoiceSlot>(Sample::field_table()[2].slot(&sample)).may_be_absent);
}

struct Base {
  virtual ~Base() = default;
};
struct Derived final : Base {
  double padding = 0.0;
  double number = 7.0;
  static constexpr std::string_view type_name = "derived";
  static constexpr std::string_view type_meaning = "a derived type";
  static std::span<const Field> field_table() {
    static constexpr std::array table{
        field<&Derived::number>("number", "m", above(0.0), required, "a number")};
    return table;
  }
};

TEST(TypeEntry, MakesObjectsWithDefaultSettings) {
  const TypeEntry<Base> entry = type_entry<Base, Derived>();
  EXPECT_EQ(entry.name, "derived");
  EXPECT_EQ(entry.meaning, "a derived type");
  const std::unique_ptr<Base> made = entry.make();
  auto* derived = dynamic_cast<Derived*>(made.get());
  ASSERT_NE(derived, nullptr);
  ASSERT_EQ(entry.fields().size(), 1U);
  EXPECT_EQ(std::get<double*>(entry.fields()[0].slot(derived)), &derived->number);
  EXPECT_EQ(*std::get<double*>(entry.fields()[0].slot(derived)), 7.0);
}

}  // namespace
}  // namespace sheave
