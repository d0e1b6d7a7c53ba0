#pragma once

#include "core/base/parameter.h"

namespace lightvane {

/// How lights are sampled and paths are continued: by gathers, path tracing, and direct light alike, so that
/// methods are compared on equal terms.
struct TransportParameters {
  int lightSamples = 16;
  int bounceLightSamples = 1;
  bool mirroredLights = true;
  bool lightsByLobe = true;
  bool roulette = true;
  int maxBounces = 0;
  int specularDepth = 16;
  double specularCutoff = 0.002;

  /// A light in a mirror is a specular reflection too.
  bool samplesMirroredLights() const { return mirroredLights && specularDepth > 0; }

  bool operator==(const TransportParameters&) const = default;
};

template <class P, class Visit>
void visitTransportParameters(P& p, Visit&& visit) {
  visit(p.lightSamples,
        Field{.key = "light.samples",
              .label = "Samples per light",
              .cost = ChangeCost::Vectors,
              .paper = "4.1",
              .help = "Stratified shadow rays to each light from a visible point.",
              .trade = Trade::LargerIsMoreAccurate},
        Range{1, 4096});
  visit(p.bounceLightSamples,
        Field{.key = "light.bounce_samples",
              .label = "Samples per light after a bounce",
              .cost = ChangeCost::Vectors,
              .paper = "5.2.1",
              .help = "Shadow rays to each light from a point that a gather or a path met.",
              .trade = Trade::LargerIsMoreAccurate},
        Range{1, 64});
  visit(p.mirroredLights, Field{.key = "light.mirrored",
                                .label = "Sample lights in mirrors",
                                .cost = ChangeCost::Vectors,
                                .help = "Samples the image of an area light in a planar mirror as a light of "
                                        "its own; without it, rays find "
                                        "it by chance and leave splotches.",
                                .trade = Trade::OnIsMoreAccurate});
  visit(p.lightsByLobe,
        Field{.key = "light.by_lobe",
              .label = "Sample lights by lobes, too",
              .cost = ChangeCost::Vectors,
              .help = "Where a glossy lobe is narrower than the light, as many rays again go along it, "
                      "and both kinds count by how likely they were (Veach's balance "
                      "heuristic). Without it, a sky in a polished ball is noise.",
              .trade = Trade::OnIsMoreAccurate});
  visit(p.roulette, Field{.key = "path.roulette",
                          .label = "Russian roulette",
                          .cost = ChangeCost::Vectors,
                          .paper = "5.2.1",
                          .help = "Ends paths at random in proportion to what they carry, without bias; the "
                                  "paper's fixed level of "
                                  "recursion loses the energy beyond it."});
  visit(p.maxBounces,
        Field{.key = "path.max_bounces",
              .label = "Most bounces",
              .cost = ChangeCost::Vectors,
              .paper = "5.2.1",
              .help = "The paper's level of recursion: light reflected more often is lost. 0 sets no limit "
                      "(1000 without Russian roulette).",
              .trade = Trade::LargerIsMoreAccurate},
        Range{0, 1000});
  visit(p.specularDepth,
        Field{.key = "specular.depth",
              .label = "Specular depth",
              .cost = ChangeCost::Vectors,
              .paper = "3.1",
              .help = "Reflections and refractions followed in a row.",
              .trade = Trade::LargerIsMoreAccurate},
        Range{0, 64});
  visit(p.specularCutoff,
        Field{.key = "specular.cutoff",
              .label = "Specular cut-off",
              .cost = ChangeCost::Vectors,
              .paper = "3.1",
              .help = "A specular branch that carries less than this part of a pixel is not followed.",
              .trade = Trade::LargerIsFaster},
        Range{0.0, 1.0});
}

}  // namespace lightvane
