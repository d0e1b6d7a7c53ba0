#pragma once

#include <cstdint>
#include <optional>

#include "core/scene/description.h"
#include "core/scene/scene.h"

namespace lightvane {

/// The scene with one of its lights alone, or with none: the others' shapes stay where they are and emit
/// nothing, so that they cost nothing but hide what they hid. `scene` is what `description` compiles to, and
/// `light` one of its lights.
SceneDescription litOnlyBy(const SceneDescription& description, const Scene& scene,
                           std::optional<std::uint32_t> light);

}  // namespace lightvane
