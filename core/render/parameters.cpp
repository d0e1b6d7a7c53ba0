#include "core/render/parameters.h"

namespace lightvane {

void applyPreset(Parameters& p, Preset preset) {
  // The defaults of the structs are `balanced`. docs/method.md states what was measured to choose these.
  const Parameters balanced;
  IlvParameters& ilv = p.vectors.ilv;
  p.transport.lightSamples = balanced.transport.lightSamples;
  p.picture.lastStride = balanced.picture.lastStride;
  ilv.rows = balanced.vectors.ilv.rows;
  ilv.columns = balanced.vectors.ilv.columns;
  switch (preset) {
    case Preset::Draft:
      p.transport.lightSamples = 4;
      p.picture.lastStride = 4;
      ilv.rows = 8;
      ilv.columns = 16;
      break;
    case Preset::Balanced:
      break;
    case Preset::Fine:
      p.picture.lastStride = 1;
      ilv.rows = 20;
      ilv.columns = 40;
      break;
  }
  // The paper's thresholds are part of its rules: a preset must not turn them into ours.
  if (p.vectors.rules != Rules::Refined) return;
  ilv.nMin = preset == Preset::Draft ? 2 : balanced.vectors.ilv.nMin;
  ilv.radiusScale = preset == Preset::Draft  ? 0.5
                    : preset == Preset::Fine ? 0.3
                                             : balanced.vectors.ilv.radiusScale;
}

}  // namespace lightvane
