#pragma once

#include <array>

#include "core/base/color.h"
#include "core/base/math.h"
#include "core/scene/description.h"
#include "core/scene/direction_table.h"
#include "core/scene/layer.h"

namespace lightvane {

class LayerShapes;

/// How layers are used: as printed, or with their directional albedo kept at or below 1 (1.001 counting the
/// tables' rounding).
///
/// Schlick's (1994): printed, the glossy term reflects more than its share b at grazing angles (1.3 b at r =
/// 0.1, cos = 0.01, the whole 1.1). Refined divides it by max(1, R(incoming), R(outgoing)), R being its
/// albedo over b: reciprocal, and at most b. R is taken with S = 1, that is, for the brightest colour: one
/// layer stays linear in its colour, whatever a texture says. Ggx: Smith's shadowing keeps one layer at or
/// below S by itself, under either rule.
///
/// Two layers can exceed 1 though neither does alone (at grazing angles the top one mirrors everything and
/// still lets light through at others): there the lobe's sum is scaled once more, for each colour channel, by
/// min over both directions of min(1, (1 - Dirac parts) / lobe's albedo).
///
/// MaterialDescription::diffuse lies under a single Ggx layer: under either rule kd is diffuse times what the
/// layer lets through on average, 1 minus the cosine-weighted mean of its albedo for its colour at the point.
/// The same for all directions, so that the part is Lambertian and light vectors serve it; where the layer
/// mirrors more than on average, at grazing angles, the sum exceeds 1 as printed, and refined the layer (its
/// Dirac part too) is scaled by min over both directions of min(1, (1 - kd) / layer's albedo), again for the
/// colours at the point. Beside any other layers diffuse is added as it is, and so are mirror and
/// transmission beside all: no rule mends their sum.
enum class EnergyRule { Printed, Refined };

/// What textures leave of a material's colours at one point: factors in [0, 1]. A Brdf's own colours are
/// those that its textures are multiplied by.
struct Tint {
  Rgb diffuse{1.0f};
  Rgb mirror{1.0f};
  Rgb transmission{1.0f};
  std::array<Rgb, 2> layers{Rgb(1.0f), Rgb(1.0f)};
};

/// The value of a lobe, linear in the colour of its (single) layer: f = color * perColor + constant, in
/// sr^-1, both for the colours of one point. Two-layer BRDFs put everything into `constant`.
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

/// A compiled material: the paper's eq. 2, f_r = f_r,s + f_r,d, with f_r,d split once more into a Lambertian
/// part (kd / pi) and a lobe (all the rest: the layers' non-specular terms).
///
/// Directions are local: unit vectors in a frame whose z is the surface's normal on the viewer's side,
/// pointing away from the surface; `incoming` is where light comes from, `outgoing` where it goes to.
/// Immutable, any thread.
class Brdf {
 public:
  /// Cost: builds the albedo tables that EnergyRule::Refined divides by (1 to 2 ms for an isotropic layer,
  /// 30 ms for an anisotropic one). The description's numbers must be in their ranges: the loader sees to
  /// that.
  static Brdf compile(const MaterialDescription& material, EnergyRule rule);
  /// The same, bit by bit; for many materials, which share `shapes`.
  static Brdf compile(const MaterialDescription& material, EnergyRule rule, LayerShapes& shapes);

  bool hasDiffuse() const { return hasDiffuse_; }    ///< a Lambertian part
  bool hasLobe() const { return hasLobe_; }          ///< a non-Lambertian, non-Dirac part
  bool hasSpecular() const { return hasSpecular_; }  ///< mirror, glass, or a lobe model's Dirac part
  bool isGlass() const { return isGlass_; }
  /// Glass that lets light pass straight, shadow rays too: a pane without thickness.
  bool isThin() const { return isThin_; }
  bool isAnisotropic() const { return isAnisotropic_; }
  /// Needs direct and indirect light at its surface at all.
  bool hasNonSpecular() const { return hasDiffuse_ || hasLobe_; }

  /// Lambertian reflectance kd; f = kd / pi. Less than the description's under a Ggx layer: see EnergyRule.
  Rgb diffuse(const Tint& tint = {}) const {
    const Rgb whole = diffuse_ * tint.diffuse;
    return coversDiffuse_ ? whole * (passed_ - takenPerTint_ * tint.layers[0]) : whole;
  }

  /// The lobe part of f_r,d for a pair of directions; zero where either is below the horizon.
  LobeValue lobe(const Vec3& incoming, const Vec3& outgoing, const Tint& tint = {}) const {
    if (!hasLobe_ || !(incoming.z > 0.0f) || !(outgoing.z > 0.0f)) return {};
    const DirectionPair pair(incoming, outgoing);
    const float top = layers_[0].value(pair);
    if (layerCount_ == 1) {
      const LobeValue value{Rgb(top * (1.0f - pair.fresnel)), Rgb(top * pair.fresnel)};
      if (!isLimited_) return value;
      const Rgb scale = layersScale(pair, tint);
      return {value.perColor * scale, value.constant * scale};
    }
    const Rgb topColor = schlickColor(layers_[0].color() * tint.layers[0], pair.fresnel);
    const Rgb lowerColor =
        (Rgb(1.0f) - topColor) * schlickColor(layers_[1].color() * tint.layers[1], pair.fresnel);
    Rgb f = topColor * top + lowerColor * layers_[1].value(pair);
    if (isLimited_) f *= layersScale(pair, tint);
    return {Rgb(0.0f), f};
  }
  /// The colour that LobeValue::perColor is multiplied by; black for two layers.
  const Rgb& lobeColor() const { return lobeColor_; }
  Rgb lobeRgb(const Vec3& incoming, const Vec3& outgoing, const Tint& tint = {}) const {
    const LobeValue value = lobe(incoming, outgoing, tint);
    return lobeColor_ * tint.layers[0] * value.perColor + value.constant;
  }
  /// Whether textures leave less of the lobe, or more, than is there without them.
  bool changesLobe(const Tint& tint) const {
    return tint.layers[0] != Rgb(1.0f) || tint.layers[1] != Rgb(1.0f) ||
           (isCoatLimited() && tint.diffuse != Rgb(1.0f));
  }
  /// What textures leave of the lobe for this pair of directions: its value with them over that without.
  /// Vectors keep what a lobe reflects free of textures, and this puts them back where light comes from about
  /// one direction.
  Rgb lobeShare(const Vec3& incoming, const Vec3& outgoing, const Tint& tint) const;
  /// The same where light comes from all around: by the lobe's albedos.
  Rgb lobeAlbedoShare(const Vec3& outgoing, const Tint& tint) const;
  /// f_r,d: Lambertian part and lobe together.
  Rgb evaluate(const Vec3& incoming, const Vec3& outgoing, const Tint& tint = {}) const {
    Rgb f = hasDiffuse_ && incoming.z > 0.0f && outgoing.z > 0.0f ? diffuse(tint) * kInvPi : Rgb(0.0f);
    if (hasLobe_) f += lobeRgb(incoming, outgoing, tint);
    return f;
  }

  /// An incoming direction for `outgoing`, with density lobePdf; z <= 0 means that the sample is lost (its
  /// weight is 0).
  Vec3 sampleLobe(const Vec3& outgoing, const Vec2& u) const;
  /// Density of sampleLobe, sr^-1 of incoming direction; positive wherever the lobe is, 0 below the horizon.
  float lobePdf(const Vec3& incoming, const Vec3& outgoing) const;

  /// Directions for f_r,d as a whole: the Lambertian part by cosine, the lobe by sampleLobe, mixed by their
  /// albedos.
  Vec3 sample(const Vec3& outgoing, const Vec2& u) const;
  float pdf(const Vec3& incoming, const Vec3& outgoing) const;

  /// The specular branches seen along `outgoing`: none, one (mirror, total internal reflection), or two
  /// (glass; the transmitted one last). Branches without weight are left out. `entering`: the viewer is on
  /// the surface's front side (outside of a glass body).
  ///
  /// Reflected: mirror + Fresnel's factor F where the material is glass + the layers' Dirac parts, S1(v) c1 +
  /// (1 - S1(v)) S2(v) c2. Transmitted: transmission (1 - F), without the factor n^2 of radiance: what rays
  /// carry here is basic radiance L / n^2 (Nicodemus 1963), which a refracting surface leaves alone. The
  /// factors of a path that enters and leaves a body cancel anyway; and inside, this keeps a uniform
  /// surrounding uniform, where L / n^2 is also what a Lambertian surface in the glass must see to reflect
  /// rho of it. The radiance of an emitter inside is likewise given as L / n^2.
  int specularBranches(const Vec3& outgoing, bool entering, const Tint& tint,
                       std::array<SpecularBranch, 2>& branches) const;

  /// The angle by which an outgoing direction may turn until the lobe looks different: about the lobe's half
  /// width, radians in (0, pi/2].
  float lobeHalfWidth() const { return lobeHalfWidth_; }

  /// Directional-hemispherical reflectance of f_r,d + f_r,s for light leaving along `outgoing`, by a
  /// quadrature of the lobe (milliseconds; for tests, tables and roulette). Glass: from outside, without what
  /// it transmits.
  Rgb directionalAlbedo(const Vec3& outgoing, const Tint& tint = {}) const;
  /// An upper bound of the non-specular albedo over all directions, for the material's own colours: for
  /// roulette and light bounds.
  const Rgb& nonSpecularAlbedoBound() const { return nonSpecularAlbedoBound_; }
  /// The same for the colours of one point.
  Rgb nonSpecularAlbedoBound(const Tint& tint) const;

 private:
  /// The parts of sampleLobe's density: the cosine, and each layer's half vectors, which add up to 1; and the
  /// part of all of these in sample's, beside the Lambertian one.
  struct Mixture {
    float lobe = 0.0f;
    float cosine = 0.0f;
    std::array<float, 2> halfVector{};
  };
  /// By what the layers are scaled: see EnergyRule. Where isLimited_.
  Rgb layersScale(const DirectionPair& pair, const Tint& tint) const {
    if (coversDiffuse_) return glm::min(coatScale(pair.incoming, tint), coatScale(pair.outgoing, tint));
    return glm::min(layersScale_.at(pair.incoming), layersScale_.at(pair.outgoing));
  }
  bool isCoatLimited() const { return coversDiffuse_ && isLimited_; }
  /// The same of a layer that covers a Lambertian part, for one direction.
  Rgb coatScale(const Vec3& direction, const Tint& tint) const;
  Mixture mixture(const Vec3& outgoing) const;
  Vec3 sampleLobe(const Mixture& shares, const Vec3& outgoing, const Vec2& u) const;
  float lobePdf(const Mixture& shares, const Vec3& incoming, const Vec3& outgoing) const;
  Rgb diracWeight(float cosine, const std::array<Rgb, 2>& tints) const;
  /// The lobe's albedo at most; before layersScale_.
  Rgb lobeAlbedoBound(const std::array<LayerMoments, 2>& moments, const std::array<Rgb, 2>& tints) const;
  void compileLayers(const MaterialDescription& material, EnergyRule rule, LayerShapes& shapes);
  void tabulateAlbedos(const MaterialDescription& material, EnergyRule rule, LayerShapes& shapes);
  /// By what two layers are scaled in the worst case of their textures: see EnergyRule.
  Rgb layersScaleFor(const MaterialTextures& textures, const std::array<LayerMoments, 2>& moments,
                     float cosine) const;
  /// A bound of the non-specular albedo, with what EnergyRule promises of a limited coat.
  Rgb limitedBound(const Rgb& bound) const;
  /// Fills the bounds of layers without a texture; returns the greatest bound.
  Rgb spreadAlbedoBounds(const MaterialTextures& textures);

  bool hasDiffuse_ = false;
  bool hasLobe_ = false;
  bool hasSpecular_ = false;
  bool isGlass_ = false;
  bool isThin_ = false;
  bool isAnisotropic_ = false;
  Rgb diffuse_{0.0f};
  Rgb mirror_{0.0f};
  Rgb transmission_{0.0f};
  float ior_ = 1.5f;
  int layerCount_ = 0;
  std::array<Layer, 2> layers_;
  bool coversDiffuse_ = false;  ///< a single Ggx layer that lies over a Lambertian part
  /// What it lets through on average is passed_ - takenPerTint_ times the tint of its colour.
  Rgb passed_{1.0f};
  Rgb takenPerTint_{0.0f};
  float diffuseShare_ = 0.0f;  ///< of the Lambertian part where samples are dealt out: about its albedo
  Rgb lobeColor_{0.0f};
  bool isLimited_ = false;           ///< something exceeds 1 without layersScale
  DirectionTable<Rgb> layersScale_;  ///< of two layers, where they are limited
  float lobeHalfWidth_ = 0.5f * kPi;
  Rgb nonSpecularAlbedoBound_{0.0f};
  /// The lobe's part of it, with the first layer's and the second layer's texture black (0) or white (1);
  /// equal where a layer has none.
  Rgb lobeAlbedoBounds_[2][2] = {{Rgb(0.0f), Rgb(0.0f)}, {Rgb(0.0f), Rgb(0.0f)}};
  /// Likewise the lobe's albedos, before coatScale; empty where neither that nor a texture asks for them.
  DirectionTable<Rgb> lobeAlbedos_[2][2];
};

/// Fresnel's reflectance of a dielectric for unpolarised light. `cosIncident` in [0, 1]; `eta` is the index
/// on the far side over that on the near side. 1 where all light is reflected; `cosTransmitted` is then 0.
float fresnelDielectric(float cosIncident, float eta, float& cosTransmitted);

}  // namespace lightvane
