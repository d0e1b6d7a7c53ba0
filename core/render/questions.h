#pragma once

#include "core/base/random.h"
#include "core/render/film.h"
#include "core/render/parameters.h"
#include "core/scene/scene.h"

namespace lightvane {

/// Names all that decides which points of a picture ask for vectors of a kind, and what they make of those
/// that there are: the view, and every parameter but those of the other kind and of the rivals. Vectors that
/// have settled the questions of a name (RecordSet::settles) are all that a rendering needs.
struct Questions {
  RandomKey indirect;
  RandomKey direct;
};
Questions questionsOf(const Camera& camera, const PictureRegion& region, const Parameters& parameters);

}  // namespace lightvane
