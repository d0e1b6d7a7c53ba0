#pragma once

#include <cmath>

#include "core/base/math.h"

namespace lightvane {

// Angles in double where a library's own functions would call, branch, and give other bits on other machines:
// polynomials of fdlibm (Sun Microsystems, 1993), choices as values, so that loops over them are vectorised.

/// Sine and cosine of an angle between -pi / 2 and pi / 2, to 2^-52: at half the angle, then doubled.
[[gnu::always_inline]] inline void sinCosUpToRightAngle(double angle, double& sine, double& cosine) {
  const double x = 0.5 * angle;
  const double z = x * x;
  const double sinSeries =
      z * (-1.66666666666666324348e-01 +
           z * (8.33333333332248946124e-03 +
                z * (-1.98412698298579493134e-04 +
                     z * (2.75573137070700676789e-06 +
                          z * (-2.50507602534068634195e-08 + z * 1.58969099521155010221e-10)))));
  const double cosSeries =
      z * z *
      (4.16666666666666019037e-02 +
       z * (-1.38888888888741095749e-03 +
            z * (2.48015872894767294178e-05 +
                 z * (-2.75573143513906633035e-07 +
                      z * (2.08757232129817482790e-09 + z * -1.13596475577881948265e-11)))));
  const double s = x + x * sinSeries;
  const double c = 1.0 - (0.5 * z - cosSeries);
  sine = 2.0 * s * c;
  cosine = (c - s) * (c + s);
}

/// The angle of the vector (x, y), between -pi and pi, to 2^-51 of itself; 0 for the zero vector. Finite
/// coordinates only, and no sum of theirs beyond double.
[[gnu::always_inline]] inline double angleOf(double y, double x) {
  constexpr double kTanOfEighth = 0.41421356237309503;  // of a right angle's quarter
  constexpr double kHalfPi = 0.5 * kPiD, kQuarterPi = 0.25 * kPiD;
  // What kPiD has lost by rounding, for the quarter, half and whole.
  constexpr double kLost = 1.22464679914735317720e-16;
  const double absX = std::abs(x);
  const double absY = std::abs(y);
  const bool isSteep = absY > absX;
  const double larger = isSteep ? absY : absX;
  const double smaller = isSteep ? absX : absY;
  const bool isTurned = smaller > kTanOfEighth * larger;
  const double numerator = isTurned ? smaller - larger : smaller;
  const double denominator = isTurned ? smaller + larger : larger;
  const double t = denominator > 0.0 ? numerator / denominator : 0.0;
  const double z = t * t;
  const double w = z * z;
  const double even =
      z * (3.33333333333329318027e-01 +
           w * (1.42857142725034663711e-01 +
                w * (9.09088713343650656196e-02 +
                     w * (6.66107313738753120669e-02 +
                          w * (4.97687799461593236017e-02 + w * 1.62858201153657823623e-02)))));
  const double odd = w * (-1.99999999998764832476e-01 +
                          w * (-1.11111104054623557880e-01 +
                               w * (-7.69187620504482999495e-02 +
                                    w * (-5.83357013379057348645e-02 + w * -3.65315727442169155270e-02))));
  const double turned = t - t * (even + odd);
  const double low = isTurned ? kQuarterPi + (turned + 0.25 * kLost) : turned;
  const double acute = isSteep ? kHalfPi - (low - 0.5 * kLost) : low;
  return std::copysign(x < 0.0 ? kPiD - (acute - kLost) : acute, y);
}

}  // namespace lightvane
