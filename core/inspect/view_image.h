#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/inspect/color_map.h"
#include "core/inspect/error_source.h"
#include "core/inspect/miss_reason.h"
#include "core/render/error_estimate.h"
#include "core/render/render_frame.h"

namespace lightvane {

/// What the window can show of a frame; on the keys 1 to 9, then by list.
enum class PictureView : std::uint8_t {
  Beauty,
  Direct,
  Indirect,
  Specular,
  WhereComputed,   ///< seed, full ILV, full DLV, interpolated; misses by the rule that made them
  VectorsUsed,     ///< ILVs that answered the pixel's first visible point
  NearestRecord,   ///< distance to the nearest ILV used
  Error,           ///< against a reference
  EstimatedError,  ///< as the vectors themselves tell it
  ErrorSources,    ///< where it comes from: the largest source, or what one of them adds
  Albedo,
  Normal,
  Depth
};

/// How the numbers of a view become colours.
enum class ViewKind : std::uint8_t {
  Radiance,   ///< three values a pixel, scene units: exposure and tone mapping apply
  Color,      ///< three values in [0, 1] a pixel, shown as they are (linear)
  Scalar,     ///< one value a pixel, through a colour map; NaN where there is none
  Categories  ///< one value a pixel: index into `categories`; NaN where there is none
};

struct ViewScale {
  ColorMap map = ColorMap::Viridis;
  float low = 0.0f;
  float high = 1.0f;
  bool logarithmic = false;
};

struct ViewCategory {
  std::string name;
  Color8 color;
  bool occurs = false;  ///< some value is of it: what a legend need not explain it leaves out
};

/// One view of a frame as numbers; without values where the frame has nothing to show: `title` then says why.
/// Values run row by row from the top left, in the units that `unit` says.
struct ViewImage {
  PictureView view = PictureView::Beauty;
  ViewKind kind = ViewKind::Radiance;
  int width = 0;
  int height = 0;
  std::string title;
  std::string unit;
  std::vector<float> values;
  ViewScale scale;  ///< of Scalar
  /// Of Categories; of the view Normal, what its colours stand for.
  std::vector<ViewCategory> categories;

  bool empty() const { return values.empty(); }
  int channels() const { return kind == ViewKind::Radiance || kind == ViewKind::Color ? 3 : 1; }
  const float* pixel(int x, int y) const {
    return &values[(static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                    static_cast<std::size_t>(x)) *
                   static_cast<std::size_t>(channels())];
  }
};

/// What lists and settings say about a view.
struct PictureViewInfo {
  PictureView view;
  const char* name;   ///< "where-computed": of files and command lines
  const char* label;  ///< "Where computed"
  const char* help;   ///< one sentence
};
/// All that WhereComputed can show, in the order of its values. `occurs` is not set.
std::vector<ViewCategory> whereCategories();

/// All views, in the order of PictureView.
std::span<const PictureViewInfo> pictureViews();
const PictureViewInfo& pictureViewInfo(PictureView view);
std::optional<PictureView> pictureViewNamed(std::string_view name);
/// Whether the view tells of light vectors: other methods, and the rules `printed`, have none to tell of.
bool tellsOfVectors(PictureView view);

/// What the Error view holds a frame against.
struct ErrorBase {
  /// A beauty picture in the scene's units (as picture files have it), of the frame's size, or of the size
  /// that a coarse frame is a first look at. Null where there is none.
  std::shared_ptr<const ImageRgb> picture;
  /// What it is called ("the reference"); without a picture, why there is none.
  std::string name = "there is no reference to compare with";

  bool operator==(const ErrorBase&) const = default;
};

struct ErrorSources;

/// What some views are made from, beside the frame.
struct ViewSources {
  ErrorBase base = {};  ///< of Error
  const std::vector<ComputedVector>* computed =
      nullptr;                                 ///< computedVectors(frame), where the caller kept them
  const ErrorEstimate* estimate = nullptr;     ///< of EstimatedError: likewise estimateError(frame)
  const ErrorSources* errorSources = nullptr;  ///< of ErrorSources, without which there is nothing to see
  std::optional<ErrorSource> source = {};      ///< likewise: the one that is shown; else which is the largest
};

/// The view of a frame. Radiance is in the scene's own units, lengths in the scene's unit of length. Pure;
/// any thread. Cost: milliseconds for 512 x 512 pixels, and for WhereComputed and EstimatedError what
/// computedVectors and estimateError cost where the caller does not have theirs.
ViewImage viewImage(const RenderFrame& frame, PictureView view, const ViewSources& sources = {});

/// The beauty view of a picture from a file, in the scene's units.
ViewImage viewOfPicture(const ImageRgb& beauty);

/// The numbers of a pixel without their unit, one to a line; the name of a category; empty where it has none.
std::vector<std::string> viewValueLines(const ViewImage& image, int x, int y);
/// The value of a pixel with its unit, or its category's name; "none" where there is none.
std::string viewValueText(const ViewImage& image, int x, int y);

}  // namespace lightvane
