#pragma once

#include "app/document.h"
#include "app/picture_metadata.h"
#include "core/io/cache_file.h"
#include "core/render/render_frame.h"

namespace lightvane {

/// What a frame of the document is a function of, but for the vectors that it began with. `camera` is what
/// the frame shows, as it was asked for, to the last digit: one of the scene's where it is one, else the
/// first with what differs.
PictureIdentity pictureIdentity(const RenderFrame& frame, const Document& document,
                                const CameraDescription& camera, const PictureLook& look);

/// What the frame's vectors belong to.
CacheIdentity cacheIdentity(const RenderFrame& frame, const Document& document);

}  // namespace lightvane
