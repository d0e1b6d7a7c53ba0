#include "core/render/parameters.h"

namespace lightvane {

void applyPreset(Parameters& p, Preset preset) {
  // The defaults of the structs are `balanced`. docs/method.md states what was measured to choose these.
  const Parameters balanced;
  p.transport.lightSamples = balanced.transport.lightSamples;
  p.picture.lastStride = balanced.picture.lastStride;
  p.vectors.ilv.rows = balanced.vectors.ilv.rows;
  p.vectors.ilv.columns = balanced.vectors.ilv.columns;
  p.vectors.ilv.radiusScale = balanced.vectors.ilv.radiusScale;
  p.vectors.ilv.nMin = balanced.vectors.ilv.nMin;
  switch (preset) {
    case Preset::Draft:
      p.transport.lightSamples = 4;
      p.picture.lastStride = 4;
      p.vectors.ilv.rows = 8;
      p.vectors.ilv.columns = 16;
      p.vectors.ilv.nMin = 2;
      p.vectors.ilv.radiusScale = 0.5;
      break;
    case Preset::Balanced:
      break;
    case Preset::Fine:
      p.picture.lastStride = 1;
      p.vectors.ilv.rows = 20;
      p.vectors.ilv.columns = 40;
      p.vectors.ilv.radiusScale = 0.3;
      break;
  }
}

}  // namespace lightvane
