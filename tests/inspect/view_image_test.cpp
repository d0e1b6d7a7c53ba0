#include "core/inspect/view_image.h"

#include <chrono>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/inspect/error_sources.h"
#include "core/inspect/picture_style.h"
#include "core/inspect/units.h"
#include "tests/inspect/frames.h"

namespace lightvane::inspect_test {
namespace {

using testing::HasSubstr;

const RenderFrame& mirrorFrame() {
  static const RenderFrame frame = renderShipped(
      "cornell-mirror.toml", 64, {{"ilv.seed", "20"}, {"dlv.mode", "always"}, {"dlv.seed", "300"}});
  return frame;
}

ImageRgb beautyInSceneUnits(const RenderFrame& frame) { return frame.film->toLayers(*frame.scene).rgb(); }

TEST(ViewImage, RadianceIsWhatPictureFilesHave) {
  const RenderFrame& frame = mirrorFrame();
  const LayeredImage layers = frame.film->toLayers(*frame.scene);
  const std::pair<PictureView, ImageRgb> views[] = {{PictureView::Beauty, layers.rgb()},
                                                    {PictureView::Direct, layers.rgb("direct")},
                                                    {PictureView::Indirect, layers.rgb("indirect")},
                                                    {PictureView::Specular, layers.rgb("specular")}};
  for (const auto& [view, wanted] : views) {
    const ViewImage image = viewImage(frame, view);
    ASSERT_EQ(image.kind, ViewKind::Radiance);
    EXPECT_STREQ(image.unit.c_str(), "W/(m² sr)");
    for (int y = 0; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x) {
        for (int c = 0; c < 3; ++c) {
          ASSERT_NEAR(image.pixel(x, y)[c], wanted.at(x, y)[c], 1e-6f * (1.0f + wanted.at(x, y)[c]))
              << image.title << " at " << x << ", " << y;
        }
      }
    }
  }
}

TEST(ViewImage, LengthsAreInTheScenesUnit) {
  SceneDescription scene = shippedScene("cornell.toml", 32, 32);
  const RenderFrame frame = renderFrame(Stage(scene), parametersWith({}));
  const ViewImage depth = viewImage(frame, PictureView::Depth);
  const LayeredImage layers = frame.film->toLayers(*frame.scene);
  EXPECT_FLOAT_EQ(*depth.pixel(16, 16), layers.channels.at("Z").at(16, 16));
  EXPECT_THAT(viewValueText(depth, 16, 16), testing::EndsWith(" " + depth.unit));
  EXPECT_EQ(viewValueLines(depth, 16, 16).front() + " " + depth.unit, viewValueText(depth, 16, 16));
  EXPECT_THAT(viewValueLines(depth, -1, 0), testing::IsEmpty());
  EXPECT_LT(depth.scale.low, depth.scale.high);
  for (const std::string& name : unitNames()) {
    scene.units = name;
    EXPECT_NE(lengthUnit(*Stage(scene).scene), "scene units") << name << " has no short name";
  }
  EXPECT_EQ(depth.unit, "m");
}

TEST(ViewImage, TheLegendOfNormalsHasTheColoursOfThePicture) {
  const ViewImage image = viewImage(mirrorFrame(), PictureView::Normal);
  ASSERT_EQ(image.categories.size(), 6u);
  EXPECT_EQ(image.categories.front().name, "towards +x");
  EXPECT_EQ(image.categories.back().name, "towards -z");
  const Image<Color8> shown = displayColors(image, PictureStyle{});
  // The room's walls face along the axes.
  int found = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const float* value = image.pixel(x, y);
      if (value[0] == 0.5f && value[1] == 1.0f && value[2] == 0.5f) {
        EXPECT_EQ(shown.at(x, y), image.categories[2].color) << "the floor is towards +y";
        ++found;
      }
    }
  }
  EXPECT_GT(found, 10);
}

TEST(ViewImage, CountsStartAtZeroAndEndAtTheMost) {
  const ViewImage image = viewImage(mirrorFrame(), PictureView::VectorsUsed);
  EXPECT_EQ(image.scale.low, 0.0f);
  EXPECT_EQ(image.scale.high, *std::max_element(image.values.begin(), image.values.end()));
  EXPECT_EQ(image.scale.high, std::floor(image.scale.high));
}

TEST(ViewImage, NearestVectorIsTheDistanceToTheFilmsVector) {
  const RenderFrame& frame = mirrorFrame();
  const ViewImage image = viewImage(frame, PictureView::NearestRecord);
  int compared = 0;
  for (std::size_t i = 0; i < frame.film->depth().size(); ++i) {
    const std::uint32_t id = frame.film->recordId[i];
    ASSERT_EQ(id == 0, std::isnan(image.values[i])) << "pixel " << i;
    const PixelPoints points = pointsOfPixel(*frame.points, static_cast<std::uint32_t>(i));
    if (id == 0 || frame.points->tiles[points.tile].points[points.first].throughSpecular) continue;
    // Straight: the film's own position is the point's.
    const double distance =
        glm::length(frame.film->position()[i] - frame.snapshot->indirect[id - 1].point.position);
    EXPECT_NEAR(image.values[i], frame.scene->normalisation.sceneLength(distance), 1e-6);
    ++compared;
  }
  EXPECT_GT(compared, 1000);
}

ViewSources against(const ImageRgb& reference) {
  return {.base = {std::make_shared<const ImageRgb>(reference), "the reference"}};
}

TEST(ViewImage, ErrorIsSignedAndRelativeToTheReference) {
  const RenderFrame& frame = mirrorFrame();
  ImageRgb reference = beautyInSceneUnits(frame);
  const auto errors = [&] { return viewImage(frame, PictureView::Error, against(reference)); };
  const ViewImage none = errors();
  for (const float error : none.values) ASSERT_NEAR(error, 0.0f, 1e-3f);
  for (Rgb& pixel : reference) pixel *= 0.5f;
  const ViewImage twice = errors();
  double brightest = 0.0;
  std::size_t where = 0;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    EXPECT_GE(twice.values[i], 0.0f);
    EXPECT_LE(twice.values[i], 100.0f);
    if (luminance(reference[i]) <= brightest) continue;
    brightest = luminance(reference[i]);
    where = i;
  }
  EXPECT_NEAR(twice.values[where], 100.0f, 1.0f) << "the floor is a hundredth of the mean";
  EXPECT_EQ(twice.scale.low, -twice.scale.high);
  EXPECT_EQ(twice.scale.map, ColorMap::Diverging);
  for (Rgb& pixel : reference) pixel *= 4.0f;
  for (const float error : errors().values) ASSERT_LE(error, 0.0f);
}

TEST(ViewImage, ACoarseFrameIsHeldAgainstTheWholeReference) {
  RenderFrame frame = mirrorFrame();
  const ImageRgb small = beautyInSceneUnits(frame);
  // Three pixels across and down for one of the frame's, but for the last column and row.
  ImageRgb reference(3 * small.width() - 1, 3 * small.height() - 1);
  for (int y = 0; y < reference.height(); ++y) {
    for (int x = 0; x < reference.width(); ++x) reference.at(x, y) = small.at(x / 3, y / 3);
  }
  frame.reduction = 3;
  const ViewImage image = viewImage(frame, PictureView::Error, against(reference));
  ASSERT_FALSE(image.empty()) << image.title;
  for (const float error : image.values) ASSERT_NEAR(error, 0.0f, 1e-3f);
}

TEST(ViewImage, OfAFileIsItsRadiance) {
  const RenderFrame& frame = mirrorFrame();
  const ViewImage own = viewImage(frame, PictureView::Beauty);
  const ViewImage image = viewOfPicture(beautyInSceneUnits(frame));
  EXPECT_EQ(image.kind, own.kind);
  EXPECT_EQ(image.unit, own.unit);
  ASSERT_EQ(image.values.size(), own.values.size());
  for (std::size_t i = 0; i < own.values.size(); ++i)
    ASSERT_NEAR(image.values[i], own.values[i], 1e-5f * (1.0f + std::abs(own.values[i])));
}

TEST(ViewImage, SaysWhyItIsEmpty) {
  const RenderFrame& frame = mirrorFrame();
  EXPECT_TRUE(viewImage(frame, PictureView::Error).empty());
  EXPECT_THAT(viewImage(frame, PictureView::Error).title, HasSubstr("no reference"));
  EXPECT_THAT(viewImage(frame, PictureView::Error, against(ImageRgb(8, 8))).title, HasSubstr("8 x 8"));
  const ErrorBase none{nullptr, "B was not kept"};
  EXPECT_THAT(viewImage(frame, PictureView::Error, {.base = none}).title, HasSubstr("B was not kept"));
  EXPECT_EQ(viewValueText(viewImage(frame, PictureView::Error), 3, 3), "none");
  const RenderFrame naive =
      renderShipped("cornell.toml", 16, {{"method.name", "naive"}, {"naive.samples", "8"}});
  for (const PictureView view :
       {PictureView::WhereComputed, PictureView::VectorsUsed, PictureView::NearestRecord}) {
    EXPECT_TRUE(viewImage(naive, view).empty());
    EXPECT_THAT(viewImage(naive, view).title, HasSubstr("no vectors"));
  }
  EXPECT_THAT(viewImage(RenderFrame{}, PictureView::Beauty).title, HasSubstr("no picture"));
}

std::string categoryAt(const ViewImage& image, std::size_t pixel) {
  return image.categories[static_cast<std::size_t>(image.values[pixel])].name;
}

TEST(ViewImage, WhereComputedMarksThePixelsThatTheFilmCounts) {
  const RenderFrame& frame = mirrorFrame();
  const ViewImage image = viewImage(frame, PictureView::WhereComputed);
  ASSERT_EQ(image.kind, ViewKind::Categories);
  std::set<std::string> seen;
  for (std::size_t i = 0; i < image.values.size(); ++i) {
    const std::string category = categoryAt(image, i);
    seen.insert(category);
    const bool isFull = category.starts_with("full ILV");
    // fullIlv counts all of the pixel's points, and so does the view.
    EXPECT_EQ(isFull, frame.film->fullIlv[i] > 0.0f) << "pixel " << i << ": " << category;
    if (category.starts_with("full DLV") || category.starts_with("direct in full")) {
      EXPECT_GT(frame.film->fullDlv[i], 0.0f);
    }
    if (category == "background or light") {
      EXPECT_EQ(pointsOfPixel(*frame.points, static_cast<std::uint32_t>(i)).count, 0u);
    }
  }
  EXPECT_THAT(
      seen, testing::IsSupersetOf({"background or light", "interpolated", "full ILV: seed",
                                   "full ILV: distance", "full DLV: seed", "direct in full: too few DLVs"}));
  // What the caller kept is what it would have computed itself.
  const std::vector<ComputedVector> computed = computedVectors(frame);
  EXPECT_EQ(viewImage(frame, PictureView::WhereComputed, {.computed = &computed}).values, image.values);
}

TEST(ViewImage, WhereComputedKnowsWhatIsNotThereYet) {
  const RenderFrame early = renderShipped("cornell.toml", 64, {}, 2);
  const ViewImage image = viewImage(early, PictureView::WhereComputed);
  int waiting = 0;
  for (std::size_t i = 0; i < image.values.size(); ++i)
    waiting += categoryAt(image, i) == "not looked at yet";
  EXPECT_GT(waiting, 3000) << "a first stride looks at one pixel of 256";
}

TEST(ViewImage, ViewsAreNamed) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < pictureViews().size(); ++i) {
    const PictureViewInfo& info = pictureViews()[i];
    EXPECT_EQ(static_cast<std::size_t>(info.view), i);
    EXPECT_EQ(pictureViewNamed(info.name), info.view);
    names.insert(info.name);
  }
  EXPECT_EQ(names.size(), pictureViews().size());
  EXPECT_FALSE(pictureViewNamed("no-such-view"));
}

// As for computedVectors: the order of magnitude only.
TEST(ViewImage, OfTheEstimatedErrorIsThatOfTheVectors) {
  const RenderFrame frame = renderShipped("cornell.toml", 32, {{"preset", "draft"}});
  TaskPool pool(2);
  const StopFlag goOn = false;
  const ErrorEstimate estimate = estimateError(frame, pool, goOn);
  ViewSources sources;
  sources.estimate = &estimate;
  const ViewImage kept = viewImage(frame, PictureView::EstimatedError, sources);
  const ViewImage alone = viewImage(frame, PictureView::EstimatedError);
  EXPECT_EQ(kept.values, alone.values) << "it is worked out where the caller has none";
  EXPECT_EQ(kept.unit, "%");
  double mean = 0.0;
  for (std::size_t i = 0; i < kept.values.size(); ++i) mean += luminance(frame.film->beauty(i));
  mean /= static_cast<double>(kept.values.size());
  int above = 0;
  for (std::size_t i = 0; i < kept.values.size(); ++i) {
    const double wanted =
        100.0 * luminance(glm::sqrt(estimate.variance[i])) / (luminance(frame.film->beauty(i)) + 0.01 * mean);
    ASSERT_NEAR(static_cast<double>(kept.values[i]), wanted, 0.02 * wanted + 1e-4) << "pixel " << i;
    above += wanted > 1.0 ? 1 : 0;
  }
  EXPECT_GT(above, 100) << "a draft is nowhere near exact";
  const ErrorEstimate unknown;
  sources.estimate = &unknown;
  EXPECT_TRUE(viewImage(frame, PictureView::EstimatedError, sources).empty());
}

TEST(ViewImage, OfTheErrorsSourcesIsWhatEachAdds) {
  const RenderFrame frame = renderShipped("cornell.toml", 24, {{"preset", "draft"}});
  EXPECT_THAT(viewImage(frame, PictureView::ErrorSources).title, HasSubstr("once the picture is complete"));
  TaskPool pool(2);
  const StopFlag goOn = false;
  const auto known = errorSources(frame, {32, 2}, pool, goOn);
  ASSERT_TRUE(known);
  ViewSources sources;
  sources.errorSources = &*known;
  const ViewImage largest = viewImage(frame, PictureView::ErrorSources, sources);
  sources.source = ErrorSource::Interpolation;
  const ViewImage interpolation = viewImage(frame, PictureView::ErrorSources, sources);
  EXPECT_EQ(interpolation.unit, "%");
  EXPECT_EQ(interpolation.scale.map, ColorMap::Diverging);
  for (int y = 0; y < 24; ++y) {
    for (int x = 0; x < 24; ++x) {
      // One pixel speaks for its square.
      const std::size_t looked = known->lookedAt(x, y);
      EXPECT_EQ(looked, known->lookedAt(x / 2 * 2, y / 2 * 2));
      const auto source = known->largest(x, y);
      EXPECT_EQ(*largest.pixel(x, y), source ? 1.0f + static_cast<float>(*source) : 0.0f);
      const float part = luminance(known->map(ErrorSource::Interpolation)[looked]);
      EXPECT_EQ(*interpolation.pixel(x, y) > 0.0f, part > 0.0f);
    }
  }
}

TEST(ViewImage, TakesMilliseconds) {
  if (!render_test::isFast()) GTEST_SKIP();
  const RenderFrame frame = renderShipped("cornell.toml", 512, {{"preset", "draft"}});
  ViewSources sources = against(beautyInSceneUnits(frame));
  const std::vector<ComputedVector> computed = computedVectors(frame);
  sources.computed = &computed;
  TaskPool pool(2);
  const StopFlag goOn = false;
  const ErrorEstimate estimate = estimateError(frame, pool, goOn);
  sources.estimate = &estimate;
  for (const PictureViewInfo& info : pictureViews()) {
    double best = 1e9;
    for (int run = 0; run < 5; ++run) {
      const auto start = std::chrono::steady_clock::now();
      const ViewImage image = viewImage(frame, info.view, sources);
      best = std::min(best,
                      1e3 * std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    }
    RecordProperty(info.label, fmt::format("{:.2f} ms", best));
    EXPECT_LT(best, 60.0) << info.name;
  }
}

}  // namespace
}  // namespace lightvane::inspect_test
