#include "tests/pictures/pictures.h"

#include <cstring>
#include <filesystem>
#include <stdexcept>

#include <fmt/format.h>

#include "core/scene/load_scene.h"

namespace lightvane::render_test {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || !defined(NDEBUG)
constexpr bool kIsFast = false;
#else
constexpr bool kIsFast = true;
#endif

template <class T>
T valueOf(Expected<T> expected) {
  if (!expected) throw std::runtime_error(expected.error().message());
  return *std::move(expected);
}

}  // namespace

int budget(int full, int reduced) { return kIsFast ? full : reduced; }
bool isFast() { return kIsFast; }

std::set<std::string> shippedScenes() {
  std::set<std::string> names;
  for (const auto& file : std::filesystem::directory_iterator(LIGHTVANE_SOURCE_DIR "/assets/scenes")) {
    if (file.path().extension() == ".toml") names.insert(file.path().filename().string());
  }
  return names;
}

SceneDescription shippedScene(const std::string& name, int width, int height) {
  SceneDescription scene = valueOf(loadScene(std::string(LIGHTVANE_SOURCE_DIR "/assets/scenes/") + name));
  scene.cameras.front().width = width;
  scene.cameras.front().height = height;
  return scene;
}

SceneDescription sceneFromText(std::string_view toml) { return valueOf(parseSceneToml(toml, "test.toml")); }

void setParameters(Parameters& parameters, const Settings& settings) {
  for (const auto& [key, value] : settings) {
    if (key == "preset") {
      applyPreset(parameters, choiceNamed(kPresetNames, value).value());
    } else if (key == "method.rules") {
      applyRules(parameters.vectors, choiceNamed(kRulesNames, value).value());
    } else {
      const Expected<void> result = setParameter(parameters, key, value, key);
      if (!result) throw std::runtime_error(result.error().message());
    }
  }
}

Parameters parametersWith(const Settings& settings) {
  Parameters parameters;
  setParameters(parameters, settings);
  return parameters;
}

Stage::Stage(const SceneDescription& description, int threads)
    : scene(valueOf(Scene::compile(description))),
      tracer(std::make_shared<Tracer>(scene)),
      pool(std::make_shared<TaskPool>(threads)),
      camera(scene->cameras.front()) {}

RenderContext Stage::context(const Parameters& parameters) const {
  return {scene,      tracer, camera, {camera.width, camera.height, 0, 0, camera.width, camera.height},
          parameters, pool};
}

void finish(Renderer& renderer) {
  const StopFlag never = false;
  // Strides and parts are a handful, and the longest path reference here has some hundred passes.
  for (int pass = 0; !renderer.done(); ++pass) {
    if (pass == 10'000) throw std::runtime_error("no end after 10000 passes");
    if (!renderer.runPass(never)) throw std::runtime_error("a pass stopped that nobody asked to");
  }
}

Picture picture(const Stage& stage, const Parameters& parameters, const CacheInput& cache) {
  const std::unique_ptr<Renderer> renderer = makeRenderer(stage.context(parameters), cache);
  finish(*renderer);
  Picture result{renderer->film(), renderer->statistics(), nullptr};
  if (renderer->snapshot() != nullptr) result.snapshot = std::make_shared<Snapshot>(*renderer->snapshot());
  return result;
}

double mean(const ImageRgb& layer) {
  double sum = 0.0;
  for (const Rgb& pixel : layer) sum += static_cast<double>(pixel.r) + pixel.g + pixel.b;
  return sum / (3.0 * static_cast<double>(layer.size()));
}

double relativeMeanSquaredError(const ImageRgb& a, const ImageRgb& b) {
  const double floor = square(0.01 * mean(b));
  double sum = 0.0;
  for (std::size_t i = 0; i < b.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      sum += square(static_cast<double>(a[i][c]) - b[i][c]) / (square(static_cast<double>(b[i][c])) + floor);
    }
  }
  return sum / (3.0 * static_cast<double>(b.size()));
}

ImageRgb beauty(const Film& film) {
  ImageRgb image(film.width, film.height);
  for (std::size_t i = 0; i < image.size(); ++i) image[i] = film.beauty(i);
  return image;
}

std::string difference(const Film& a, const Film& b) {
  if (a.width != b.width || a.height != b.height) return "another size";
  const auto compare = [&](const char* name, const auto& x, const auto& y) -> std::string {
    if (x.size() != y.size()) return fmt::format("{}: another size", name);
    using Pixel = std::decay_t<decltype(x[0])>;
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (std::memcmp(&x[i], &y[i], sizeof(Pixel)) == 0) continue;
      std::string values;
      if constexpr (std::is_same_v<Pixel, Rgb>) {
        values = fmt::format("({}, {}, {}) and ({}, {}, {})", x[i].r, x[i].g, x[i].b, y[i].r, y[i].g, y[i].b);
      } else {
        values = fmt::format("{} and {}", x[i], y[i]);
      }
      const auto width = static_cast<std::size_t>(a.width);
      return fmt::format("{} at pixel ({}, {}): {}", name, i % width, i / width, values);
    }
    return {};
  };
  for (const std::string& found :
       {compare("emission", a.emission, b.emission), compare("direct", a.direct, b.direct),
        compare("indirect", a.indirect, b.indirect), compare("specular", a.specular, b.specular),
        compare("albedo", a.albedo(), b.albedo()), compare("normal", a.normal(), b.normal()),
        compare("position", a.position(), b.position()), compare("depth", a.depth(), b.depth()),
        compare("ilvCount", a.ilvCount, b.ilvCount), compare("fullIlv", a.fullIlv, b.fullIlv),
        compare("fullDlv", a.fullDlv, b.fullDlv), compare("recordId", a.recordId, b.recordId),
        compare("variance", a.variance, b.variance)}) {
    if (!found.empty()) return found;
  }
  return {};
}

std::string badPixel(const Film& film) {
  const std::pair<const char*, const ImageRgb*> layers[] = {{"emission", &film.emission},
                                                            {"direct", &film.direct},
                                                            {"indirect", &film.indirect},
                                                            {"specular", &film.specular},
                                                            {"albedo", &film.albedo()}};
  for (const auto& [name, layer] : layers) {
    for (std::size_t i = 0; i < layer->size(); ++i) {
      const Rgb& p = (*layer)[i];
      if (isValidSample(p)) continue;
      const auto width = static_cast<std::size_t>(film.width);
      return fmt::format("{} at pixel ({}, {}): ({}, {}, {})", name, i % width, i / width, p.r, p.g, p.b);
    }
  }
  return {};
}

}  // namespace lightvane::render_test
