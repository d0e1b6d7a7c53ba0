#include "core/scene/brdf.h"

#include "core/base/check.h"
#include "core/scene/layer_shapes.h"

namespace lightvane {
namespace {

// The mean of (1 - u)^5 over a cosine-weighted hemisphere: what a rough layer's Fresnel factor comes to.
constexpr float kMeanFresnel = 1.0f / 21.0f;

// Between a table's nodes, and by the quadrature's 1 %, albedos may be a little higher.
constexpr float kBoundMargin = 1.02f;

// A sample without a direction.
constexpr Vec3 kLost(0.0f, 0.0f, -1.0f);

// The number in [0, 1) that `x` is within the interval of [from, from + width) it has been found in.
float rescale(float x, float from, float width) {
  return std::clamp((x - from) / width, 0.0f, 0x1.fffffep-1f);
}

void checkColor(const char* what, const std::string& material, const Rgb& color) {
  LV_CHECK(isValidSample(color) && maxComponent(color) <= 1.0f, "material '{}': {} = {}, {}, {}", material,
           what, color.r, color.g, color.b);
}

// The albedo of (1 - S1) f2 without Dirac parts, from the moments of f2 without its S2. With F = (1 - u)^5:
// S1 = C1 + (1 - C1) F, and (1 - S1) S2 = (1 - C1) (C2 + (1 - 2 C2) F - (1 - C2) F^2).
Rgb lowerAlbedo(const Rgb& c1, const Rgb& c2, const LayerMoments& m) {
  return (Rgb(1.0f) - c1) *
         (c2 * static_cast<float>(m[0]) + (Rgb(1.0f) - 2.0f * c2) * static_cast<float>(m[1]) -
          (Rgb(1.0f) - c2) * static_cast<float>(m[2]));
}

/// Calls visit(first, second, tints) with each layer's texture black (0), where it has one, and white (1).
template <class Visit>
void forTints(const MaterialTextures& textures, const Visit& visit) {
  for (int first = textures.layers[0] ? 0 : 1; first < 2; ++first) {
    for (int second = textures.layers[1] ? 0 : 1; second < 2; ++second)
      visit(first, second,
            std::array<Rgb, 2>{Rgb(static_cast<float>(first)), Rgb(static_cast<float>(second))});
  }
}

/// What is linear in each layer's colour by itself, from its values with either texture black (0) or white
/// (1).
Rgb mixLayers(const Tint& tint, const Rgb& v00, const Rgb& v01, const Rgb& v10, const Rgb& v11) {
  const auto& [first, second] = tint.layers;
  return glm::mix(glm::mix(v00, v01, second), glm::mix(v10, v11, second), first);
}

/// By what an albedo must be scaled so that nothing is above 1 with what else is reflected.
Rgb scaledToFit(const Rgb& albedo, const Rgb& other) {
  constexpr float kMargin = 0.999f;  // against interpolation, as in SchlickLayer's table
  const Rgb rest = glm::max(Rgb(1.0f) - other, 0.0f) * kMargin;
  Rgb factor(1.0f);
  for (int c = 0; c < 3; ++c) {
    if (albedo[c] > rest[c]) factor[c] = rest[c] / albedo[c];
  }
  return factor;
}

Rgb dividedWhereLit(const Rgb& a, const Rgb& b) {
  Rgb quotient(0.0f);
  for (int c = 0; c < 3; ++c) quotient[c] = b[c] > 0.0f ? a[c] / b[c] : 0.0f;
  return quotient;
}

}  // namespace

Brdf Brdf::compile(const MaterialDescription& material, EnergyRule rule) {
  LayerShapes shapes;
  return compile(material, rule, shapes);
}

Brdf Brdf::compile(const MaterialDescription& material, EnergyRule rule, LayerShapes& shapes) {
  checkColor("diffuse", material.name, material.diffuse);
  checkColor("mirror", material.name, material.mirror);
  checkColor("transmission", material.name, material.transmission);
  LV_CHECK(std::isfinite(material.ior) && material.ior > 0.0, "material '{}': ior = {}", material.name,
           material.ior);
  LV_CHECK(material.layers.size() <= 2, "material '{}': {} layers", material.name, material.layers.size());

  Brdf brdf;
  brdf.diffuse_ = material.diffuse;
  brdf.mirror_ = material.mirror;
  brdf.transmission_ = material.transmission;
  brdf.ior_ = static_cast<float>(material.ior);
  brdf.isGlass_ = material.isGlass();
  brdf.isThin_ = brdf.isGlass_ && material.thin;
  brdf.hasSpecular_ = brdf.isGlass_ || !isBlack(material.mirror);
  brdf.compileLayers(material, rule, shapes);
  return brdf;
}

void Brdf::compileLayers(const MaterialDescription& material, EnergyRule rule, LayerShapes& shapes) {
  for (const LayerDescription& description : material.layers) {
    checkColor("layer color", material.name, description.color);
    Layer& layer = layers_[static_cast<std::size_t>(layerCount_++)];
    layer = shapes.layer(description, rule == EnergyRule::Refined);
    hasSpecular_ = hasSpecular_ || layer.diracShare() > 0.0f;
    hasLobe_ = hasLobe_ || layer.diracShare() < 1.0f;
    isAnisotropic_ = isAnisotropic_ || layer.isAnisotropic();
    if (layer.hasGlossy()) lobeHalfWidth_ = std::min(lobeHalfWidth_, layer.halfWidth());
  }
  coversDiffuse_ = layerCount_ == 1 && layers_[0].isGgx() && !isBlack(diffuse_);
  if (coversDiffuse_) {
    // The mean of the albedo is linear in the colour: what a black layer takes, and what its colour adds.
    const LayerMoments& means = shapes.meanMoments(material.layers[0]);
    const Rgb takenByBlack = glm::min(coloredAlbedo(Rgb(0.0f), means), 1.0f);
    passed_ = Rgb(1.0f) - takenByBlack;
    takenPerTint_ = glm::clamp(coloredAlbedo(layers_[0].color(), means) - takenByBlack, Rgb(0.0f), passed_);
  }
  Tint darkest;
  if (material.textures.layers[0]) darkest.layers[0] = Rgb(0.0f);
  const Rgb greatestDiffuse = diffuse(darkest);
  hasDiffuse_ = !isBlack(greatestDiffuse);
  diffuseShare_ = 0.5f * maxComponent(diffuse() + greatestDiffuse);
  nonSpecularAlbedoBound_ = greatestDiffuse;
  if (hasLobe_ && layerCount_ == 1) lobeColor_ = layers_[0].color();
  if (!hasLobe_ && !coversDiffuse_) return;

  tabulateAlbedos(material, rule, shapes);
  nonSpecularAlbedoBound_ = limitedBound(nonSpecularAlbedoBound_ + spreadAlbedoBounds(material.textures));
}

// The lobe's albedo at every node: for its bound, and for what layers must be scaled by. Both albedo and
// Dirac parts are linear in each layer's colour by itself: the extremes are at the ends of those that a
// texture drives.
void Brdf::tabulateAlbedos(const MaterialDescription& material, EnergyRule rule, LayerShapes& shapes) {
  using Table = DirectionTable<Rgb>;
  const MaterialTextures& textures = material.textures;
  const bool isRefined = rule == EnergyRule::Refined;
  const bool limitsCoat = coversDiffuse_ && isRefined;
  Table scale(isAnisotropic_ ? Table::kAnisotropicRows : 1);
  const bool keepsAlbedos = limitsCoat || textures.ofLayers();
  for (auto& tables : lobeAlbedos_) std::fill_n(tables, 2, keepsAlbedos ? Table(scale.rows()) : Table());
  std::array<const LayerMoments*, 2> ofLayers{};
  for (std::size_t i = 0; i < material.layers.size(); ++i)
    ofLayers[i] = shapes.moments(material.layers[i], isRefined, scale.rows()).data();
  for (int cosine = 0; cosine < Table::kCosines; ++cosine) {
    for (int row = 0; row < scale.rows(); ++row) {
      const Vec3 outgoing = Table::nodeDirection(scale.rows(), row, cosine);
      std::array<LayerMoments, 2> moments{};
      for (std::size_t i = 0; i < material.layers.size(); ++i)
        moments[i] = ofLayers[i][row * Table::kCosines + cosine];
      Rgb& factor = scale.node(row, cosine);
      factor = layerCount_ == 2 && isRefined ? layersScaleFor(textures, moments, outgoing.z) : Rgb(1.0f);
      isLimited_ = isLimited_ || factor != Rgb(1.0f);
      forTints(textures, [&](int first, int second, const std::array<Rgb, 2>& tints) {
        const Rgb albedo = lobeAlbedoBound(moments, tints) * factor;
        Rgb& bound = lobeAlbedoBounds_[first][second];
        bound = glm::max(bound, albedo);
        if (keepsAlbedos) lobeAlbedos_[first][second].node(row, cosine) = albedo;
        const Tint tint{.layers = tints};
        isLimited_ =
            isLimited_ ||
            (limitsCoat && maxComponent(albedo + diracWeight(outgoing.z, tints) + diffuse(tint)) > 1.0f);
      });
    }
  }
  if (layerCount_ == 2 && isLimited_) layersScale_ = std::move(scale);
}

Rgb Brdf::layersScaleFor(const MaterialTextures& textures, const std::array<LayerMoments, 2>& moments,
                         float cosine) const {
  Rgb factor(1.0f);
  forTints(textures, [&](int, int, const std::array<Rgb, 2>& tints) {
    factor = glm::min(factor, scaledToFit(lobeAlbedoBound(moments, tints), diracWeight(cosine, tints)));
  });
  return factor;
}

Rgb Brdf::coatScale(const Vec3& direction, const Tint& tint) const {
  Rgb lobe = lobeAlbedos_[1][1].at(direction);
  if (tint.layers[0] != Rgb(1.0f)) lobe = glm::mix(lobeAlbedos_[0][1].at(direction), lobe, tint.layers[0]);
  return scaledToFit(lobe + diracWeight(direction.z, tint.layers), diffuse(tint));
}

Rgb Brdf::spreadAlbedoBounds(const MaterialTextures& textures) {
  Rgb greatest(0.0f);
  forTints(textures, [&](int first, int second, const std::array<Rgb, 2>&) {
    lobeAlbedoBounds_[first][second] *= kBoundMargin;
    greatest = glm::max(greatest, lobeAlbedoBounds_[first][second]);
  });
  if (!textures.layers[0]) {
    std::copy_n(lobeAlbedoBounds_[1], 2, lobeAlbedoBounds_[0]);
    std::copy_n(lobeAlbedos_[1], 2, lobeAlbedos_[0]);
  }
  if (!textures.layers[1]) {
    for (auto& bounds : lobeAlbedoBounds_) bounds[0] = bounds[1];
    for (auto& tables : lobeAlbedos_) tables[0] = tables[1];
  }
  return greatest;
}

Rgb Brdf::lobeAlbedoBound(const std::array<LayerMoments, 2>& moments, const std::array<Rgb, 2>& tints) const {
  const Rgb top = layers_[0].color() * tints[0];
  Rgb albedo = coloredAlbedo(top, moments[0]);
  if (layerCount_ == 2) albedo += lowerAlbedo(top, layers_[1].color() * tints[1], moments[1]);
  return albedo;
}

Rgb Brdf::nonSpecularAlbedoBound(const Tint& tint) const {
  // The greatest of a mixture is not above the mixture of the greatest.
  const auto& bounds = lobeAlbedoBounds_;
  return limitedBound(diffuse(tint) +
                      mixLayers(tint, bounds[0][0], bounds[0][1], bounds[1][0], bounds[1][1]));
}

Rgb Brdf::limitedBound(const Rgb& bound) const {
  return isCoatLimited() ? glm::min(bound, kBoundMargin) : bound;
}

Rgb Brdf::lobeAlbedoShare(const Vec3& outgoing, const Tint& tint) const {
  if (lobeAlbedos_[1][1].empty() || !(outgoing.z > 0.0f)) return Rgb(1.0f);
  const auto at = [&](int first, int second) { return lobeAlbedos_[first][second].at(outgoing); };
  const Rgb without = at(1, 1);
  const Rgb share = dividedWhereLit(mixLayers(tint, at(0, 0), at(0, 1), at(1, 0), without), without);
  return isCoatLimited() ? share * coatScale(outgoing, tint) / coatScale(outgoing, {}) : share;
}

Rgb Brdf::lobeShare(const Vec3& incoming, const Vec3& outgoing, const Tint& tint) const {
  return dividedWhereLit(lobeRgb(incoming, outgoing, tint), lobeRgb(incoming, outgoing));
}

Rgb Brdf::diracWeight(float cosine, const std::array<Rgb, 2>& tints) const {
  const float fresnel = schlickFresnel(cosine);
  Rgb weight(0.0f);
  Rgb passed(1.0f);
  for (std::size_t i = 0; i < static_cast<std::size_t>(layerCount_); ++i) {
    const Layer& layer = layers_[i];
    const Rgb s = schlickColor(layer.color() * tints[i], fresnel);
    weight += passed * s * layer.diracShare();
    passed *= Rgb(1.0f) - s;
  }
  return weight;
}

Brdf::Mixture Brdf::mixture(const Vec3& outgoing) const {
  // Shares in proportion to what each term is about to reflect: S at the mirror direction, never taken below
  // its mean over rough surfaces, so that no term starves. Any positive shares would do.
  const float fresnel = std::max(schlickFresnel(outgoing.z), kMeanFresnel);
  Mixture shares;
  float passed = 1.0f;
  float total = 0.0f;
  for (std::size_t i = 0; i < static_cast<std::size_t>(layerCount_); ++i) {
    const Layer& layer = layers_[i];
    const float s = passed * maxComponent(schlickColor(layer.color(), fresnel));
    shares.cosine += s * layer.lambertShare();
    shares.halfVector[i] = s * layer.glossyShare();
    total += s * (layer.lambertShare() + layer.glossyShare());
    passed *= maxComponent(Rgb(1.0f) - schlickColor(layer.color(), kMeanFresnel));
  }
  // Nothing shows of a layer below a mirror-like one that is perfectly white.
  if (!(total > 0.0f)) return {hasDiffuse_ ? 0.0f : 1.0f, 1.0f, {}};
  shares.lobe = total / (total + diffuseShare_);
  const float toUnit = 1.0f / total;
  shares.cosine *= toUnit;
  for (float& share : shares.halfVector) share *= toUnit;
  return shares;
}

Vec3 Brdf::sampleLobe(const Mixture& shares, const Vec3& outgoing, const Vec2& u) const {
  if (u.x < shares.cosine) return sampleCosine({rescale(u.x, 0.0f, shares.cosine), u.y});
  float from = shares.cosine;
  std::size_t chosen = 0;
  if (!(u.x < from + shares.halfVector[0]) && shares.halfVector[1] > 0.0f) {
    from += shares.halfVector[0];
    chosen = 1;
  }
  // Rounding may leave u.x beyond a cosine share of all but 1.
  if (!(shares.halfVector[chosen] > 0.0f)) return sampleCosine(u);
  const Vec3 half =
      layers_[chosen].sampleHalfVector(outgoing, {rescale(u.x, from, shares.halfVector[chosen]), u.y});
  return 2.0f * glm::dot(outgoing, half) * half - outgoing;
}

float Brdf::lobePdf(const Mixture& shares, const Vec3& incoming, const Vec3& outgoing) const {
  float pdf = shares.cosine * incoming.z * kInvPi;
  const DirectionPair pair(incoming, outgoing);
  for (std::size_t i = 0; i < 2; ++i) {
    if (shares.halfVector[i] > 0.0f) pdf += shares.halfVector[i] * layers_[i].pdf(pair);
  }
  return pdf;
}

Vec3 Brdf::sampleLobe(const Vec3& outgoing, const Vec2& u) const {
  if (!hasLobe_ || !(outgoing.z > 0.0f)) return kLost;
  return sampleLobe(mixture(outgoing), outgoing, u);
}

float Brdf::lobePdf(const Vec3& incoming, const Vec3& outgoing) const {
  if (!hasLobe_ || !(incoming.z > 0.0f) || !(outgoing.z > 0.0f)) return 0.0f;
  return lobePdf(mixture(outgoing), incoming, outgoing);
}

Vec3 Brdf::sample(const Vec3& outgoing, const Vec2& u) const {
  if (!hasNonSpecular() || !(outgoing.z > 0.0f)) return kLost;
  if (!hasLobe_) return sampleCosine(u);
  const Mixture shares = mixture(outgoing);
  if (u.x < shares.lobe) return sampleLobe(shares, outgoing, {rescale(u.x, 0.0f, shares.lobe), u.y});
  return sampleCosine({rescale(u.x, shares.lobe, 1.0f - shares.lobe), u.y});
}

float Brdf::pdf(const Vec3& incoming, const Vec3& outgoing) const {
  if (!hasNonSpecular() || !(incoming.z > 0.0f) || !(outgoing.z > 0.0f)) return 0.0f;
  const float cosine = incoming.z * kInvPi;
  if (!hasLobe_) return cosine;
  const Mixture shares = mixture(outgoing);
  return shares.lobe * lobePdf(shares, incoming, outgoing) + (1.0f - shares.lobe) * cosine;
}

int Brdf::specularBranches(const Vec3& outgoing, bool entering, const Tint& tint,
                           std::array<SpecularBranch, 2>& branches) const {
  if (!hasSpecular_ || !(outgoing.z > 0.0f)) return 0;
  Rgb reflected = diracWeight(outgoing.z, tint.layers);
  if (isCoatLimited()) reflected *= coatScale(outgoing, tint);
  reflected += mirror_ * tint.mirror;
  Rgb transmitted(0.0f);
  Vec3 refracted(0.0f);
  if (isThin_) {
    // Two faces with all that goes to and fro between them: R + T R T / (1 - R^2) = 2 R / (1 + R).
    float cosTransmitted = 0.0f;
    const float face = fresnelDielectric(outgoing.z, ior_, cosTransmitted);
    const float pane = 2.0f * face / (1.0f + face);
    reflected += Rgb(pane);
    transmitted = transmission_ * tint.transmission * (1.0f - pane);
    refracted = -outgoing;
  } else if (isGlass_) {
    const float eta = entering ? ior_ : 1.0f / ior_;
    float cosTransmitted = 0.0f;
    const float fresnel = fresnelDielectric(outgoing.z, eta, cosTransmitted);
    reflected += Rgb(fresnel);
    transmitted = transmission_ * tint.transmission * (1.0f - fresnel);
    refracted = {-outgoing.x / eta, -outgoing.y / eta, -cosTransmitted};
  }
  int count = 0;
  const auto add = [&](const Vec3& direction, const Rgb& weight, bool isTransmitted) {
    if (isBlack(weight)) return;
    branches[static_cast<std::size_t>(count++)] = {direction, weight, isTransmitted};
  };
  add({-outgoing.x, -outgoing.y, outgoing.z}, reflected, false);
  add(refracted, transmitted, true);
  return count;
}

Rgb Brdf::directionalAlbedo(const Vec3& outgoing, const Tint& tint) const {
  if (!(outgoing.z > 0.0f)) return Rgb(0.0f);
  Rgb albedo = diffuse(tint);
  std::array<SpecularBranch, 2> branches;
  const int count = specularBranches(outgoing, true, tint, branches);
  for (int i = 0; i < count; ++i) {
    if (!branches[static_cast<std::size_t>(i)].transmitted)
      albedo += branches[static_cast<std::size_t>(i)].weight;
  }
  if (!hasLobe_) return albedo;

  // A grid for each part of the mixture, weighted by the density of all of them (the balance heuristic): the
  // integrand has no steps but those at the horizon. The first random number runs as 3x^2 - 2x^3, as in
  // SchlickLayer.
  constexpr int kPoints = 128;
  const Mixture shares = mixture(outgoing);
  glm::dvec3 sum(0.0);
  const auto add = [&](const Vec3& incoming, float weight) {
    if (!(incoming.z > 0.0f)) return;
    const float scale = weight * incoming.z / lobePdf(shares, incoming, outgoing);
    sum += glm::dvec3(lobeRgb(incoming, outgoing, tint) * scale);
  };
  for (int i = 0; i < kPoints; ++i) {
    const float x = (static_cast<float>(i) + 0.5f) / kPoints;
    const float weight = 6.0f * x * (1.0f - x);
    for (int j = 0; j < kPoints; ++j) {
      const Vec2 u(x * x * (3.0f - 2.0f * x), (static_cast<float>(j) + 0.5f) / kPoints);
      if (shares.cosine > 0.0f) add(sampleCosine(u), weight * shares.cosine);
      for (std::size_t layer = 0; layer < 2; ++layer) {
        if (!(shares.halfVector[layer] > 0.0f)) continue;
        const Vec3 half = layers_[layer].sampleHalfVector(outgoing, u);
        add(2.0f * glm::dot(outgoing, half) * half - outgoing, weight * shares.halfVector[layer]);
      }
    }
  }
  return albedo + Rgb(sum / static_cast<double>(kPoints * kPoints));
}

}  // namespace lightvane
