#include "engine/result.h"

#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace sheave {
namespace {

using testing::HasSubstr;

Result<int> half(int number) {
  if (number % 2 != 0) return Error{"/number", "the number is odd; even ones have halves"};
  return number / 2;
}

TEST(Result, AValueHasNoFaults) {
  EXPECT_TRUE(half(6).ok());
  EXPECT_EQ(half(6).value(), 3);
  EXPECT_TRUE(half(6).errors().empty());
}

TEST(Result, FaultsOfManyValuesAreCollected) {
  Errors faults;
  EXPECT_EQ(half(6).value(faults), 3);
  EXPECT_TRUE(faults.empty());
  EXPECT_EQ(half(5).value(faults), 0);
  EXPECT_EQ(half(7).value(faults), 0);
  ASSERT_EQ(faults.size(), 2U);
  EXPECT_EQ(faults[0].path, "/number");
}

// A std::bad_variant_access said nothing of the fault.
TEST(Result, AccessWithoutAValueThrowsItsFaults) {
  const Result<int> failed = half(5);
  try {
    (void)*failed;
    FAIL() << "a failure has no value";
  } catch (const std::logic_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("/number: the number is odd"));
  }
}

}  // namespace
}  // namespace sheave
