#include "core/render/tile_answers.h"

namespace lightvane {

void TileAnswers::resize(std::size_t points, std::size_t slots) {
  looked.assign(points, 0);
  sampled.assign(points, 0);
  satisfied.assign(points, 0);
  answered.assign(points, 0);
  fullDlv.assign(points, 0);
  lightDirect.assign(slots * points, Rgb(0.0f));
  lightState.assign(slots * points, Unknown);
  lightReason.assign(slots * points, NotInFull);
  mirrored.assign(points, Rgb(0.0f));
  indirect.assign(2 * points, Rgb(0.0f));
  own.assign(2 * points, 0);
  ilvCount.assign(points, 0);
  nearest.assign(points, 0xffffffffU);
}

}  // namespace lightvane
