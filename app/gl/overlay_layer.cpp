#include "app/gl/overlay_layer.h"

#include <cmath>
#include <cstddef>
#include <type_traits>

namespace lightvane {
namespace {

/// But for the exposure, which is the picture's business.
bool sameCamera(Camera a, const Camera& b) {
  a.exposureStops = b.exposureStops;
  return a == b;
}

bool sameView(const OverlayView& a, const OverlayView& b) {
  return a.batches == b.batches && a.depth == b.depth && sameCamera(a.camera, b.camera) &&
         a.placement == b.placement && a.pen == b.pen;
}

/// Attributes of one instance of `Item`, read where they lie in the batch's own memory.
template <class Item>
class InstanceFormat {
  static_assert(std::is_standard_layout_v<Item> && std::is_trivially_copyable_v<Item>);

 public:
  /// Leaves the vertex array bound.
  InstanceFormat(const Gl& gl, const GlVertexArray& array, const GlBuffer& buffer,
                 const std::vector<Item>& items)
      : gl_(gl) {
    gl.BindVertexArray(array.id());
    gl.BindBuffer(GL_ARRAY_BUFFER, buffer.id());
    gl.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(items.size() * sizeof(Item)), items.data(),
                  GL_STATIC_DRAW);
  }

  void floats(GLuint location, int count, std::size_t offset) const {
    gl_.VertexAttribPointer(location, count, GL_FLOAT, GL_FALSE, sizeof(Item), inBuffer(offset));
    each(location);
  }
  void color(GLuint location, std::size_t offset) const {
    gl_.VertexAttribPointer(location, 4, GL_UNSIGNED_BYTE, GL_TRUE, sizeof(Item), inBuffer(offset));
    each(location);
  }
  void byte(GLuint location, std::size_t offset) const {
    gl_.VertexAttribIPointer(location, 1, GL_UNSIGNED_BYTE, sizeof(Item), inBuffer(offset));
    each(location);
  }

 private:
  void each(GLuint location) const {
    gl_.EnableVertexAttribArray(location);
    gl_.VertexAttribDivisor(location, 1);
  }

  const Gl& gl_;
};

/// The place of a point along one of the camera's axes, from its position, as a product with (point, 1).
glm::vec4 placeAlong(const Camera& camera, const Vec3& axis) {
  return {axis, -glm::dot(axis, camera.position)};
}

/// From the world to the clip space of the area: Camera::project, then the placement, for a viewport that is
/// the area. w is what lengths are divided by on the screen: the distance along the viewing axis, or 1 where
/// the camera is orthographic; z is nothing, since overlays go by the depth of the picture.
glm::mat4 worldToClip(const Camera& camera, const Placement& placement) {
  const glm::vec4 w =
      camera.isOrthographic() ? glm::vec4(0.0f, 0.0f, 0.0f, 1.0f) : placeAlong(camera, camera.forward);
  const float pixels =
      placement.zoom / camera.pixelWidth(1.0f);  // of the area, for a length of 1 where w is 1
  const Vec2 axis = placement.offset + 0.5f * placement.zoom * Vec2(camera.width, camera.height);
  const Vec2 area(placement.width, placement.height);
  const glm::vec4 x =
      2.0f * pixels / area.x * placeAlong(camera, camera.right) + (2.0f * axis.x / area.x - 1.0f) * w;
  const glm::vec4 y =
      2.0f * pixels / area.y * placeAlong(camera, camera.up) + (1.0f - 2.0f * axis.y / area.y) * w;
  return glm::transpose(glm::mat4(x, y, glm::vec4(0.0f), w));
}

/// The farthest of each pixel and its eight neighbours. A point's own pixel holds the surface where the
/// pixel's ray met it, which on a floor seen at a grazing angle is far from the point itself, but between the
/// neighbours'.
ImageFloat farthestAround(const ImageFloat& depth) {
  ImageFloat along(depth.width(), depth.height()), around(depth.width(), depth.height());
  for (int y = 0; y < depth.height(); ++y) {
    for (int x = 0; x < depth.width(); ++x) {
      along.at(x, y) = std::max(
          {depth.at(std::max(x - 1, 0), y), depth.at(x, y), depth.at(std::min(x + 1, depth.width() - 1), y)});
    }
  }
  for (int y = 0; y < depth.height(); ++y) {
    for (int x = 0; x < depth.width(); ++x) {
      around.at(x, y) = std::max({along.at(x, std::max(y - 1, 0)), along.at(x, y),
                                  along.at(x, std::min(y + 1, depth.height() - 1))});
    }
  }
  return around;
}

}  // namespace

OverlayLayer::OverlayLayer(const Gl& gl, Programs programs)
    : gl_(&gl), programs_(std::move(programs)), corners_(gl) {}

Expected<OverlayLayer> OverlayLayer::create(const Gl& gl, const ShaderSources& sources) {
  Expected<ShaderProgram> zone = ShaderProgram::build(gl, sources, "overlay_zone.vert", "overlay_zone.frag");
  if (!zone) return tl::unexpected(zone.error());
  Expected<ShaderProgram> line = ShaderProgram::build(gl, sources, "overlay_line.vert", "overlay_line.frag");
  if (!line) return tl::unexpected(line.error());
  Expected<ShaderProgram> marker =
      ShaderProgram::build(gl, sources, "overlay_marker.vert", "overlay_marker.frag");
  if (!marker) return tl::unexpected(marker.error());
  Expected<ShaderProgram> composite = ShaderProgram::build(gl, sources, "screen.vert", "composite.frag");
  if (!composite) return tl::unexpected(composite.error());
  return OverlayLayer(gl, {std::move(*zone), std::move(*line), std::move(*marker), std::move(*composite)});
}

bool OverlayLayer::update(const OverlayView& view) {
  const bool first = picture_ == nullptr;
  if (!first && sameView(view, view_)) return false;
  LV_CHECK(view.depth == nullptr ||
               (view.depth->width() == view.camera.width && view.depth->height() == view.camera.height),
           "the depth is {} x {}, the camera's picture {} x {}", view.depth->width(), view.depth->height(),
           view.camera.width, view.camera.height);
  const bool newDepth = first || view.depth != view_.depth;
  view_ = view;
  if (newDepth) uploadDepth();

  std::vector<Uploaded> batches;
  for (const std::shared_ptr<const OverlayBatch>& batch : view_.batches) {
    const auto known = std::ranges::find(batches_, batch, &Uploaded::batch);
    if (known == batches_.end()) {
      batches.push_back(upload(batch));
    } else {
      batches.push_back(std::move(*known));
    }
  }
  batches_ = std::move(batches);

  const int width = std::max(view_.placement.width, 1), height = std::max(view_.placement.height, 1);
  if (first || picture_->width() != width || picture_->height() != height) {
    picture_ = std::make_unique<Framebuffer>(*gl_, width, height);
  }
  draw();
  return true;
}

OverlayLayer::Uploaded OverlayLayer::upload(std::shared_ptr<const OverlayBatch> batch) const {
  Uploaded u{std::move(batch),    GlBuffer(*gl_),      GlBuffer(*gl_),     GlBuffer(*gl_),
             GlVertexArray(*gl_), GlVertexArray(*gl_), GlVertexArray(*gl_)};
  {
    const InstanceFormat<OverlayZone> format(*gl_, u.zones, u.zoneData, u.batch->zones);
    format.floats(0, 3, offsetof(OverlayZone, centre));
    format.floats(1, 3, offsetof(OverlayZone, axisU));
    format.floats(2, 3, offsetof(OverlayZone, axisV));
    format.floats(3, 2, offsetof(OverlayZone, cutU));    // cutU, cutV
    format.floats(4, 2, offsetof(OverlayZone, cutLow));  // cutLow, cutHigh
    format.floats(5, 1, offsetof(OverlayZone, rim));
    format.color(6, offsetof(OverlayZone, color));
  }
  {
    const InstanceFormat<OverlayLine> format(*gl_, u.lines, u.lineData, u.batch->lines);
    format.floats(0, 3, offsetof(OverlayLine, from));
    format.floats(1, 3, offsetof(OverlayLine, to));
    format.floats(2, 1, offsetof(OverlayLine, widthPixels));
    format.color(3, offsetof(OverlayLine, color));
    format.byte(4, offsetof(OverlayLine, head));
  }
  {
    const InstanceFormat<OverlayMarker> format(*gl_, u.markers, u.markerData, u.batch->markers);
    format.floats(0, 3, offsetof(OverlayMarker, position));
    format.floats(1, 1, offsetof(OverlayMarker, sizePixels));
    format.color(2, offsetof(OverlayMarker, color));
    format.byte(3, offsetof(OverlayMarker, shape));
    format.byte(4, offsetof(OverlayMarker, inMirror));
  }
  return u;
}

void OverlayLayer::uploadDepth() {
  const ImageFloat depth = view_.depth ? farthestAround(*view_.depth) : ImageFloat(1, 1, kInfinity);
  depth_ = makeTexture(*gl_, GL_NEAREST);
  gl_->PixelStorei(GL_UNPACK_ALIGNMENT, 4);
  gl_->TexImage2D(GL_TEXTURE_2D, 0, GL_R32F, depth.width(), depth.height(), 0, GL_RED, GL_FLOAT,
                  depth.data());
}

void OverlayLayer::useWithView(const ShaderProgram& program) const {
  const Placement& placement = view_.placement;
  program.use();
  program.set("worldToClip", worldToClip(view_.camera, placement));
  program.set("eye", view_.camera.position);
  program.set("forward", view_.camera.forward);
  program.set("pictureHeight", 2.0f * view_.camera.halfHeight);
  program.set("areaSize", Vec2(placement.width, placement.height));
  program.set("corner", Vec2(placement.offset.x, static_cast<float>(placement.height) - placement.offset.y));
  program.set("zoom", placement.zoom);
  program.set("uiScale", view_.pen.uiScale);
  program.set("depth", 0);
  program.set("behind", view_.pen.behind);
  program.set("onSurface", view_.pen.onSurface);
}

void OverlayLayer::draw() const {
  const auto count = [](const auto& items) { return static_cast<GLsizei>(items.size()); };
  picture_->clear({0, 0, 0, 0});
  gl_->ActiveTexture(GL_TEXTURE0);
  gl_->BindTexture(GL_TEXTURE_2D, depth_.id());
  blendPremultiplied(*gl_);

  // The camera's picture: an overlay is about what is in it.
  const Vec2 size(view_.camera.width, view_.camera.height);
  const glm::ivec2 lower(glm::floor(view_.placement.offset));
  const glm::ivec2 upper(glm::ceil(view_.placement.offset + view_.placement.zoom * size));
  gl_->Enable(GL_SCISSOR_TEST);
  gl_->Scissor(lower.x, picture_->height() - upper.y, upper.x - lower.x, upper.y - lower.y);
  for (const Uploaded& uploaded : batches_) {
    const OverlayBatch& batch = *uploaded.batch;
    useWithView(programs_.zone);
    programs_.zone.set("fillOpacity", view_.pen.zoneFill);
    programs_.zone.set("rimOpacity", view_.pen.zoneRim);
    gl_->BindVertexArray(uploaded.zones.id());
    gl_->DrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, count(batch.zones));
    useWithView(programs_.line);
    gl_->BindVertexArray(uploaded.lines.id());
    gl_->DrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, count(batch.lines));
    useWithView(programs_.marker);
    gl_->BindVertexArray(uploaded.markers.id());
    gl_->DrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, count(batch.markers));
  }
  gl_->Disable(GL_SCISSOR_TEST);
}

void OverlayLayer::composite(const Framebuffer& target, float opacity, float part) const {
  if (picture_ == nullptr || batches_.empty()) return;
  const Placement& placement = view_.placement;
  target.bind(placement);
  blendPremultiplied(*gl_);
  gl_->ActiveTexture(GL_TEXTURE0);
  gl_->BindTexture(GL_TEXTURE_2D, picture_->texture().id());
  programs_.composite.use();
  programs_.composite.set("layer", 0);
  programs_.composite.set("corner", Vec2(placement.left, target.height() - placement.top - placement.height));
  programs_.composite.set("opacity", opacity);
  gl_->BindVertexArray(corners_.id());
  gl_->Enable(GL_SCISSOR_TEST);
  gl_->Scissor(placement.left, target.height() - placement.top - placement.height,
               static_cast<GLint>(std::lround(part * static_cast<float>(placement.width))), placement.height);
  gl_->DrawArrays(GL_TRIANGLES, 0, 3);
  gl_->Disable(GL_SCISSOR_TEST);
}

}  // namespace lightvane
