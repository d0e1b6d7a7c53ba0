#include "core/render/film.h"

namespace lightvane {

Film::Film(int w, int h)
    : width(w),
      height(h),
      emission(w, h, Rgb(0.0f)),
      direct(w, h, Rgb(0.0f)),
      indirect(w, h, Rgb(0.0f)),
      specular(w, h, Rgb(0.0f)),
      albedo(w, h, Rgb(0.0f)),
      normal(w, h, Rgb(0.0f)),
      position(w, h, Rgb(0.0f)),
      depth(w, h, kInfinity),
      ilvCount(w, h, 0.0f),
      fullIlv(w, h, 0.0f),
      fullDlv(w, h, 0.0f),
      recordId(w, h, 0u) {}

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
  const ImageRgb layers[] = {scaled(emission, scale), scaled(direct, scale), scaled(indirect, scale),
                             scaled(specular, scale)};
  // Added after scaling, so that a reader who adds the layers of the file finds the file's R, G, B to the
  // bit.
  ImageRgb beautyPixels(width, height, Rgb(0.0f));
  for (std::size_t i = 0; i < beautyPixels.size(); ++i) {
    beautyPixels[i] = ((layers[0][i] + layers[1][i]) + layers[2][i]) + layers[3][i];
  }
  image.setRgb("", beautyPixels);
  image.setRgb("emission", layers[0]);
  image.setRgb("direct", layers[1]);
  image.setRgb("indirect", layers[2]);
  image.setRgb("specular", layers[3]);
  image.setRgb("albedo", albedo);
  ImageFloat alpha(width, height, 1.0f);
  ImageFloat z(width, height);
  ImageRgb worldPosition(width, height, Rgb(0.0f));
  for (std::size_t i = 0; i < depth.size(); ++i) {
    const bool met = depth[i] < kInfinity;
    alpha[i] = met ? 1.0f : 0.0f;
    z[i] = met ? static_cast<float>(scene.normalisation.sceneLength(depth[i])) : kInfinity;
    if (met) worldPosition[i] = Rgb(scene.normalisation.scenePoint(position[i]));
  }
  image.channels["A"] = std::move(alpha);
  image.channels["Z"] = std::move(z);
  constexpr const char* kAxes[3] = {"X", "Y", "Z"};
  for (int axis = 0; axis < 3; ++axis) {
    ImageFloat n(width, height);
    ImageFloat p(width, height);
    for (std::size_t i = 0; i < n.size(); ++i) {
      n[i] = normal[i][axis];
      p[i] = worldPosition[i][axis];
    }
    image.channels[std::string("N.") + kAxes[axis]] = std::move(n);
    image.channels[std::string("P.") + kAxes[axis]] = std::move(p);
  }
  image.channels["cache.ilv_count"] = ilvCount;
  image.channels["cache.full_ilv"] = fullIlv;
  image.channels["cache.full_dlv"] = fullDlv;
  image.uintChannels["cache.record_id"] = recordId;
  if (!variance.empty()) image.setRgb("variance", scaled(variance, scale * scale));
  return image;
}

}  // namespace lightvane
