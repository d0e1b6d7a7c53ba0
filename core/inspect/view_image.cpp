#include "core/inspect/view_image.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/inspect/error_sources.h"
#include "core/inspect/picture_style.h"
#include "core/inspect/units.h"

namespace lightvane {
namespace {

constexpr float kNoValue = std::numeric_limits<float>::quiet_NaN();

// Relative errors are of luminance + this part of the reference's mean luminance, so that black corners do
// not outshine everything.
constexpr double kErrorFloor = 0.01;

/// What is added to luminances that errors are relative to, where so much is their mean. Above 0: to an
/// all-black picture any light is an error without bound, none is no error.
double errorFloor(double meanLuminance) {
  return std::max(kErrorFloor * meanLuminance, static_cast<double>(std::numeric_limits<float>::min()));
}

ViewImage emptyView(PictureView view, const std::string& why) {
  ViewImage image;
  image.view = view;
  image.title = std::string(pictureViewInfo(view).label) + ": " + why;
  return image;
}

ViewImage newView(const RenderFrame& frame, PictureView view, ViewKind kind, std::string unit) {
  ViewImage image;
  image.view = view;
  image.kind = kind;
  image.width = frame.film->width;
  image.height = frame.film->height;
  image.title = pictureViewInfo(view).label;
  image.unit = std::move(unit);
  const std::size_t pixels = frame.film->depth().size();
  image.values.resize(pixels * static_cast<std::size_t>(image.channels()));
  return image;
}

/// The value below which `part` of the finite values lie, from at most some ten thousand of them, evenly
/// spread; 0 where there is none.
float percentile(const std::vector<float>& values, double part, bool ofMagnitude = false) {
  constexpr std::size_t kMost = 1 << 14;
  const std::size_t step = std::max<std::size_t>(1, values.size() / kMost);
  std::vector<float> sample;
  sample.reserve(values.size() / step + 1);
  for (std::size_t i = 0; i < values.size(); i += step) {
    if (std::isfinite(values[i])) sample.push_back(ofMagnitude ? std::abs(values[i]) : values[i]);
  }
  if (sample.empty()) return 0.0f;
  const auto rank = static_cast<std::ptrdiff_t>(part * static_cast<double>(sample.size() - 1));
  std::nth_element(sample.begin(), sample.begin() + rank, sample.end());
  return sample[static_cast<std::size_t>(rank)];
}

/// The least of 1, 2, 5, 10, ... times a power of ten that is not below `value`: ends of scales that can be
/// read.
float roundUp(float value) {
  if (!(value > 0.0f)) return 1.0f;
  const double power = std::pow(10.0, std::floor(std::log10(static_cast<double>(value))));
  for (const double step : {1.0, 2.0, 5.0}) {
    if (step * power >= value) return static_cast<float>(step * power);
  }
  return static_cast<float>(10.0 * power);
}

template <class ValueOf>
ViewImage radianceView(const RenderFrame& frame, PictureView view, const ValueOf& valueOf) {
  ViewImage image = newView(frame, view, ViewKind::Radiance, kRadianceUnit);
  const float scale = frame.scene->normalisation.radianceScale();
  for (std::size_t i = 0; i < frame.film->depth().size(); ++i) {
    const Rgb value = scale * valueOf(i);
    std::copy_n(&value[0], 3, &image.values[3 * i]);
  }
  return image;
}

template <class ValueOf>
ViewImage colorView(const RenderFrame& frame, PictureView view, const ValueOf& valueOf) {
  ViewImage image = newView(frame, view, ViewKind::Color, "");
  for (std::size_t i = 0; i < frame.film->depth().size(); ++i) {
    const Rgb value = glm::clamp(valueOf(i), 0.0f, 1.0f);
    std::copy_n(&value[0], 3, &image.values[3 * i]);
  }
  return image;
}

bool isMet(const Film& film, std::size_t i) { return film.depth()[i] < kInfinity; }

Vec3 colorOfNormal(const Vec3& normal) { return 0.5f * normal + 0.5f; }

ViewImage normalView(const RenderFrame& frame) {
  const Film& film = *frame.film;
  ViewImage image = colorView(frame, PictureView::Normal, [&](std::size_t i) {
    return isMet(film, i) ? colorOfNormal(film.normal()[i]) : Vec3(0.0f);
  });
  constexpr const char* kAxes[3] = {"x", "y", "z"};
  for (int axis = 0; axis < 3; ++axis) {
    for (const float sign : {1.0f, -1.0f}) {
      Vec3 normal(0.0f);
      normal[axis] = sign;
      image.categories.push_back({fmt::format("towards {}{}", sign < 0.0f ? '-' : '+', kAxes[axis]),
                                  screenColor(colorOfNormal(normal)), true});
    }
  }
  return image;
}

ViewImage depthView(const RenderFrame& frame) {
  ViewImage image = newView(frame, PictureView::Depth, ViewKind::Scalar, lengthUnit(*frame.scene));
  const Film& film = *frame.film;
  const auto unit = static_cast<float>(frame.scene->normalisation.sceneLength(1.0));
  for (std::size_t i = 0; i < film.depth().size(); ++i)
    image.values[i] = isMet(film, i) ? unit * film.depth()[i] : kNoValue;
  image.scale = {ColorMap::Grey, percentile(image.values, 0.005), percentile(image.values, 0.995)};
  if (!(image.scale.high > image.scale.low)) image.scale.high = image.scale.low + 1.0f;
  return image;
}

/// Why a frame has no vectors to show.
std::string whyNoVectors(const RenderFrame& frame) {
  const bool isPrinted =
      frame.parameters.picture.method == Method::Vectors && frame.parameters.vectors.rules == Rules::Printed;
  return isPrinted ? "the rules `printed` keep their vectors to themselves" : "no vectors in this method";
}

ViewImage vectorsUsedView(const RenderFrame& frame) {
  if (!frame.points) return emptyView(PictureView::VectorsUsed, whyNoVectors(frame));
  ViewImage image = newView(frame, PictureView::VectorsUsed, ViewKind::Scalar, "ILVs");
  const Film& film = *frame.film;
  float most = 1.0f;
  for (std::size_t i = 0; i < film.depth().size(); ++i) {
    image.values[i] = film.ilvCount[i];
    most = std::max(most, film.ilvCount[i]);
  }
  image.scale = {ColorMap::Viridis, 0.0f, most};
  return image;
}

/// Calls visit(pixel, tile, point) for the first visible point of every pixel that has one.
template <class Visit>
void forEachFirstPoint(const VisiblePoints& points, const Visit& visit) {
  for (std::size_t t = 0; t < points.tiles.size(); ++t) {
    const std::vector<VisiblePoint>& all = points.tiles[t].points;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (i == 0 || all[i].pixel != all[i - 1].pixel) visit(all[i].pixel, t, i);
    }
  }
}

ViewImage nearestRecordView(const RenderFrame& frame) {
  if (!frame.points) return emptyView(PictureView::NearestRecord, whyNoVectors(frame));
  ViewImage image = newView(frame, PictureView::NearestRecord, ViewKind::Scalar, lengthUnit(*frame.scene));
  std::fill(image.values.begin(), image.values.end(), kNoValue);
  const RecordSet<IndirectLightVector>& records = frame.snapshot->indirect;
  // Every pixel asks for one: once side by side, they stay in the processor's cache.
  std::vector<Vec3> places(records.size());
  for (std::size_t n = 0; n < places.size(); ++n) places[n] = records[n].point.position;
  const auto unit = static_cast<float>(frame.scene->normalisation.sceneLength(1.0));
  forEachFirstPoint(*frame.points, [&](std::uint32_t pixel, std::size_t t, std::size_t i) {
    const std::uint32_t nearest = frame.answers[t]->nearest[i];
    if (nearest == kNone) return;
    image.values[pixel] = unit * glm::length(frame.points->tiles[t].points[i].position - places[nearest]);
  });
  image.scale = {ColorMap::Viridis, 0.0f, roundUp(percentile(image.values, 0.99))};
  return image;
}

/// Columns and rows of a picture of which so many pixels are one of a coarse frame.
int coarse(int pixels, int reduction) { return (pixels + reduction - 1) / reduction; }

ViewImage errorView(const RenderFrame& frame, const ErrorBase& base) {
  if (!base.picture || base.picture->empty()) {
    return emptyView(PictureView::Error,
                     base.picture ? "the picture to compare with has no pixels" : base.name);
  }
  const ImageRgb& reference = *base.picture;
  const Film& film = *frame.film;
  const int reduction = frame.reduction;
  if (coarse(reference.width(), reduction) != film.width ||
      coarse(reference.height(), reduction) != film.height) {
    return emptyView(PictureView::Error,
                     fmt::format("{} has {} x {} pixels, the picture {} x {}", base.name, reference.width(),
                                 reference.height(), film.width, film.height));
  }
  double mean = 0.0;
  for (const Rgb& pixel : reference) mean += luminance(pixel);
  mean /= static_cast<double>(reference.size());
  const double floor = errorFloor(mean);
  ViewImage image = newView(frame, PictureView::Error, ViewKind::Scalar, "%");
  const float scale = frame.scene->normalisation.radianceScale();
  for (int y = 0; y < film.height; ++y) {
    for (int x = 0; x < film.width; ++x) {
      const auto i =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(film.width) + static_cast<std::size_t>(x);
      const double shown = luminance(scale * film.beauty(i));
      // Of the pixels that one of a coarse frame stands for, the one in the middle.
      const double wanted =
          luminance(reference.at(std::min(x * reduction + reduction / 2, reference.width() - 1),
                                 std::min(y * reduction + reduction / 2, reference.height() - 1)));
      image.values[i] = static_cast<float>(100.0 * (shown - wanted) / (std::abs(wanted) + floor));
    }
  }
  const float most = std::max(1.0f, roundUp(percentile(image.values, 0.98, true)));
  image.scale = {ColorMap::Diverging, -most, most};
  image.title = fmt::format("Error against {}: (Y - Yref) / (Yref + {} {}), Y is luminance", base.name,
                            numberText(floor), kRadianceUnit);
  return image;
}

ViewImage estimatedErrorView(const RenderFrame& frame, const ErrorEstimate* known) {
  if (!frame.points) return emptyView(PictureView::EstimatedError, whyNoVectors(frame));
  ErrorEstimate found;
  if (known == nullptr) {
    const StopFlag goOn = false;
    TaskPool pool(1);
    found = estimateError(frame, pool, goOn);
    known = &found;
  }
  if (known->variance.empty())
    return emptyView(PictureView::EstimatedError, "how far off the vectors are is not known yet");
  ViewImage image = newView(frame, PictureView::EstimatedError, ViewKind::Scalar, "%");
  const Film& film = *frame.film;
  double mean = 0.0;
  for (std::size_t i = 0; i < known->variance.size(); ++i) mean += luminance(film.beauty(i));
  mean /= static_cast<double>(known->variance.size());
  const double floor = errorFloor(mean);
  for (std::size_t i = 0; i < known->variance.size(); ++i) {
    const double deviation = luminance(glm::sqrt(known->variance[i]));
    image.values[i] = static_cast<float>(100.0 * deviation / (luminance(film.beauty(i)) + floor));
  }
  image.scale = {ColorMap::Viridis, 0.0f, std::max(1.0f, roundUp(percentile(image.values, 0.98)))};
  image.title = "Estimated error: by how much the vectors that answer a pixel let its mean differ (1 sigma)";
  return image;
}

// ---- where its error comes from ----

/// By ErrorSource: Okabe and Ito's colours.
constexpr Color8 kSourceColors[] = {
    {86, 180, 233}, {213, 94, 0}, {230, 159, 0}, {0, 158, 115}, {204, 121, 167}};
static_assert(std::size(kSourceColors) == kErrorSources);

ViewImage largestSourceView(const RenderFrame& frame, const ErrorSources& known) {
  ViewImage image = newView(frame, PictureView::ErrorSources, ViewKind::Categories, "");
  image.categories.push_back({"none", {0, 0, 0}});
  for (const ErrorSourceInfo& info : errorSourceInfos())
    image.categories.push_back({info.label, kSourceColors[static_cast<std::size_t>(info.source)]});
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const auto largest = known.largest(x, y);
      const std::size_t category = largest ? 1 + static_cast<std::size_t>(*largest) : 0;
      image.values[known.truth.index(x, y)] = static_cast<float>(category);
      image.categories[category].occurs = true;
    }
  }
  image.title = "What most of the error about each pixel comes from";
  return image;
}

ViewImage sourceView(const RenderFrame& frame, const ErrorSources& known, ErrorSource source) {
  ViewImage image = newView(frame, PictureView::ErrorSources, ViewKind::Scalar, "%");
  const ImageRgb& map = known.map(source);
  double mean = 0.0;
  for (const std::size_t i : known.pixels) mean += luminance(known.truth[i]);
  mean /= static_cast<double>(known.pixels.size());
  const double floor = errorFloor(mean);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const std::size_t i = known.lookedAt(x, y);
      const double truth = std::abs(static_cast<double>(luminance(known.truth[i])));
      image.values[known.truth.index(x, y)] = static_cast<float>(100.0 * luminance(map[i]) / (truth + floor));
    }
  }
  const float most = std::max(0.1f, roundUp(percentile(image.values, 0.98, true)));
  image.scale = {ColorMap::Diverging, -most, most};
  image.title = fmt::format("{}: what it adds to each pixel's luminance, of what that should be",
                            errorSourceInfos()[static_cast<std::size_t>(source)].label);
  return image;
}

ViewImage errorSourcesView(const RenderFrame& frame, const ViewSources& sources) {
  if (!frame.points) return emptyView(PictureView::ErrorSources, whyNoVectors(frame));
  if (sources.errorSources == nullptr)
    return emptyView(PictureView::ErrorSources, "it is found out once the picture is complete");
  if (!sources.source) return largestSourceView(frame, *sources.errorSources);
  return sourceView(frame, *sources.errorSources, *sources.source);
}

// ---- where it was computed ----

enum Where : std::uint8_t {
  NothingToCompute,
  NotLookedAt,
  Unanswered,
  Interpolated,
  DirectSeed,
  DirectEarlier,
  DirectTooFew,
  DirectTooUnlike,
  FirstReason  ///< MissReason follows
};

/// Of a pixel's points and lights the last of the reasons speaks.
void markFullDirect(const RenderFrame& frame, std::vector<std::uint8_t>& wheres) {
  static_assert(DirectTooUnlike - DirectSeed == TileAnswers::TooUnlike - TileAnswers::Seed);
  for (std::size_t t = 0; t < frame.points->tiles.size(); ++t) {
    const std::vector<VisiblePoint>& points = frame.points->tiles[t].points;
    const TileAnswers& answers = *frame.answers[t];
    frame.lightSlots.forEachAsked(answers, [&](std::size_t, std::size_t slot) {
      const std::size_t first = slot * points.size();
      for (std::size_t i = 0; i < points.size(); ++i) {
        const std::uint8_t reason = answers.lightReason[first + i];
        std::uint8_t& where = wheres[points[i].pixel];
        if (reason == TileAnswers::NotInFull || where < Interpolated) continue;
        where = std::max(where, static_cast<std::uint8_t>(DirectSeed + reason - TileAnswers::Seed));
      }
    });
  }
}

ViewImage whereComputedView(const RenderFrame& frame, const std::vector<ComputedVector>* computed) {
  if (!frame.points) return emptyView(PictureView::WhereComputed, whyNoVectors(frame));
  ViewImage image = newView(frame, PictureView::WhereComputed, ViewKind::Categories, "");
  image.categories = whereCategories();
  std::vector<std::uint8_t> wheres(image.values.size(), NothingToCompute);
  for (std::size_t t = 0; t < frame.points->tiles.size(); ++t) {
    const std::vector<VisiblePoint>& points = frame.points->tiles[t].points;
    const TileAnswers& answers = *frame.answers[t];
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Where where = answers.looked[i] == 0     ? NotLookedAt
                          : answers.answered[i] == 0 ? Unanswered
                                                     : Interpolated;
      // Of a pixel's points the one that is least known of speaks.
      std::uint8_t& known = wheres[points[i].pixel];
      if (known == NothingToCompute || where < known) known = where;
    }
  }
  markFullDirect(frame, wheres);
  const std::vector<ComputedVector> own =
      computed == nullptr ? computedVectors(frame) : std::vector<ComputedVector>();
  const std::vector<ComputedVector>& vectors = computed == nullptr ? own : *computed;
  // Backwards: where a pixel has several vectors the oldest speaks, and one that is seen straight before all.
  for (const bool throughSpecular : {true, false}) {
    for (std::size_t v = vectors.size(); v-- > 0;) {
      const VisiblePoint& p = frame.points->tiles[vectors[v].point.tile].points[vectors[v].point.point];
      if (p.throughSpecular != throughSpecular) continue;
      wheres[p.pixel] = static_cast<std::uint8_t>(FirstReason + static_cast<int>(vectors[v].reason));
    }
  }
  std::copy(wheres.begin(), wheres.end(), image.values.begin());
  for (const std::uint8_t where : wheres) image.categories[where].occurs = true;
  return image;
}

}  // namespace

/// Found by a search for colours that are as far apart as so many can be, for eyes of all kinds: a test holds
/// every pair apart by 20 in L*a*b*.
std::vector<ViewCategory> whereCategories() {
  std::vector<ViewCategory> categories = {{"background or light", {0, 0, 0}},
                                          {"not looked at yet", {10, 1, 52}},
                                          {"no vector answers", {62, 41, 1}},
                                          {"interpolated", {90, 90, 90}},
                                          {"full DLV: seed", {232, 251, 184}},
                                          {"full DLV: of an earlier picture", {108, 182, 166}},
                                          {"direct in full: too few DLVs", {101, 94, 252}},
                                          {"direct in full: DLVs too unlike", {67, 59, 139}},
                                          {"full ILV: seed", {255, 255, 255}},
                                          {"full ILV: none yet", {255, 251, 124}}};
  // By MissReason, from Distance on.
  constexpr Color8 kRules[] = {{230, 152, 0}, {112, 123, 168}, {83, 176, 98},   {255, 255, 2},
                               {2, 6, 160},   {173, 74, 6},    {159, 148, 255}, {190, 203, 255}};
  constexpr int kFirst = static_cast<int>(MissReason::Distance);
  static_assert(std::size(kRules) == static_cast<std::size_t>(MissReason::TooFew) - kFirst + 1);
  for (int r = kFirst; r <= static_cast<int>(MissReason::TooFew); ++r) {
    categories.push_back(
        {std::string("full ILV: ") + missReasonName(static_cast<MissReason>(r)), kRules[r - kFirst]});
  }
  return categories;
}

std::span<const PictureViewInfo> pictureViews() {
  static constexpr PictureViewInfo kViews[] = {
      {PictureView::Beauty, "beauty", "Beauty", "The picture: all layers together."},
      {PictureView::Direct, "direct", "Direct", "Light that comes straight from the lights."},
      {PictureView::Indirect, "indirect", "Indirect",
       "Light that was reflected at least once before it met the surface: what ILVs interpolate."},
      {PictureView::Specular, "specular", "Specular", "All that is seen by way of mirrors and glass."},
      {PictureView::WhereComputed, "where-computed", "Where computed",
       "Where an ILV was computed, coloured by the rule that refused the nearest one known before, and where "
       "direct light was computed in full."},
      {PictureView::VectorsUsed, "vectors-used", "Vectors used",
       "The number of ILVs that answered the pixel's first visible point."},
      {PictureView::NearestRecord, "nearest-vector", "Nearest vector",
       "The distance from the pixel's first visible point to the nearest ILV that answered it."},
      {PictureView::Error, "error", "Error",
       "Relative difference of luminance from a reference picture, with its sign."},
      {PictureView::EstimatedError, "estimated-error", "Estimated error",
       "How far off the pixel's indirect light is thought to be, by how its ILVs differ; of all its light."},
      {PictureView::ErrorSources, "error-sources", "Error sources",
       "Where the error comes from, by computing pixels in full: noise, leaks, interpolation, a lobe's "
       "single "
       "direction, missing bounces."},
      {PictureView::Albedo, "albedo", "Albedo", "The part of the light that the first surface reflects."},
      {PictureView::Normal, "normal", "Normal",
       "The shading normal of the first surface: x, y, z as red, green, blue."},
      {PictureView::Depth, "depth", "Depth", "The distance to the first surface, along the ray."}};
  return kViews;
}

const PictureViewInfo& pictureViewInfo(PictureView view) {
  return pictureViews()[static_cast<std::size_t>(view)];
}

std::optional<PictureView> pictureViewNamed(std::string_view name) {
  for (const PictureViewInfo& info : pictureViews()) {
    if (name == info.name) return info.view;
  }
  return std::nullopt;
}

bool tellsOfVectors(PictureView view) {
  return view == PictureView::WhereComputed || view == PictureView::VectorsUsed ||
         view == PictureView::NearestRecord || view == PictureView::EstimatedError ||
         view == PictureView::ErrorSources;
}

ViewImage viewImage(const RenderFrame& frame, PictureView view, const ViewSources& sources) {
  if (!frame.film || frame.film->depth().empty()) return emptyView(view, "there is no picture yet");
  const Film& film = *frame.film;
  switch (view) {
    case PictureView::Beauty:
      return radianceView(frame, view, [&](std::size_t i) { return film.beauty(i); });
    case PictureView::Direct:
      return radianceView(frame, view, [&](std::size_t i) { return film.direct[i]; });
    case PictureView::Indirect:
      return radianceView(frame, view, [&](std::size_t i) { return film.indirect[i]; });
    case PictureView::Specular:
      return radianceView(frame, view, [&](std::size_t i) { return film.specular[i]; });
    case PictureView::WhereComputed:
      return whereComputedView(frame, sources.computed);
    case PictureView::VectorsUsed:
      return vectorsUsedView(frame);
    case PictureView::NearestRecord:
      return nearestRecordView(frame);
    case PictureView::Error:
      return errorView(frame, sources.base);
    case PictureView::EstimatedError:
      return estimatedErrorView(frame, sources.estimate);
    case PictureView::ErrorSources:
      return errorSourcesView(frame, sources);
    case PictureView::Albedo:
      return colorView(frame, view, [&](std::size_t i) { return film.albedo()[i]; });
    case PictureView::Normal:
      return normalView(frame);
    case PictureView::Depth:
      return depthView(frame);
  }
  return emptyView(view, "not a view");
}

ViewImage viewOfPicture(const ImageRgb& beauty) {
  ViewImage image;
  image.kind = ViewKind::Radiance;
  image.width = beauty.width();
  image.height = beauty.height();
  image.title = pictureViewInfo(PictureView::Beauty).label;
  image.unit = kRadianceUnit;
  image.values.reserve(3 * beauty.size());
  for (const Rgb& pixel : beauty) image.values.insert(image.values.end(), &pixel[0], &pixel[0] + 3);
  return image;
}

std::vector<std::string> viewValueLines(const ViewImage& image, int x, int y) {
  if (image.empty() || x < 0 || y < 0 || x >= image.width || y >= image.height) return {};
  const float* value = image.pixel(x, y);
  switch (image.kind) {
    case ViewKind::Radiance:
      return {numberText(value[0]), numberText(value[1]), numberText(value[2])};
    case ViewKind::Color: {
      const bool isNormal = image.view == PictureView::Normal;
      if (isNormal && value[0] == 0.0f && value[1] == 0.0f && value[2] == 0.0f) return {};
      const Vec3 shown = Vec3(value[0], value[1], value[2]);
      const Vec3 v = isNormal ? 2.0f * shown - 1.0f : shown;
      return {numberText(v.x), numberText(v.y), numberText(v.z)};
    }
    case ViewKind::Scalar:
      if (std::isnan(*value)) return {};
      return {image.view == PictureView::Error || image.view == PictureView::ErrorSources
                  ? fmt::format("{:+.3g}", *value)
                  : numberText(*value)};
    case ViewKind::Categories:
      if (std::isnan(*value)) return {};
      return {image.categories[static_cast<std::size_t>(*value)].name};
  }
  return {};
}

std::string viewValueText(const ViewImage& image, int x, int y) {
  const std::vector<std::string> lines = viewValueLines(image, x, y);
  if (lines.empty()) return "none";
  const std::string text = lines.size() == 1 ? lines.front() : fmt::format("({})", fmt::join(lines, ", "));
  return image.unit.empty() ? text : text + " " + image.unit;
}

}  // namespace lightvane
