#include "core/render/film.h"

#include <utility>

namespace lightvane {

SeenSurfaces::SeenSurfaces(int width, int height)
    : emission(width, height),
      specularEmission(width, height),
      albedo(width, height),
      normal(width, height),
      position(width, height),
      depth(width, height, kInfinity) {}

Film::Film(int w, int h) : Film(std::make_shared<const SeenSurfaces>(w, h)) {}

Film::Film(std::shared_ptr<const SeenSurfaces> surfaces)
    : width(surfaces->emission.width()),
      height(surfaces->emission.height()),
      seen(std::move(surfaces)),
      emission(seen->emission),
      direct(width, height),
      indirect(width, height),
      specular(seen->specularEmission),
      ilvCount(width, height),
      fullIlv(width, height),
      fullDlv(width, height),
      recordId(width, height) {}

ImageRgb Film::beauty() const {
  ImageRgb all(width, height);
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = beauty(i);
  return all;
}

ImageRgb Film::sceneBeauty(const Scene& scene) const {
  const float scale = scene.normalisation.radianceScale();
  ImageRgb beautyPixels(width, height);
  // Added after scaling, so that a reader who adds the layers of the file finds the file's R, G, B to the
  // bit.
  for (std::size_t i = 0; i < beautyPixels.size(); ++i) {
    beautyPixels[i] = ((scale * emission[i] + scale * direct[i]) + scale * indirect[i]) + scale * specular[i];
  }
  return beautyPixels;
}

ImageRgb Film::sceneVariance(const Scene& scene) const {
  ImageRgb scaled = variance;
  for (Rgb& pixel : scaled) pixel *= square(scene.normalisation.radianceScale());
  return scaled;
}

LayeredImage Film::toLayers(const Scene& scene) const {
  LayeredImage image;
  image.width = width;
  image.height = height;
  const float scale = scene.normalisation.radianceScale();
  const auto scaled = [&](const ImageRgb& layer, float factor) {
    ImageRgb result = layer;
    for (Rgb& pixel : result) pixel *= factor;
    return result;
  };
  image.setRgb("", sceneBeauty(scene));
  image.setRgb("emission", scaled(emission, scale));
  image.setRgb("direct", scaled(direct, scale));
  image.setRgb("indirect", scaled(indirect, scale));
  image.setRgb("specular", scaled(specular, scale));
  image.setRgb("albedo", albedo());
  ImageFloat alpha(width, height, 1.0f);
  ImageFloat z(width, height);
  ImageRgb worldPosition(width, height);
  for (std::size_t i = 0; i < depth().size(); ++i) {
    const bool met = depth()[i] < kInfinity;
    alpha[i] = met ? 1.0f : 0.0f;
    z[i] = met ? static_cast<float>(scene.normalisation.sceneLength(depth()[i])) : kInfinity;
    if (met) worldPosition[i] = Rgb(scene.normalisation.scenePoint(position()[i]));
  }
  image.channels["A"] = std::move(alpha);
  image.channels["Z"] = std::move(z);
  constexpr const char* kAxes[3] = {"X", "Y", "Z"};
  for (int axis = 0; axis < 3; ++axis) {
    ImageFloat n(width, height);
    ImageFloat p(width, height);
    for (std::size_t i = 0; i < n.size(); ++i) {
      n[i] = normal()[i][axis];
      p[i] = worldPosition[i][axis];
    }
    image.channels[std::string("N.") + kAxes[axis]] = std::move(n);
    image.channels[std::string("P.") + kAxes[axis]] = std::move(p);
  }
  image.channels["cache.ilv_count"] = ilvCount;
  image.channels["cache.full_ilv"] = fullIlv;
  image.channels["cache.full_dlv"] = fullDlv;
  image.uintChannels["cache.record_id"] = recordId;
  const auto addStandardError = [&](const std::string& name, const ImageRgb& variances) {
    if (variances.empty()) return;
    ImageRgb error = scaled(variances, scale * scale);
    for (Rgb& pixel : error) pixel = glm::sqrt(pixel);
    image.setRgb(name, error);
  };
  addStandardError("standard_error", variance);
  addStandardError("direct.standard_error", directVariance);
  addStandardError("indirect.standard_error", indirectVariance);
  return image;
}

}  // namespace lightvane
