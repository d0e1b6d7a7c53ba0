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
  lights.clear();
}

void TileAnswers::addLight(std::uint32_t light) {
  lights.push_back(light);
  const std::size_t points = looked.size();
  lightDirect.resize(lightDirect.size() + points, Rgb(0.0f));
  lightReason.resize(lightReason.size() + points, NotInFull);
  for (std::size_t i = 0; i < points; ++i) lightState.push_back(sampled[i] != 0 ? Faint : Unknown);
}

void TileAnswers::take(std::size_t to, const TileAnswers& others, std::size_t from) {
  const std::size_t points = looked.size();
  const std::size_t othersPoints = others.looked.size();
  for (auto array : {&TileAnswers::looked, &TileAnswers::sampled, &TileAnswers::satisfied,
                     &TileAnswers::answered, &TileAnswers::fullDlv})
    (this->*array)[to] = (others.*array)[from];
  mirrored[to] = others.mirrored[from];
  ilvCount[to] = others.ilvCount[from];
  nearest[to] = others.nearest[from];
  for (std::size_t key = 0; key < 2; ++key) {
    indirect[key * points + to] = others.indirect[key * othersPoints + from];
    own[key * points + to] = others.own[key * othersPoints + from];
  }
  for (std::size_t slot = 0; slot * points < lightDirect.size(); ++slot) {
    lightDirect[slot * points + to] = others.lightDirect[slot * othersPoints + from];
    lightState[slot * points + to] = others.lightState[slot * othersPoints + from];
    lightReason[slot * points + to] = others.lightReason[slot * othersPoints + from];
  }
}

}  // namespace lightvane
