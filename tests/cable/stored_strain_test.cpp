// Cable on a drum keeps the strain with which it came, last in, first out (cable/stored_strain.h).

#include "cable/stored_strain.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "engine/vector.h"

namespace sheave {
namespace {

using End = StoredStrain::End;

const StrainEnergy constant;  // of a constant EA

/// Strain of the cable at `x` of 1 m that comes on.
double load_at(double x, int swings) { return 0.01 * (2.0 + std::sin(2.0 * pi * swings * x)); }

/// Largest difference of the strain of cable that comes off from that with which it came on, relative
/// to the range of the strains; means over a hundredth of the cable.
double error_after(int steps, int swings, End on, End off) {
  StoredStrain drum;
  for (int i = 0; i < steps; ++i)
    drum.put(on, 1.0 / steps, load_at((i + 0.5) / steps, swings), constant);
  double worst = 0.0;
  constexpr int parts = 100;
  for (int k = 0; k < parts; ++k) {
    const double middle = (k + 0.5) / parts;
    const double came = load_at(on == off ? 1.0 - middle : middle, swings);
    worst = std::max(worst, std::abs(drum.take(off, 1.0 / parts, constant).strain() - came));
  }
  return worst / 0.02;
}

TEST(StoredStrain, ComesOffAsItCameOnWhateverTheStep) {
  // A straight line over a sixteenth of a swing is off by (2 pi / 16)^2 / 16 of the amplitude, and
  // the pieces are not equally long; one mean per piece would be off by 2 pi / 32.
  for (const auto& [on, off] :
       {std::pair{End::outgoing, End::outgoing}, std::pair{End::outgoing, End::incoming},
        std::pair{End::incoming, End::incoming}}) {
    for (const int steps : {100, 1000, 30000}) {
      EXPECT_LT(error_after(steps, 1, on, off), 0.02) << steps;
      EXPECT_LT(error_after(steps, 2, on, off), 0.06) << steps;
      EXPECT_LT(error_after(steps, 5, on, off), 0.16) << steps;
    }
  }
}

TEST(StoredStrain, JumpsStayWhereTheyAre) {
  StoredStrain drum;
  drum.put(End::incoming, 90.0, 0.0, constant);
  for (int i = 0; i < 1000; ++i) drum.put(End::incoming, 0.01, 0.02 + 1e-5 * (i % 2), constant);
  const StoredStrain::Piece off = drum.take(End::incoming, 10.0, constant);
  EXPECT_NEAR(off.strain(), 0.020005, 1e-12);
  EXPECT_NEAR(drum.total().stretch, 0.0, 1e-12);
}

TEST(StoredStrain, KeepsArcAndEnergy) {
  StoredStrain drum;
  double length = 0.0;
  double stretch = 0.0;
  double square = 0.0;
  for (int i = 0; i < 500; ++i) {
    const double part = 0.01 * (1.0 + 0.5 * std::cos(7.0 * i));
    const double strain = load_at(0.003 * i, 3);
    drum.put(i % 3 == 0 ? End::incoming : End::outgoing, part, strain, constant);
    length += part;
    stretch += part * strain;
    square += part * strain * strain;
  }
  const StoredStrain::Piece all = drum.total();
  constexpr double rounding = 500 * 4e-16;
  EXPECT_NEAR(all.length, length, rounding * length);
  EXPECT_NEAR(all.stretch, stretch, rounding * stretch);
  EXPECT_NEAR(all.square, square, rounding * square);
  // In parts, from both ends, none of which has less energy than its mean strain.
  StoredStrain::Piece sum;
  for (int i = 0; drum.total().length > 0.0 && i < 10000; ++i) {
    const End end = i % 2 == 0 ? End::incoming : End::outgoing;
    const StoredStrain::Piece off = drum.take(end, 0.0037, constant);
    EXPECT_GE(off.square, off.stretch * off.strain() * (1.0 - 1e-9));
    sum.length += off.length;
    sum.stretch += off.stretch;
    sum.square += off.square;
  }
  EXPECT_NEAR(sum.length, length, 1e-11 * length);
  EXPECT_NEAR(sum.stretch, stretch, 1e-11 * stretch);
  EXPECT_NEAR(sum.square, square, 1e-11 * square);
}

TEST(StoredStrain, CoversItsArcFromBothEnds) {
  StoredStrain drum;
  for (int i = 0; i < 300; ++i) drum.put(End::outgoing, 0.01, load_at(i / 300.0, 1), constant);
  const double arc = drum.total().length + drum.total().stretch;
  for (double share = 0.05; share < 1.0; share += 0.1) {
    const double first = drum.rest_of(End::incoming, share * arc, 0.0);
    EXPECT_NEAR(first + drum.rest_of(End::outgoing, (1.0 - share) * arc, 0.0), drum.total().length,
                1e-12);
    StoredStrain copy = drum;
    const StoredStrain::Piece off = copy.take(End::incoming, first, constant);
    EXPECT_NEAR(off.length + off.stretch, share * arc, 1e-12);
  }
}

TEST(StoredStrain, IsTheSameAfterSaving) {
  StoredStrain drum;
  for (int i = 0; i < 300; ++i) drum.put(End::outgoing, 0.01, load_at(i / 300.0, 1), constant);
  std::array<double, StoredStrain::real_count> saved{};
  drum.save(saved);
  StoredStrain again(saved);
  for (int i = 0; i < 40; ++i) {
    const StoredStrain::Piece a = drum.take(End::outgoing, 0.07, constant);
    const StoredStrain::Piece b = again.take(End::outgoing, 0.07, constant);
    EXPECT_EQ(a.stretch, b.stretch);
    EXPECT_EQ(a.square, b.square);
  }
}

TEST(StoredStrain, WithATableOfTensionsKeepsEnergyAndComesOffTheSame) {
  // T = 1000 N e (1 + 50 e): three times as stiff at 0.02, and a table that bends as much.
  CableDef cable;
  for (int i = 0; i <= 20; ++i) {
    const double e = 0.002 * i;
    cable.strain_table.push_back(e);
    cable.tension_table.push_back(1000.0 * e * (1.0 + 50.0 * e));
  }
  const TensionLaw law(cable);
  const StrainEnergy energy(law, 1.0 / law.scale());
  StoredStrain drum;
  double square = 0.0;
  constexpr int steps = 3000;
  for (int i = 0; i < steps; ++i) {
    const double strain = load_at((i + 0.5) / steps, 1);
    drum.put(End::outgoing, 1.0 / steps, strain, energy);
    square += energy.of(strain) / steps;
  }
  EXPECT_NEAR(drum.total().square, square, 1e-12 * square);
  double sum = 0.0;
  constexpr int parts = 100;
  for (int k = 0; k < parts; ++k) {
    const StoredStrain::Piece off = drum.take(End::outgoing, 1.0 / parts, energy);
    EXPECT_NEAR(off.strain(), load_at(1.0 - (k + 0.5) / parts, 1), 0.02 * 0.02);
    // The energy is convex, so that of the mean strain is the least; the expansion leaves out terms
    // of third order, of strains that differ by a sixteenth of 0.02 in a piece.
    const double least = energy.of(off.strain()) * off.length;
    EXPECT_GT(off.square, least * (1.0 - 1e-3));
    sum += off.square;
  }
  EXPECT_NEAR(sum, square, 1e-12 * square);
}

}  // namespace
}  // namespace sheave
