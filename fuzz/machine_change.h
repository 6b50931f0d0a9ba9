#pragma once

#include "tests/support/builders.h"
#include "tests/support/random.h"

namespace sheave::fuzz {

/// Changes one field of one entity of the machine by the field tables, or duplicates or removes an
/// entity.
void change_field(test::Random& random, test::Machine& machine);

}  // namespace sheave::fuzz
