#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/scene/brdf.h"
#include "core/scene/description.h"
#include "core/trace/parameters.h"
#include "core/vectors/parameters.h"

namespace lightvane {

/// How a picture is computed: the paper's method and its rivals (section 6).
enum class Method {
  Vectors,  ///< light vectors: few full computations, the rest interpolated
  Path,     ///< unbiased path tracing: the reference
  Naive,    ///< a full gather at every visible point
  Direct    ///< direct light and an ambient term
};
inline constexpr std::array kMethodNames{Choice{Method::Vectors, "vectors"}, Choice{Method::Path, "path"},
                                         Choice{Method::Naive, "naive"}, Choice{Method::Direct, "direct"}};

inline constexpr int kMostFilmSamples = 4096;

struct PictureParameters {
  Method method = Method::Vectors;
  std::uint64_t seed = 1;
  int filmSamples = 1;
  double filmContrast = 0.0;
  int pathSamples = 64;
  int naiveSamples = 128;
  double ambient = 0.3;
  int firstStride = 16;
  int lastStride = 2;
  double thin = 1.0;

  bool operator==(const PictureParameters&) const = default;
};

/// Everything that a picture is a function of, beside the scene and the camera.
struct Parameters {
  PictureParameters picture;
  TransportParameters transport;
  VectorParameters vectors;

  bool operator==(const Parameters&) const = default;
};

template <class P, class Visit>
void visitParameters(P& p, Visit&& visit) {
  visit(p.picture.method,
        Field{.key = "method.name",
              .label = "Method",
              .cost = ChangeCost::Vectors,
              .paper = "6",
              .help = "vectors: light vectors; path: unbiased path tracing, the reference; naive: a full "
                      "gather at every "
                      "visible point; direct: direct light and an ambient term."},
        kMethodNames);
  visit(p.picture.seed,
        Field{.key = "seed",
              .label = "Seed",
              .cost = ChangeCost::Vectors,
              .help = "Names the random numbers: the same seed gives the same picture."},
        Range<std::uint64_t>{0, ~std::uint64_t{0}});
  visit(p.picture.filmSamples,
        Field{.key = "film.samples",
              .label = "Samples per pixel",
              .cost = ChangeCost::Vectors,
              .help = "Visible points are looked for at so many places in a pixel; 1 looks at its centre. "
                      "As many places of a camera's lens are looked through.",
              .trade = Trade::LargerIsMoreAccurate},
        Range{1, kMostFilmSamples});
  visit(
      p.picture.filmContrast,
      Field{.key = "film.contrast",
            .label = "Adaptive contrast",
            .cost = ChangeCost::Vectors,
            .paper = "6",
            .help = "A pixel has one sample, and all of film.samples only where a neighbour differs from it "
                    "by more than this part of the brighter of the two. 0: all have all. For the method "
                    "`vectors` under the refined rules.",
            .trade = Trade::LargerIsFaster},
      Range{0.0, 1.0});
  visit(p.picture.pathSamples,
        Field{.key = "path.samples",
              .label = "Paths per pixel",
              .cost = ChangeCost::Vectors,
              .help = "Paths traced for each pixel by the method `path`.",
              .trade = Trade::LargerIsMoreAccurate},
        Range{1, 10'000'000});
  visit(p.picture.naiveSamples,
        Field{.key = "naive.samples",
              .label = "Samples of the naive gather",
              .cost = ChangeCost::Vectors,
              .paper = "6",
              .help = "Rays over the hemisphere of every visible point, for the method `naive`.",
              .trade = Trade::LargerIsMoreAccurate},
        Range{1, 1'000'000});
  visit(p.picture.ambient,
        Field{.key = "direct.ambient",
              .label = "Ambient term",
              .cost = ChangeCost::Answer,
              .paper = "1",
              .help = "For the method `direct`: ambient irradiance, as a part of the picture's mean direct "
                      "irradiance."},
        Range{0.0, 100.0});
  visit(p.picture.firstStride,
        Field{.key = "passes.first_stride",
              .label = "First stride",
              .unit = "px",
              .cost = ChangeCost::Vectors,
              .paper = "3.3.2",
              .help = "The first pass looks at every so-many-th pixel; each pass halves the stride."},
        Range{1, 1024});
  visit(p.picture.lastStride,
        Field{.key = "passes.last_stride",
              .label = "Last stride",
              .unit = "px",
              .cost = ChangeCost::Vectors,
              .paper = "3.3.2",
              .help = "The last stride at which ilv.n_min is asked for; the last pass answers every pixel "
                      "and computes only "
                      "where fewer than ilv.n_min_last vectors are valid.",
              .trade = Trade::LargerIsFaster},
        Range{1, 1024});
  visit(p.picture.thin,
        Field{.key = "passes.thin",
              .label = "Thinning",
              .unit = "px",
              .cost = ChangeCost::Vectors,
              .paper = "3.3.2",
              .help = "Of the points that miss in a pass, those nearer to each other than so many pixels of "
                      "a picture 256 "
                      "pixels high share one vector; nor is a DLV computed so near to another.",
              .trade = Trade::LargerIsFaster},
        Range{0.0, 1000.0});
  visitTransportParameters(p.transport, visit);
  visitVectorParameters(p.vectors, visit);
}

/// Whether pixels have one sample at first, and the others only where neighbours differ.
bool isAdaptive(const Parameters& parameters);

/// The rule of energy by which the materials must be compiled for these parameters.
EnergyRule energyRuleFor(const Parameters& parameters);

/// What the values contradict each other in, though each may stand: a sentence each.
std::vector<std::string> contradictions(const Parameters& parameters);

enum class Preset { Draft, Balanced, Fine };
inline constexpr std::array kPresetNames{Choice{Preset::Draft, "draft"}, Choice{Preset::Balanced, "balanced"},
                                         Choice{Preset::Fine, "fine"}};

/// Sets sampling densities, and under the refined rules thresholds, from fast to accurate. Rules are left
/// alone.
void applyPreset(Parameters& parameters, Preset preset);

/// What the settings make of `parameters`. Rules and presets set many keys at once and act first, wherever
/// they are given; of several of one key the last counts. Errors name the setting's place.
Expected<Parameters> applySettings(Parameters parameters, std::span<const RenderSetting> settings);

}  // namespace lightvane
