#include "core/inspect/pixel_report.h"

#include <cmath>
#include <ctime>
#include <map>
#include <set>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/inspect/specular_ways.h"
#include "tests/inspect/frames.h"

namespace lightvane::inspect_test {
namespace {

using testing::HasSubstr;

constexpr int kReportSize = 32;

class PixelReports : public testing::TestWithParam<Way> {
 protected:
  static RenderFrame frame(int passes = -1) {
    return renderShipped(GetParam().scene, kReportSize, GetParam().settings, passes, GetParam().lights);
  }
};

struct Worst {
  double error = 0.0;
  std::string where;

  void add(const Rgb& explained, const Rgb& shown, double floor, const std::string& place) {
    for (int c = 0; c < 3; ++c) {
      const double relative =
          std::abs(static_cast<double>(explained[c]) - shown[c]) / (std::abs(shown[c]) + floor);
      if (!(relative <= error)) {
        error = relative;
        where = fmt::format("{}: {} against {}", place, explained[c], shown[c]);
      }
    }
  }
};

/// Every pixel of a frame: the shares of all vectors add up to what the film has. Float sums of some twenty
/// terms in another order differ by 1e-6; the floor is for pixels that are all but black (and for pictures
/// that are).
void expectSharesAddUp(const RenderFrame& frame, int& coarse, int& inexact) {
  const float scale = frame.scene->normalisation.radianceScale();
  const double floor = 1e-3 * render_test::mean(render_test::beauty(*frame.film)) * scale + 1e-30;
  Worst worst;
  for (int y = 0; y < frame.film->height; ++y) {
    for (int x = 0; x < frame.film->width; ++x) {
      const PixelReport report = pixelReport(frame, x, y);
      const std::size_t i = frame.film->depth().index(x, y);
      for (const PointReport& point : report.points) {
        for (const auto* answers : {&point.lights, &point.indirect}) {
          for (const AnswerReport& answer : *answers) {
            if (!answer.isExact) {
              ++inexact;
              ADD_FAILURE() << "pixel " << x << ", " << y << ", " << answer.name << ": "
                            << answerOriginName(answer.origin) << ", shown " << answer.radiance.g
                            << ", explained " << answer.explained.g;
            }
          }
        }
      }
      if (report.coarse) {
        ++coarse;
        continue;
      }
      const std::string place = fmt::format("pixel {}, {}", x, y);
      worst.add(report.direct, scale * frame.film->direct[i], floor, place + " direct");
      worst.add(report.indirect, scale * frame.film->indirect[i], floor, place + " indirect");
      worst.add(report.specular, scale * frame.film->specular[i], floor, place + " specular");
      worst.add(report.total(), report.shown, floor, place + " all");
    }
  }
  EXPECT_LT(worst.error, 1e-5) << worst.where;
  testing::Test::RecordProperty("worst", fmt::format("{:.2g} at {}", worst.error, worst.where));
}

TEST_P(PixelReports, SharesAddUpToThePicture) {
  int coarse = 0;
  int inexact = 0;
  expectSharesAddUp(frame(), coarse, inexact);
  EXPECT_EQ(coarse, 0);
  EXPECT_EQ(inexact, 0);
}

// A frame in the making shows answers of several generations of the cache.
TEST_P(PixelReports, SharesAddUpBeforeTheEnd) {
  for (const int passes : {1, 3, 4}) {
    int coarse = 0;
    int inexact = 0;
    expectSharesAddUp(frame(passes), coarse, inexact);
    EXPECT_GT(coarse, 0) << "after " << passes << " passes";
    EXPECT_EQ(inexact, 0) << "after " << passes << " passes";
  }
}

TEST_P(PixelReports, SayOfEveryCandidateWhatBecameOfIt) {
  const RenderFrame whole = frame();
  for (int y = 0; y < kReportSize; y += 3) {
    for (int x = 0; x < kReportSize; x += 3) {
      for (const PointReport& point : pixelReport(whole, x, y).points) {
        EXPECT_FALSE(point.reached.empty());
        EXPECT_FALSE(point.material.empty());
        for (const auto* answers : {&point.lights, &point.indirect}) {
          for (const AnswerReport& answer : *answers) {
            float last = 0.0f;
            for (const CandidateReport& candidate : answer.candidates) {
              EXPECT_FALSE(candidate.verdict.empty());
              EXPECT_EQ(candidate.used, candidate.rule.empty()) << candidate.verdict;
              EXPECT_THAT(candidate.verdict, testing::Not(HasSubstr("nan")));
              EXPECT_THAT(candidate.verdict, testing::Not(HasSubstr("not a number")));
              EXPECT_GE(candidate.distance, last) << "near ones first";
              last = candidate.distance;
            }
          }
        }
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Ways, PixelReports,
    testing::Values(
        Way{"cornell", "cornell.toml", {}},
        Way{"cornell_seeded", "cornell.toml", {{"ilv.seed", "60"}, {"ilv.n_max", "4"}}},
        Way{"cornell_paper", "cornell.toml", {{"preset", "draft"}, {"method.rules", "paper"}}},
        Way{"mirror", "cornell-mirror.toml", {}},
        Way{"mirror_paper", "cornell-mirror.toml", {{"preset", "draft"}, {"method.rules", "paper"}}},
        Way{"mirror_antialiased", "cornell-mirror.toml", {{"preset", "draft"}, {"film.samples", "3"}}},
        Way{"glossy", "cornell-glossy.toml", {{"preset", "draft"}}},
        Way{"glossy_paper", "cornell-glossy.toml", {{"preset", "draft"}, {"method.rules", "paper"}}},
        Way{"two_rooms", "two-rooms.toml", {{"preset", "draft"}}},
        Way{"dlv", "cornell.toml", {{"preset", "draft"}, {"dlv.mode", "always"}, {"dlv.seed", "400"}}},
        Way{"dlv_glossy",
            "cornell-glossy.toml",
            {{"preset", "draft"}, {"dlv.mode", "always"}, {"dlv.seed", "400"}, {"dlv.r_max", "5%"}}},
        Way{"dlv_paper",
            "cornell-glossy.toml",
            {{"preset", "draft"}, {"method.rules", "paper"}, {"dlv.mode", "always"}, {"dlv.seed", "400"}}},
        Way{"dimmed", "cornell-mirror.toml", {{"preset", "draft"}}, dimmedLight()},
        Way{"dimmed_dlv",
            "cornell-glossy.toml",
            {{"preset", "draft"}, {"dlv.mode", "always"}, {"dlv.seed", "400"}},
            dimmedLight()}),
    [](const testing::TestParamInfo<Way>& way) { return std::string(way.param.name); });

// The way to a visible point is found again as the renderer found the point.
TEST(SpecularWays, EndAtTheVisiblePoints) {
  const RenderFrame frame =
      renderShipped("cornell-mirror.toml", 48, {{"preset", "draft"}, {"film.samples", "2"}});
  int through = 0;
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 48; ++x) {
      const PixelWays ways = tracePixelWays(frame, x, y);
      const PixelPoints points =
          pointsOfPixel(*frame.points, static_cast<std::uint32_t>(frame.film->depth().index(x, y)));
      ASSERT_EQ(ways.points.size(), points.count) << x << ", " << y;
      for (std::uint32_t n = 0; n < points.count; ++n) {
        const VisiblePoint& p = frame.points->tiles[points.tile].points[points.first + n];
        EXPECT_LT(glm::length(ways.points[n].position - p.position), 1e-5f) << x << ", " << y;
        EXPECT_EQ(ways.points[n].depth > 0, p.throughSpecular);
        EXPECT_EQ(ways.points[n].text.starts_with("by way of mirror"), p.throughSpecular)
            << ways.points[n].text;
        through += p.throughSpecular;
      }
    }
  }
  EXPECT_GT(through, 100);
}

// Every pixel without points says what it shows: the background outside of the box, seen straight and in the
// mirror block, and the lamp.
TEST(PixelReport, SaysWhatAPixelShowsWhereNothingAsksForLight) {
  const RenderFrame frame = renderShipped("cornell-mirror.toml", 48, {{"preset", "draft"}});
  std::map<std::string, int> shown;
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 48; ++x) {
      const PixelReport report = pixelReport(frame, x, y);
      const std::string_view prefix = "no surface here asks for light: the pixel shows ";
      if (report.note.starts_with(prefix)) ++shown[report.note.substr(prefix.size())];
    }
  }
  EXPECT_GT(shown["the background"], 0);
  EXPECT_GT(shown["a light (light)"], 5);
  int inMirror = 0;
  for (const auto& [text, count] : shown)
    if (text.starts_with("the background by way of mirror (")) inMirror += count;
  EXPECT_GT(inMirror, 50);
}

TEST(PixelReport, TellsOwnVectorsAndRefusalsInNumbers) {
  const RenderFrame frame = renderShipped("cornell.toml", 48, {{"ilv.n_max", "4"}});
  int own = 0;
  std::set<std::string> rules;
  std::string distance;
  std::string angle;
  for (int i = 0; i < 48 * 48; ++i) {
    for (const PointReport& point : pixelReport(frame, i % 48, i / 48).points) {
      for (const CandidateReport& c : point.indirect.front().candidates) {
        own += c.own;
        if (c.own) {
          EXPECT_EQ(c.distance, 0.0f);
        }
        rules.insert(c.rule);
        if (c.rule == "distance") distance = c.verdict;
        if (c.rule == "curvature") angle = c.verdict;
      }
    }
  }
  EXPECT_EQ(static_cast<std::size_t>(own), frame.snapshot->indirect.size());
  EXPECT_THAT(rules, testing::IsSupersetOf({"", "distance", "curvature", "beyond n_max"}));
  EXPECT_THAT(distance, testing::MatchesRegex("distance [0-9.e-]+ m > radius [0-9.e-]+ m"));
  EXPECT_THAT(angle, testing::MatchesRegex("angle [0-9.]+° > 18.2°"));
}

// A thin wall: what is on its other side is refused by the ray.
TEST(PixelReport, SeesWallsBetween) {
  const RenderFrame frame = renderShipped("two-rooms.toml", 48);
  std::set<std::string> rules;
  for (int i = 0; i < 48 * 48; ++i) {
    for (const PointReport& point : pixelReport(frame, i % 48, i / 48).points) {
      for (const CandidateReport& c : point.indirect.front().candidates) rules.insert(c.rule);
    }
  }
  EXPECT_THAT(rules, testing::Contains("visibility"));
}

// The paper's rules ask nobody whether a vector is seen: through the wall of the two rooms they are not, in
// an empty room all of them are.
TEST(PixelReport, NamesTheVectorsThatLeak) {
  const auto leaks = [](const std::string& scene) {
    const RenderFrame frame = renderShipped(scene, 48, {{"method.rules", "paper"}});
    int count = 0;
    for (int i = 0; i < 48 * 48; ++i) {
      for (const PointReport& point : pixelReport(frame, i % 48, i / 48).points) {
        for (const CandidateReport& c : point.indirect.front().candidates) {
          count += c.hidden ? 1 : 0;
          EXPECT_TRUE(c.used || !c.hidden) << "what gave nothing does not leak";
        }
      }
    }
    return count;
  };
  EXPECT_GT(leaks("two-rooms.toml"), 100);
  EXPECT_EQ(leaks("furnace.toml"), 0);
}

TEST(PixelReport, SaysWhyThereIsNothing) {
  const RenderFrame frame = renderShipped("cornell.toml", 16);
  EXPECT_THAT(pixelReport(frame, 16, 0).note, HasSubstr("outside"));
  EXPECT_THAT(pixelReport(frame, 0, -1).note, HasSubstr("outside"));
  const RenderFrame naive =
      renderShipped("cornell.toml", 16, {{"method.name", "naive"}, {"naive.samples", "8"}});
  const PixelReport report = pixelReport(naive, 8, 12);
  EXPECT_THAT(report.note, HasSubstr("no vectors"));
  EXPECT_EQ(report.total(), report.shown);
  const RenderFrame printed =
      renderShipped("cornell.toml", 16, {{"preset", "draft"}, {"method.rules", "printed"}});
  EXPECT_THAT(pixelReport(printed, 8, 12).note, HasSubstr("printed"));
}

// With the cache locked, points that no vector serves stay dark, and the report says so.
TEST(PixelReport, KnowsUnansweredPoints) {
  const SceneDescription scene = shippedScene("cornell.toml", 32, 32);
  const RenderFrame frame = renderFrame(
      Stage(scene), parametersWith({}), -1,
      {renderFrame(Stage(shippedScene("cornell.toml", 8, 8)), parametersWith({}), 2).snapshot, true});
  int unanswered = 0;
  for (int i = 0; i < 32 * 32; ++i) {
    for (const PointReport& point : pixelReport(frame, i % 32, i / 32).points)
      unanswered += point.indirect.front().origin == AnswerOrigin::Unanswered;
  }
  EXPECT_GT(unanswered, 0);
  EXPECT_EQ(static_cast<std::uint64_t>(unanswered), frame.statistics.unanswered);
  int coarse = 0;
  int inexact = 0;
  expectSharesAddUp(frame, coarse, inexact);
  EXPECT_EQ(inexact, 0);
}

TEST(PixelReport, TakesAboutAMillisecond) {
  if (!render_test::isFast()) GTEST_SKIP();
  const RenderFrame frame = renderShipped("cornell.toml", 256);
  const std::clock_t start = std::clock();
  for (int i = 0; i < 100; ++i) pixelReport(frame, 5 + (i * 97) % 240, 5 + (i * 57) % 240);
  const double each = 10.0 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  RecordProperty("milliseconds", fmt::format("{:.2f}", each));
  EXPECT_LT(each, 20.0);
}

}  // namespace
}  // namespace lightvane::inspect_test
