#include "core/vectors/parameters.h"

namespace lightvane {

void applyRules(VectorParameters& p, Rules rules) {
  const VectorParameters refined;
  DlvParameters& dlv = p.dlv;
  IlvParameters& ilv = p.ilv;
  const bool ours = rules == Rules::Refined;
  const bool printed = rules == Rules::Printed;
  p.rules = rules;

  dlv.rMax = ours ? refined.dlv.rMax : Length::metres(0.08);
  dlv.dispersion = ours ? refined.dlv.dispersion : 0.2;
  dlv.dispersionMeasure = printed ? DlvDispersion::VarianceAbove : DlvDispersion::Variation;
  dlv.weight = printed ? DlvWeight::Printed : DlvWeight::Normalised;
  dlv.normalCosine = ours ? refined.dlv.normalCosine : -1.0;
  dlv.normaliseDirection = !printed;
  dlv.store = ours ? VectorStore::Split : VectorStore::Vector;

  ilv.nMin = ours ? refined.ilv.nMin : 3;
  ilv.nMinLast = ours ? refined.ilv.nMinLast : 3;
  ilv.curvatureClamp = !printed;
  ilv.radius = ours ? IlvRadius::Harmonic : IlvRadius::Arithmetic;
  ilv.radiusScale = ours ? refined.ilv.radiusScale : 1.0;
  ilv.radiusMinPixels = ours ? refined.ilv.radiusMinPixels : 0.0;
  ilv.radiusMaxPixels = ours ? refined.ilv.radiusMaxPixels : 0.0;
  ilv.radiusMinHit = ours ? refined.ilv.radiusMinHit : 0.0;
  ilv.gradient = ours ? IlvGradient::Stratified : IlvGradient::Printed;
  ilv.gradientTest = ours      ? IlvGradientTest::Off
                     : printed ? IlvGradientTest::Signed
                               : IlvGradientTest::Absolute;
  ilv.extrapolate = ours;
  ilv.weight = ours ? IlvWeight::Edge : printed ? IlvWeight::Printed : IlvWeight::Absolute;
  ilv.store = ours ? VectorStore::Split : VectorStore::Vector;
  ilv.inFront = ours;
  ilv.visibility = ours;
  ilv.clearance = ours ? refined.ilv.clearance : 0.0;
}

}  // namespace lightvane
