#include "core/render/questions.h"

#include <string_view>

namespace lightvane {

Questions questionsOf(const Camera& camera, const PictureRegion& region, const Parameters& parameters) {
  RandomKey view = RandomKey{}
                       .with(camera.position)
                       .with(camera.right)
                       .with(camera.up)
                       .with(camera.forward)
                       .with(camera.tanHalfFovY);
  // Nothing more for a pinhole: what was settled of one in a cache file stays so. What follows is a length in
  // pixels, which a tag's bits are not.
  constexpr std::uint32_t kOrthographicTag = 0x6f727468U, kLensTag = 0x6c656e73U;
  if (camera.isOrthographic()) view = view.with(kOrthographicTag).with(camera.halfHeight);
  if (camera.hasLens()) view = view.with(kLensTag).with(camera.lensRadius).with(camera.focusDistance);
  for (const int length :
       {region.fullWidth, region.fullHeight, region.x, region.y, region.width, region.height})
    view = view.with(static_cast<std::uint32_t>(length));
  Questions questions{view, view};
  const auto add = [](RandomKey& name, std::string_view value) {
    for (const char letter : value) name = name.with(static_cast<std::uint32_t>(letter));
    name = name.with(0U);  // where it ends
  };
  for (const FieldDescription& described : describeParameters(parameters)) {
    const std::string_view key = described.field.key;
    const bool isOfRivals =
        key.starts_with("path.") || key.starts_with("naive.") || key.starts_with("direct.");
    if (isOfRivals) continue;
    if (!key.starts_with("dlv.")) add(questions.indirect, described.value);
    if (!key.starts_with("ilv.")) add(questions.direct, described.value);
  }
  return questions;
}

}  // namespace lightvane
