#include "core/inspect/color_map.h"

#include <algorithm>
#include <cmath>

#include "core/base/color.h"

// Sources:
//   viridis: van der Walt & Smith, matplotlib 1.5, 2015 (CC0); polynomial fitted by M. Zucker,
//     https://www.shadertoy.com/view/WlfXRN (CC0), within 2/255 of the table.
//   cividis: Nunez, Anderton & Renslow, PLOS ONE 13(7), 2018; polynomial of d3-scale-chromatic (ISC), of the
//     table's encoded values from 0 to 255.
//   CIE L*a*b* and its white D65: CIE 15:2004.
//   seven colours: Okabe & Ito, "Color Universal Design", 2008.

namespace lightvane {
namespace {

using Table = std::array<Color8, 256>;

std::uint8_t toByte(double value) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 1.0) * 255.0));
}

/// c[0] + t c[1] + t^2 c[2] + ...
template <std::size_t N>
Vec3d polynomial(const std::array<Vec3d, N>& c, double t) {
  Vec3d value = c[N - 1];
  for (std::size_t i = N - 1; i-- > 0;) value = c[i] + t * value;
  return value;
}

Vec3d viridis(double t) {
  static constexpr std::array kCoefficients = {
      Vec3d(0.2777273272234177, 0.005407344544966578, 0.3340998053353061),
      Vec3d(0.1050930431085774, 1.404613529898575, 1.384590162594685),
      Vec3d(-0.3308618287255563, 0.214847559468213, 0.09509516302823659),
      Vec3d(-4.634230498983486, -5.799100973351585, -19.33244095627987),
      Vec3d(6.228269936347081, 14.17993336680509, 56.69055260068105),
      Vec3d(4.776384997670288, -13.74514537774601, -65.35303263337234),
      Vec3d(-5.435455855934631, 4.645852612178535, 26.3124352495832)};
  return polynomial(kCoefficients, t);
}

Vec3d cividis(double t) {
  static constexpr std::array kCoefficients = {
      Vec3d(-4.54, 32.49, 81.24),       Vec3d(-35.34, 170.73, 442.36),    Vec3d(2381.73, 52.82, -2482.43),
      Vec3d(-6402.7, -131.46, 6167.24), Vec3d(7024.72, 176.58, -6614.94), Vec3d(-2710.57, -67.37, 2475.67)};
  return polynomial(kCoefficients, t) / 255.0;
}

/// sRGB of a colour in CIE L*a*b*.
Vec3d srgbOfLab(const Vec3d& lab) {
  const double fy = (lab.x + 16.0) / 116.0;
  const auto inverse = [](double f) { return f > 6.0 / 29.0 ? f * f * f : (f - 4.0 / 29.0) * 108.0 / 841.0; };
  const double x = 0.95047 * inverse(fy + lab.y / 500.0);
  const double y = inverse(fy);
  const double z = 1.08883 * inverse(fy - lab.z / 200.0);
  const Vec3d linear(3.2404542 * x - 1.5371385 * y - 0.4985314 * z,
                     -0.9692660 * x + 1.8760108 * y + 0.0415560 * z,
                     0.0556434 * x - 0.2040259 * y + 1.0572252 * z);
  return {encodeSrgb(static_cast<float>(linear.r)), encodeSrgb(static_cast<float>(linear.g)),
          encodeSrgb(static_cast<float>(linear.b))};
}

/// Straight in L*a*b* from a nearly white grey to a blue and an orange of the same lightness, so that both
/// signs of a number weigh the same. Blue against orange is the pair that protanopes and deuteranopes tell
/// apart.
Vec3d diverging(double t) {
  constexpr Vec3d kMiddle(95.0, 0.0, 0.0);
  constexpr Vec3d kBlue(45.0, -2.0, -44.0);
  constexpr Vec3d kOrange(45.0, 40.0, 54.0);
  const double side = 2.0 * t - 1.0;
  const Vec3d& end = side < 0.0 ? kBlue : kOrange;
  return srgbOfLab(kMiddle + std::abs(side) * (end - kMiddle));
}

template <class Map>
Table makeTable(const Map& map) {
  Table table;
  for (std::size_t i = 0; i < table.size(); ++i) {
    const Vec3d color = map(static_cast<double>(i) / 255.0);
    table[i] = {toByte(color.r), toByte(color.g), toByte(color.b)};
  }
  return table;
}

}  // namespace

std::span<const Color8, 256> colorTable(ColorMap map) {
  static const Table kGrey = makeTable([](double t) { return Vec3d(t); });
  static const Table kViridis = makeTable(viridis);
  static const Table kCividis = makeTable(cividis);
  static const Table kDiverging = makeTable(diverging);
  switch (map) {
    case ColorMap::Grey:
      return kGrey;
    case ColorMap::Viridis:
      return kViridis;
    case ColorMap::Cividis:
      return kCividis;
    case ColorMap::Diverging:
      return kDiverging;
  }
  return kGrey;
}

Color8 colorAt(ColorMap map, float position) {
  const float clamped = position > 0.0f ? std::min(position, 1.0f) : 0.0f;  // NaN is 0
  return colorTable(map)[static_cast<std::size_t>(std::lround(clamped * 255.0f))];
}

Color8 categoryColor(ColorFamily family, std::size_t index) {
  // Those of Okabe & Ito but for black, as most pictures are dark, and one more each, as far from all of them
  // as there are.
  static constexpr Color8 kWarm[] = {
      {230, 159, 0}, {204, 121, 167}, {213, 94, 0}, {240, 228, 66}, {255, 255, 180}};
  static constexpr Color8 kCool[] = {{86, 180, 233}, {0, 158, 115}, {0, 114, 178}, {105, 75, 255}};
  return family == ColorFamily::Warm ? kWarm[index % std::size(kWarm)] : kCool[index % std::size(kCool)];
}

}  // namespace lightvane
