#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/color.h"
#include "core/base/error.h"
#include "core/base/math.h"
#include "core/scene/description.h"

namespace lightvane {

/// How Schlick's BRDF is used: as printed in 1994, or with its directional albedo kept at or below 1.
enum class EnergyRule { Printed, Refined };

/// The value of a lobe, linear in the colour of its (single) layer: f = color * perColor + constant, in sr^-1.
/// Kept apart so that a texture can drive the colour. Two-layer BRDFs put everything into `constant`.
struct LobeValue {
  Rgb perColor{0.0f};
  Rgb constant{0.0f};
};

/// One outgoing branch of a purely specular event.
struct SpecularBranch {
  Vec3 direction{0.0f};  ///< local, unit
  Rgb weight{0.0f};      ///< what the radiance from there is multiplied by
  bool transmitted = false;
};

/// A compiled material: the paper's eq. 2, f_r = f_r,s + f_r,d, with f_r,d split once more into a Lambertian part
/// (kd / pi) and a lobe (all the rest: Schlick's non-specular terms).
///
/// Directions are local: unit vectors in a frame whose z is the surface's normal on the viewer's side, pointing away
/// from the surface; `incoming` is where light comes from, `outgoing` where it goes to. Immutable, any thread.
class Brdf {
 public:
  /// Cost: builds the albedo tables that EnergyRule::Refined divides by (a few milliseconds for each glossy material).
  static Brdf compile(const MaterialDescription& material, EnergyRule rule);

  bool hasDiffuse() const { return hasDiffuse_; }    ///< a Lambertian part
  bool hasLobe() const { return hasLobe_; }          ///< a non-Lambertian, non-Dirac part
  bool hasSpecular() const { return hasSpecular_; }  ///< mirror, glass, or a lobe model's Dirac part
  bool isGlass() const { return isGlass_; }
  bool isAnisotropic() const { return isAnisotropic_; }
  /// Needs direct and indirect light at its surface at all.
  bool hasNonSpecular() const { return hasDiffuse_ || hasLobe_; }

  /// Lambertian reflectance kd; f = kd / pi.
  const Rgb& diffuse() const { return diffuse_; }

  /// The lobe part of f_r,d for a pair of directions on the same side; zero where either is below the horizon.
  LobeValue lobe(const Vec3& incoming, const Vec3& outgoing) const;
  /// The colour that LobeValue::perColor is multiplied by.
  const Rgb& lobeColor() const { return lobeColor_; }
  Rgb lobeRgb(const Vec3& incoming, const Vec3& outgoing) const {
    const LobeValue value = lobe(incoming, outgoing);
    return lobeColor_ * value.perColor + value.constant;
  }
  /// f_r,d: Lambertian part and lobe together.
  Rgb evaluate(const Vec3& incoming, const Vec3& outgoing) const {
    Rgb f = hasDiffuse_ && incoming.z > 0.0f && outgoing.z > 0.0f ? diffuse_ * kInvPi : Rgb(0.0f);
    if (hasLobe_) f += lobeRgb(incoming, outgoing);
    return f;
  }

  /// An incoming direction for `outgoing`, with density lobePdf; z <= 0 means that the sample is lost (its weight is 0).
  Vec3 sampleLobe(const Vec3& outgoing, const Vec2& u) const;
  /// Density of sampleLobe, sr^-1 of incoming direction.
  float lobePdf(const Vec3& incoming, const Vec3& outgoing) const;

  /// Directions for f_r,d as a whole: the Lambertian part by cosine, the lobe by sampleLobe, mixed by their albedos.
  Vec3 sample(const Vec3& outgoing, const Vec2& u) const;
  float pdf(const Vec3& incoming, const Vec3& outgoing) const;

  /// The specular branches seen along `outgoing`: none, one (mirror, total internal reflection), or two (glass).
  /// `entering`: the viewer is on the surface's front side (outside of a glass body).
  int specularBranches(const Vec3& outgoing, bool entering, std::array<SpecularBranch, 2>& branches) const;

  /// The angle by which an outgoing direction may turn until the lobe looks different: about the lobe's half width,
  /// radians in (0, pi/2].
  float lobeHalfWidth() const { return lobeHalfWidth_; }

  /// Directional-hemispherical reflectance of f_r,d + f_r,s for light leaving along `outgoing`, by a quadrature of
  /// the lobe (slow; for tests, tables and roulette).
  Rgb directionalAlbedo(const Vec3& outgoing) const;
  /// An upper bound of the non-specular albedo over all directions: for roulette and light bounds.
  const Rgb& nonSpecularAlbedoBound() const { return nonSpecularAlbedoBound_; }

 private:
  bool hasDiffuse_ = false;
  bool hasLobe_ = false;
  bool hasSpecular_ = false;
  bool isGlass_ = false;
  bool isAnisotropic_ = false;
  Rgb diffuse_{0.0f};
  Rgb mirror_{0.0f};
  Rgb transmission_{0.0f};
  float ior_ = 1.5f;
  Rgb lobeColor_{0.0f};
  float lobeHalfWidth_ = 0.5f * kPi;
  Rgb nonSpecularAlbedoBound_{0.0f};
};

/// Fresnel's reflectance of a dielectric for unpolarised light. `cosIncident` in [0, 1]; `eta` is the index on the far
/// side over that on the near side. 1 where all light is reflected; `cosTransmitted` is then 0.
float fresnelDielectric(float cosIncident, float eta, float& cosTransmitted);

}  // namespace lightvane
