// The previewer's part in what the Trade panel measures and shows.

#include "app/previewer.h"

namespace lightvane {

std::optional<TradeSubject> Previewer::tradeSubject() const {
  if (!document_) return std::nullopt;
  // All light as it is set: a picture whose indirect light lags behind has no reference.
  const std::vector<Rgb> lights = lightFactors();
  return TradeSubject{document_, compiledCamera(), workspace_.setup.parameters, {lights, lights}};
}

TradeStatus Previewer::tradeStatus() const {
  TradeStatus status = trade_.status(tradeSubject());
  if (tradePicture_) status.shown = tradePicture_->point;
  return status;
}

void Previewer::carryOutTrade(const PanelOutput& output) {
  if (output.useTradeReference) trade_.useReference();
  if (output.stopTrade) trade_.stop();
  if (output.clearTrade || output.measureTrade) {
    trade_.clear();
    tradePicture_.reset();
    if (workspace_.display.comparison.with == CompareWith::Point) workspace_.display.comparison = {};
  }
  const auto subject = tradeSubject();
  if (output.measureTrade && subject) trade_.start(*output.measureTrade, *subject);
  if (output.showTradePoint) showTradePoint(*output.showTradePoint);
}

void Previewer::showTradePoint(std::size_t point) {
  const auto picture = trade_.picture(point);
  const TradeStatus status = trade_.status(std::nullopt);
  if (!picture || !status.sweep || point >= status.sweep->points.size()) return;
  tradePicture_.emplace(TradePicture{point, RivalPicture(*picture, {}), trade_.reduction(),
                                     status.sweep->points[point].name()});
  Comparison& comparison = workspace_.display.comparison;
  comparison.with = CompareWith::Point;
  // Where pictures are compared already, it takes the other's place there.
  if (comparison.mode == CompareMode::Off) comparison.flipped = true;
}

}  // namespace lightvane
