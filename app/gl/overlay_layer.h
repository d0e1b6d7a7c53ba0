#pragma once

#include <memory>
#include <vector>

#include "app/gl/framebuffer.h"
#include "app/gl/shaders.h"
#include "core/image/image.h"
#include "core/inspect/overlay.h"
#include "core/scene/scene.h"

namespace lightvane {

/// How overlays are drawn, whatever they show.
struct OverlayPen {
  float uiScale = 1.0f;   ///< sizes in pixels are multiplied by it
  float zoneFill = 0.5f;  ///< opacity of a zone's inside, as a part of its colour's; the outline has it all
  float zoneRim = 0.75f;  ///< opacity of a zone's rim, likewise
  float behind = 0.25f;   ///< opacity of what lies behind a surface, as a part of its own
  /// What is farther than the surface by less than this part of its distance lies on it: well above the
  /// rounding of single precision and the sagitta of a small zone on a curved surface, well below what an eye
  /// tells apart. Of the picture's height where the camera is orthographic.
  float onSurface = 2e-3f;

  bool operator==(const OverlayPen&) const = default;
};

/// All that an overlay's picture depends on. Values behind pointers do not change: another value is another
/// pointer.
struct OverlayView {
  std::vector<std::shared_ptr<const OverlayBatch>> batches;  ///< the last one on top; none is null
  /// Camera::distanceTo what each pixel shows, normalised units; infinity where that is nothing. Of the
  /// camera's size. Null: nothing lies behind anything.
  std::shared_ptr<const ImageFloat> depth;
  Camera camera;
  Placement placement;  ///< of the picture that this camera made
  OverlayPen pen;
};

/// Draws overlays into a picture of its own, which is drawn anew only when what it shows has changed: under a
/// software GL, ten thousand zones cost a hundred times as much as laying that picture over another. On the
/// GL thread.
class OverlayLayer {
 public:
  static Expected<OverlayLayer> create(const Gl& gl, const ShaderSources& sources);

  /// Brings the overlay's picture up to date; returns whether it had to be drawn. Nothing is drawn outside of
  /// the camera's picture.
  bool update(const OverlayView& view);

  /// Lays the overlay over the target, at the placement of the last update, or over this part of its width
  /// from the left. `opacity` costs no drawing.
  void composite(const Framebuffer& target, float opacity, float part = 1.0f) const;

 private:
  /// One batch on the card.
  struct Uploaded {
    std::shared_ptr<const OverlayBatch> batch;
    GlBuffer zoneData, lineData, markerData;
    GlVertexArray zones, lines, markers;
  };
  struct Programs {
    ShaderProgram zone, line, marker, composite;
  };

  OverlayLayer(const Gl& gl, Programs programs);
  Uploaded upload(std::shared_ptr<const OverlayBatch> batch) const;
  void uploadDepth();
  void useWithView(const ShaderProgram& program) const;
  void draw() const;

  const Gl* gl_;
  Programs programs_;
  GlVertexArray corners_;  // without attributes
  GlTexture depth_;
  OverlayView view_;
  std::vector<Uploaded> batches_;
  std::unique_ptr<Framebuffer> picture_;  // null until the first update
};

}  // namespace lightvane
