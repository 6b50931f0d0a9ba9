// After FreeBSD's msun, e_atan2.c, e_exp.c, s_expm1.c and e_log.c, the source of the coefficients:
//
//   Copyright (C) 1993 by Sun Microsystems, Inc. All rights reserved.
//   Developed at SunPro, a Sun Microsystems, Inc. business.
//   Permission to use, copy, modify, and distribute this software is freely granted, provided that
//   this notice is preserved.

#include "engine/math/portable.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "engine/math/bits.h"

namespace sheave::portable {
namespace {

constexpr double ln2_high = 6.93147180369123816490e-01;  // its products with exponents are exact
constexpr double ln2_low = 1.90821492927058770002e-10;
constexpr double inverse_ln2 = 1.44269504088896338700e+00;
constexpr double infinity = std::numeric_limits<double>::infinity();

/// atan(t) for |t| <= 7/16, as high + low + t.
double arc(double t, double high, double low) {
  const double z = t * t;
  const double w = z * z;
  const double odd =
      z * (3.33333333333329318027e-01 +
           w * (1.42857142725034663711e-01 +
                w * (9.09088713343650656196e-02 +
                     w * (6.66107313738753120669e-02 +
                          w * (4.97687799461593236017e-02 + w * 1.62858201153657823623e-02)))));
  const double even =
      w * (-1.99999999998764832476e-01 +
           w * (-1.11111104054623557880e-01 +
                w * (-7.69187620504482999495e-02 +
                     w * (-5.83357013379057348645e-02 + w * -3.65315727442169155270e-02))));
  return high - ((t * (odd + even) - low) - t);
}

/// The angle of (x, y), where neither is below 0 and not both are 0.
double first_quadrant(double y, double x) {
  if (y < 0.4375 * x) return arc(y / x, 0.0, 0.0);
  // Differences of numbers of similar size are exact.
  if (y < 0.6875 * x) {
    return arc((2.0 * y - x) / (2.0 * x + y), 4.63647609000806093515e-01,
               2.26987774529616870924e-17);
  }
  if (y < 1.1875 * x) {
    return arc((y - x) / (y + x), 7.85398163397448278999e-01, 3.06161699786838301793e-17);
  }
  if (y < 2.4375 * x) {
    return arc((y - 1.5 * x) / (x + 1.5 * y), 9.82793723247329054082e-01,
               1.39033110312309984516e-17);
  }
  return arc(-x / y, 1.57079632679489655800e+00, 6.12323399573676603587e-17);
}

/// x times 2^power; the result may be subnormal or infinite.
double scaled(double x, int power) {
  const auto two_to = [](int n) { return double_of(static_cast<std::uint64_t>(1023 + n) << 52U); };
  if (power > 1023) return x * two_to(1023) * two_to(std::min(power - 1023, 1023));
  if (power < -1022) return x * two_to(power + 1000) * two_to(-1000);
  return x * two_to(power);
}

}  // namespace

double atan2(double y, double x) {
  if (std::isnan(x) || std::isnan(y)) return x + y;
  double a = std::abs(y);
  double b = std::abs(x);
  const double most = std::max(a, b);
  double angle = 0.0;
  if (most > 0.0) {
    if (most == infinity) {
      a = a == infinity ? 1.0 : 0.0;
      b = b == infinity ? 1.0 : 0.0;
    } else if (most > 1e300) {  // sums would overflow
      a *= 0x1p-10;
      b *= 0x1p-10;
    } else if (most < 1e-290) {  // comparisons would lose digits
      a *= 0x1p+60;
      b *= 0x1p+60;
    }
    angle = first_quadrant(a, b);
  }
  if (std::signbit(x)) {
    angle = 3.14159265358979311600e+00 - (angle - 1.22464679914735317720e-16);
  }
  return std::copysign(angle, y);
}

double exp(double x) {
  if (std::isnan(x)) return x;
  if (x > 709.782712893384) return infinity;
  if (x < -745.133219101942) return 0.0;
  const double power = std::floor(inverse_ln2 * x + 0.5);
  const double high = x - power * ln2_high;
  const double low = power * ln2_low;
  const double rest = high - low;
  const double t = rest * rest;
  const double c =
      rest - t * (1.66666666666666019037e-01 +
                  t * (-2.77777777770155933842e-03 +
                       t * (6.61375632143793436117e-05 +
                            t * (-1.65339022054652515390e-06 + t * 4.13813679705723846039e-08))));
  return scaled(1.0 - ((low - rest * c / (2.0 - c)) - high), static_cast<int>(power));
}

double expm1(double x) {
  if (!(std::abs(x) < 0.34)) return exp(x) - 1.0;
  // Without argument reduction: the sum of x, x^2 / 2 and a rational function for the rest.
  if (std::abs(x) < 0x1p-54) return x;
  const double half = 0.5 * x;
  const double square = x * half;
  const double r =
      1.0 + square * (-3.33333333333331316428e-02 +
                      square * (1.58730158725481460165e-03 +
                                square * (-7.93650757867487942473e-05 +
                                          square * (4.00821782732936239552e-06 +
                                                    square * -2.01099218183624371326e-07))));
  const double t = 3.0 - r * half;
  const double e = square * ((r - t) / (6.0 - x * t));
  return x - (x * e - square);
}

double log(double x) {
  if (std::isnan(x) || x == infinity) return x;
  if (x < 0.0) return std::numeric_limits<double>::quiet_NaN();
  if (x == 0.0) return -infinity;
  int power = 0;
  double mantissa = std::frexp(x, &power);  // in [1/2, 1)
  if (mantissa < 0.70710678118654752440) {
    mantissa *= 2.0;
    --power;
  }
  const double f = mantissa - 1.0;
  const double s = f / (2.0 + f);
  const double z = s * s;
  const double w = z * z;
  const double even = w * (3.999999999940941908e-01 +
                           w * (2.222219843214978396e-01 + w * 1.531383769920937332e-01));
  const double odd = z * (6.666666666666735130e-01 +
                          w * (2.857142874366239149e-01 +
                               w * (1.818357216161805012e-01 + w * 1.479819860511658591e-01)));
  const double half_square = 0.5 * f * f;
  const double turns = power;
  return turns * ln2_high -
         ((half_square - (s * (half_square + odd + even) + turns * ln2_low)) - f);
}

double hypot(double x, double y) {
  const double a = std::abs(x);
  const double b = std::abs(y);
  const double most = std::max(a, b);
  if (a == infinity || b == infinity) return infinity;
  if (most > 1e-140 && most < 1e140) return std::sqrt(a * a + b * b);
  if (most == 0.0 || std::isnan(a) || std::isnan(b)) return a + b;
  const double p = a / most;
  const double q = b / most;
  return most * std::sqrt(p * p + q * q);
}

}  // namespace sheave::portable
