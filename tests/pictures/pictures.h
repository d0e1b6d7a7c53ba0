#pragma once

#include <functional>
#include <memory>
#include <ostream>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/render/renderer.h"

// Pictures for tests: scenes from assets/scenes or from text, at the size of a stamp, rendered from
// beginning to end.

namespace lightvane::render_test {

/// `full` in an optimised build, `reduced` under sanitizers, where everything takes 10 to 30 times as long.
/// For sizes that no tolerance depends on.
int budget(int full, int reduced);
/// Whether this build is an optimised one without sanitizers. Statistical tests, whose tolerances need their
/// samples, are skipped elsewhere.
bool isFast();

/// Of assets/scenes; its picture `width` by `height` pixels.
SceneDescription shippedScene(const std::string& name, int width, int height);
/// The names of all of these files.
std::set<std::string> shippedScenes();
/// A scene as its file would say it; throws where that is wrong.
SceneDescription sceneFromText(std::string_view toml);

/// Parameters by their keys, in order: setParameters(p, {{"ilv.n_min", "3"}}). `method.rules` and `preset`
/// set what belongs to them. Throws for what does not exist.
using Settings = std::vector<std::pair<std::string, std::string>>;
void setParameters(Parameters& parameters, const Settings& settings);
Parameters parametersWith(const Settings& settings);

/// A scene, the way it is rendered, and a name for the test's.
struct Way {
  const char* name;
  const char* scene;
  Settings settings;
};
inline void PrintTo(const Way& way, std::ostream* out) { *out << way.name; }

/// A compiled scene that can be rendered many times.
struct Stage {
  explicit Stage(const SceneDescription& description, int threads = 2);

  RenderContext context(const Parameters& parameters) const;

  std::shared_ptr<const Scene> scene;
  std::shared_ptr<const Tracer> tracer;
  std::shared_ptr<TaskPool> pool;
  Camera camera;
};

/// A finished picture and what it took.
struct Picture {
  Film film;
  RenderStatistics statistics;
  std::shared_ptr<const Snapshot> snapshot;  ///< of the method `vectors`
};

/// Runs passes until the renderer is done. Throws where there is no end in sight.
void finish(Renderer& renderer);
Picture picture(const Stage& stage, const Parameters& parameters, const CacheInput& cache = {});

/// The mean over all pixels and colours.
double mean(const ImageRgb& layer);
/// The mean of the squared relative difference over pixels, (a - b)^2 / (b^2 + (1 % of b's mean)^2).
double relativeMeanSquaredError(const ImageRgb& a, const ImageRgb& b);
ImageRgb beauty(const Film& film);

/// Where two films differ, in a word; empty where all their layers are the same to the bit.
std::string difference(const Film& a, const Film& b);
/// The first pixel that holds a NaN, an infinity or a negative number; empty where there is none.
std::string badPixel(const Film& film);

}  // namespace lightvane::render_test
