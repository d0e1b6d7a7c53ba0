#pragma once

#include "core/base/parameter.h"

namespace lightvane {

// The method's thresholds and rules. Every correction of the paper (docs/method.md) is a field of its own, so
// that each can be switched and measured alone; `method.rules` sets them together.

enum class Rules { Printed, Paper, Refined };
enum class DlvMode { Auto, Always, Never };
enum class DlvDispersion { VarianceAbove, Variation };
enum class DlvWeight { Printed, Normalised };
enum class VectorStore { Vector, Split };
enum class IlvRadius { Arithmetic, Harmonic };
enum class IlvGradient { Printed, Stratified };
enum class IlvGradientTest { Off, Signed, Absolute };
enum class IlvWeight { Printed, Absolute, Edge };

inline constexpr std::array kRulesNames{Choice{Rules::Printed, "printed"}, Choice{Rules::Paper, "paper"},
                                        Choice{Rules::Refined, "refined"}};
inline constexpr std::array kDlvModeNames{Choice{DlvMode::Auto, "auto"}, Choice{DlvMode::Always, "always"},
                                          Choice{DlvMode::Never, "never"}};
inline constexpr std::array kDlvDispersionNames{Choice{DlvDispersion::VarianceAbove, "variance-above"},
                                                Choice{DlvDispersion::Variation, "variation"}};
inline constexpr std::array kDlvWeightNames{Choice{DlvWeight::Printed, "printed"},
                                            Choice{DlvWeight::Normalised, "normalised"}};
inline constexpr std::array kVectorStoreNames{Choice{VectorStore::Vector, "vector"},
                                              Choice{VectorStore::Split, "split"}};
inline constexpr std::array kIlvRadiusNames{Choice{IlvRadius::Arithmetic, "arithmetic"},
                                            Choice{IlvRadius::Harmonic, "harmonic"}};
inline constexpr std::array kIlvGradientNames{Choice{IlvGradient::Printed, "printed"},
                                              Choice{IlvGradient::Stratified, "stratified"}};
inline constexpr std::array kIlvGradientTestNames{Choice{IlvGradientTest::Off, "off"},
                                                  Choice{IlvGradientTest::Signed, "signed"},
                                                  Choice{IlvGradientTest::Absolute, "absolute"}};
inline constexpr std::array kIlvWeightNames{Choice{IlvWeight::Printed, "printed"},
                                            Choice{IlvWeight::Absolute, "absolute"},
                                            Choice{IlvWeight::Edge, "edge"}};

struct DlvParameters {
  DlvMode mode = DlvMode::Auto;
  int nMin = 5;
  int nMax = 50;
  Length rMax = Length::relative(0.015);
  double dispersion = 0.1;
  DlvDispersion dispersionMeasure = DlvDispersion::Variation;
  DlvWeight weight = DlvWeight::Normalised;
  double normalCosine = 0.95;
  bool normaliseDirection = true;
  VectorStore store = VectorStore::Split;
  int seed = 5000;

  bool operator==(const DlvParameters&) const = default;
};

struct IlvParameters {
  int rows = 12;
  int columns = 24;
  int nMin = 4;
  int nMax = 16;
  int nMinLast = 1;
  double sE = 0.2;
  double sCurv = 0.95;
  bool curvatureClamp = true;
  IlvRadius radius = IlvRadius::Harmonic;
  double radiusScale = 0.4;
  double radiusMinPixels = 2.0;
  double radiusMaxPixels = 60.0;
  double radiusMinHit = 4.0;
  IlvGradient gradient = IlvGradient::Stratified;
  IlvGradientTest gradientTest = IlvGradientTest::Off;
  bool extrapolate = true;
  double gradientLimit = 4.0;
  double extrapolateMin = 0.1;
  double extrapolateMax = 4.0;
  IlvWeight weight = IlvWeight::Edge;
  VectorStore store = VectorStore::Split;
  bool inFront = true;
  bool visibility = true;
  double visibilityDistance = 0.5;
  double clearance = 4.0;
  double lobeAngle = 1.0;
  int seed = 0;

  bool operator==(const IlvParameters&) const = default;
};

struct VectorParameters {
  Rules rules = Rules::Refined;
  DlvParameters dlv;
  IlvParameters ilv;

  bool operator==(const VectorParameters&) const = default;
};

/// Sets every rule to what the paper prints, to the paper made stable, or to ours; thresholds that the paper
/// states (section 4.2.1, 4.2.2, 5.5.1) go with `printed` and `paper`. Sampling density is left alone.
void applyRules(VectorParameters& parameters, Rules rules);

template <class P, class Visit>
void visitVectorParameters(P& p, Visit&& visit) {
  visit(
      p.rules,
      Field{.key = "method.rules",
            .label = "Rules",
            .cost = ChangeCost::Vectors,
            .help =
                "printed: as the paper prints it, faults included; paper: made stable, nothing else changed; "
                "refined: ours. Sets all rules below; those given beside it win."},
      kRulesNames);

  visit(
      p.dlv.mode,
      Field{
          .key = "dlv.mode",
          .label = "Direct light vectors",
          .cost = ChangeCost::Answer,
          .paper = "4",
          .help =
              "Whether direct light is interpolated: auto does it for lights whose exact value costs more."},
      kDlvModeNames);
  visit(p.dlv.nMin,
        Field{.key = "dlv.n_min",
              .label = "Fewest DLVs",
              .paper = "4.2.1",
              .help = "With fewer neighbours than this, direct light is computed in full.",
              .trade = Trade::LargerIsMoreAccurate},
        Range{1, 1000});
  visit(p.dlv.nMax,
        Field{.key = "dlv.n_max",
              .label = "Most DLVs",
              .paper = "4.2.1",
              .help = "The nearest so many neighbours are used."},
        Range{1, 1000});
  visit(p.dlv.rMax,
        Field{.key = "dlv.r_max",
              .label = "DLV radius r_max",
              .paper = "4.2.1",
              .help = "Neighbours are looked for within this distance.",
              .trade = Trade::LargerIsFaster},
        Range{Length::relative(0.0), Length::relative(1.0)});
  visit(p.dlv.dispersion,
        Field{.key = "dlv.dispersion",
              .label = "DLV dispersion",
              .paper = "4.2.2",
              .help = "Neighbours that differ more than this are not interpolated.",
              .trade = Trade::LargerIsFaster},
        Range{0.0, 100.0});
  visit(p.dlv.dispersionMeasure,
        Field{.key = "dlv.dispersion_measure",
              .label = "Measure of dispersion",
              .paper = "4.2.2",
              .help =
                  "variation: standard deviation over mean must be below the threshold; variance-above: the "
                  "variance of brightness must be beyond it, as printed."},
        kDlvDispersionNames);
  visit(
      p.dlv.weight,
      Field{
          .key = "dlv.weight",
          .label = "DLV weight",
          .paper = "4.2.3",
          .help =
              "normalised: the paper's polynomial in d / r_max, 1 at the vector and 0 at r_max; printed: in "
              "r_max - d, reversed and dependent on the unit."},
      kDlvWeightNames);
  visit(p.dlv.normalCosine,
        Field{.key = "dlv.normal_cosine",
              .label = "DLV orientation",
              .help = "Least cosine between the normals of a point and of a vector that may serve it; -1 "
                      "does not test.",
              .trade = Trade::LargerIsMoreAccurate},
        Range{-1.0, 1.0});
  visit(
      p.dlv.normaliseDirection,
      Field{.key = "dlv.normalise",
            .label = "Normalise D",
            .cost = ChangeCost::Vectors,
            .paper = "4.1",
            .help =
                "Stores the average incident direction as a unit vector; as printed its length is below 1."});
  visit(p.dlv.store,
        Field{.key = "dlv.store",
              .label = "What a DLV stores",
              .cost = ChangeCost::Vectors,
              .paper = "eq. 4",
              .help = "split: irradiance for the diffuse part and outgoing radiance for the lobe; vector: P "
                      "= L / f(D)."},
        kVectorStoreNames);
  visit(p.dlv.seed,
        Field{.key = "dlv.seed",
              .label = "DLV seed",
              .cost = ChangeCost::Vectors,
              .paper = "3.3.1",
              .help =
                  "Vectors computed before the first pass, stratified over the picture and through mirrors.",
              .trade = Trade::LargerIsMoreAccurate},
        Range{0, 10'000'000});

  visit(p.ilv.rows,
        Field{.key = "ilv.rows",
              .label = "Gather rows M",
              .cost = ChangeCost::Vectors,
              .paper = "5.2.1",
              .help = "Cells of the hemisphere in the polar angle.",
              .trade = Trade::LargerIsMoreAccurate},
        Range{1, 1000});
  visit(p.ilv.columns,
        Field{.key = "ilv.columns",
              .label = "Gather columns N",
              .cost = ChangeCost::Vectors,
              .paper = "5.2.1",
              .help = "Cells of the hemisphere around the normal.",
              .trade = Trade::LargerIsMoreAccurate},
        Range{1, 1000});
  visit(p.ilv.nMin,
        Field{.key = "ilv.n_min",
              .label = "Fewest ILVs",
              .paper = "5.5.1",
              .help = "With fewer valid vectors than this, indirect light is computed in full; more smooth "
                      "the picture.",
              .trade = Trade::LargerIsMoreAccurate},
        Range{1, 1000});
  visit(p.ilv.nMax,
        Field{.key = "ilv.n_max",
              .label = "Most ILVs",
              .paper = "5.5.1",
              .help = "The nearest so many valid vectors are used; more smooth the picture."},
        Range{1, 1000});
  visit(p.ilv.nMinLast,
        Field{.key = "ilv.n_min_last",
              .label = "Fewest ILVs in the last pass",
              .help = "The last pass computes in full only where fewer valid vectors than this were found.",
              .trade = Trade::LargerIsMoreAccurate},
        Range{1, 1000});
  visit(p.ilv.sE,
        Field{.key = "ilv.S_E",
              .label = "Irradiance tolerance S_E",
              .paper = "5.4",
              .help = "Largest relative change of irradiance that a vector's gradient may predict (where the "
                      "test is on).",
              .trade = Trade::LargerIsFaster},
        Range{0.0, 1000.0});
  visit(p.ilv.sCurv,
        Field{.key = "ilv.S_curv",
              .label = "Curvature tolerance S_curv",
              .paper = "5.4",
              .help = "Least cosine between the normals of a point and of a vector that may serve it.",
              .trade = Trade::LargerIsMoreAccurate},
        Range{0.0, 1.0});
  visit(p.ilv.curvatureClamp, Field{.key = "ilv.curvature_clamp",
                                    .label = "Clamp S_curv",
                                    .paper = "eq. 7",
                                    .help = "Keeps S_curv at or below 0.999, where the weight would be 0/0 "
                                            "and rounding rejects coplanar vectors."});
  visit(p.ilv.radius,
        Field{.key = "ilv.radius",
              .label = "Mean distance",
              .cost = ChangeCost::Answer,
              .paper = "5.4",
              .help = "The mean of the distances a gather met, from which a vector's radius comes."},
        kIlvRadiusNames);
  visit(p.ilv.radiusScale,
        Field{.key = "ilv.radius_scale",
              .label = "Radius",
              .cost = ChangeCost::Answer,
              .paper = "5.4",
              .help = "A vector is valid within this part of its mean distance.",
              .trade = Trade::LargerIsFaster},
        Range{0.0, 100.0});
  visit(p.ilv.radiusMinPixels,
        Field{.key = "ilv.radius_min",
              .label = "Least radius",
              .unit = "px",
              .cost = ChangeCost::Answer,
              .help = "Radii are at least so many pixels of a picture 256 pixels high, where the vector was "
                      "born; 0 sets no bound.",
              .trade = Trade::LargerIsFaster},
        Range{0.0, 1000.0});
  visit(p.ilv.radiusMaxPixels,
        Field{.key = "ilv.radius_max",
              .label = "Largest radius",
              .unit = "px",
              .cost = ChangeCost::Answer,
              .help = "Radii are at most so many pixels of a picture 256 pixels high, where the vector was "
                      "born; 0 sets no bound.",
              .trade = Trade::LargerIsFaster},
        Range{0.0, 100'000.0});
  visit(p.ilv.radiusMinHit,
        Field{.key = "ilv.radius_min_hit",
              .label = "Radius over least distance",
              .cost = ChangeCost::Answer,
              .help =
                  "Radii are at most so many times the least distance that the gather met; 0 sets no bound.",
              .trade = Trade::LargerIsFaster},
        Range{0.0, 1000.0});
  visit(p.ilv.gradient,
        Field{.key = "ilv.gradient",
              .label = "Gradient",
              .cost = ChangeCost::Vectors,
              .paper = "eq. 6",
              .help = "stratified: Ward and Heckbert's, re-derived for this hemisphere; printed: eq. 6, "
                      "without the change of "
                      "solid angle and occlusion."},
        kIlvGradientNames);
  visit(
      p.ilv.gradientTest,
      Field{
          .key = "ilv.gradient_test",
          .label = "Gradient test",
          .paper = "5.4",
          .help =
              "Whether a predicted change beyond S_E refuses a vector: signed as printed, absolute, or off."},
      kIlvGradientTestNames);
  visit(p.ilv.extrapolate,
        Field{.key = "ilv.extrapolate",
              .label = "Extrapolate",
              .help =
                  "Moves each vector's irradiance to the point along its gradients before it is averaged."});
  visit(p.ilv.gradientLimit,
        Field{.key = "ilv.gradient_limit",
              .label = "Gradient limit",
              .help = "Gradients are shortened until they change a vector's light by no more than this part "
                      "of itself within its radius, and where ilv.radius_min widened that radius; 0 sets no "
                      "limit."},
        Range{0.0, 1000.0});
  visit(p.ilv.extrapolateMin,
        Field{.key = "ilv.extrapolate_min",
              .label = "Least extrapolated part",
              .help = "An extrapolated value is at least this part of the vector's own."},
        Range{0.0, 1.0});
  visit(p.ilv.extrapolateMax,
        Field{.key = "ilv.extrapolate_max",
              .label = "Largest extrapolated part",
              .help = "An extrapolated value is at most this multiple of the vector's own."},
        Range{1.0, 1000.0});
  visit(p.ilv.weight,
        Field{.key = "ilv.weight",
              .label = "ILV weight",
              .paper = "eq. 7",
              .help = "edge: 1 at the vector, 0 at the edge of its validity; absolute: eq. 7 with |AB.grad "
                      "E| / E; printed: "
                      "eq. 7 as it stands."},
        kIlvWeightNames);
  visit(p.ilv.store,
        Field{.key = "ilv.store",
              .label = "What an ILV stores",
              .cost = ChangeCost::Vectors,
              .paper = "eq. 4",
              .help = "split: irradiance shared by all diffuse surfaces, and outgoing radiance of lobes; "
                      "vector: P = L / f(D), "
                      "one tree for each BRDF."},
        kVectorStoreNames);
  visit(p.ilv.inFront, Field{.key = "ilv.in_front",
                             .label = "In-front test",
                             .help = "Refuses vectors that lie in front of the point, where they see what "
                                     "the point does not (Ward 1988).",
                             .trade = Trade::OnIsMoreAccurate});
  visit(p.ilv.visibility, Field{.key = "ilv.visibility",
                                .label = "Visibility test",
                                .help = "One ray to a vector that is farther than half the least distance it "
                                        "met; stops leaks through thin walls.",
                                .trade = Trade::OnIsMoreAccurate});
  visit(p.ilv.visibilityDistance,
        Field{.key = "ilv.visibility_distance",
              .label = "Visibility test from",
              .help = "Vectors nearer than this part of the least distance they met need no ray.",
              .trade = Trade::LargerIsFaster},
        Range{0.0, 1000.0});
  visit(p.ilv.clearance,
        Field{.key = "ilv.clearance",
              .label = "Clearance",
              .help = "A point takes vectors only from within so many times its own distance to what stands "
                      "over it, so that "
                      "light does not creep into gaps; 0 does not test.",
              .trade = Trade::LargerIsFaster},
        Range{0.0, 1000.0});
  visit(p.ilv.lobeAngle,
        Field{.key = "ilv.lobe_angle",
              .label = "Lobe expiry",
              .help =
                  "A lobe's vector expires when the view turns by more than so many half widths of the lobe.",
              .trade = Trade::LargerIsFaster},
        Range{0.01, 100.0});
  visit(p.ilv.seed,
        Field{.key = "ilv.seed",
              .label = "ILV seed",
              .cost = ChangeCost::Vectors,
              .paper = "3.3.1",
              .help =
                  "Vectors computed before the first pass, stratified over the picture and through mirrors.",
              .trade = Trade::LargerIsMoreAccurate},
        Range{0, 10'000'000});
}

}  // namespace lightvane
