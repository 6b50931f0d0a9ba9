#pragma once

#include "tests/support/builders.h"
#include "tests/support/random.h"

namespace sheave::fuzz {

/// Gives one field of one thing of the machine another value, by the field tables, or repeats or
/// removes a thing.
void change_field(test::Random& random, test::Machine& machine);

}  // namespace sheave::fuzz
