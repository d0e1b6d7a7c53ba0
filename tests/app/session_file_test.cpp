#include "app/session_file.h"

#include <bit>
#include <cmath>
#include <fstream>
#include <limits>
#include <random>
#include <set>
#include <sstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/panels/layout.h"
#include "app/settings.h"
#include "core/base/file.h"
#include "core/scene/load_scene.h"
#include "core/scene/write_scene.h"
#include "tests/support/temporary_folder.h"

namespace lightvane {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr const char* kSceneBody = R"(
[material.white]
diffuse = [0.7, 0.7, 0.7]

[material.lamp]
emission = [10.0, 10.0, 10.0]

[[shape]]
type = "sphere"
material = "white"

[[shape]]
type = "disc"
name = "lamp"
material = "lamp"
center = [0.0, 3.0, 0.0]

[[shape]]
type = "disc"
name = "lamp"
material = "lamp"
center = [4.0, 3.0, 0.0]

[[light]]
type = "point"
name = "the \"key\" light"
position = [2.0, 2.0, 2.0]
)";

std::string sceneText(const std::string& camera) { return "version = 1\n" + camera + kSceneBody; }

/// A scene with two lights of one name and one of another, and its folder.
class SessionFileTest : public testing::Test {
 protected:
  explicit SessionFileTest(const std::string& render = "[render]\nilv.n_min = 7\n") {
    path_ = folder_.write(
        "room.toml", sceneText("[camera]\nposition = [0.0, 1.0, 8.0]\ntarget = [0.0, 1.0, 0.0]\n") + render);
    document_ = *loadDocument(path_);
  }

  fs::path session() const { return folder_ / "room.lvsession"; }
  /// What comes back of a workspace by way of a file's text.
  Workspace throughText(const Workspace& workspace, const Document& other) {
    const std::string text = sessionText(sessionOf(workspace, document_), session());
    const auto read = parseSession(text, session());
    EXPECT_TRUE(read) << read.error().message() << "\n" << text;
    if (!read) return {};
    EXPECT_EQ(*read, sessionOf(workspace, document_)) << text;
    const RestoredSession restored = applySession(*read, other, Display{});
    EXPECT_THAT(restored.warnings, IsEmpty());
    return restored.workspace;
  }
  Workspace throughText(const Workspace& workspace) { return throughText(workspace, document_); }

  TemporaryFolder folder_;
  fs::path path_;
  Document document_;
};

/// Every field that a session saves, other than its default.
Workspace changedWorkspace() {
  Workspace workspace;
  Setup& setup = workspace.setup;
  setup.parameters.picture.method = Method::Naive;
  setup.parameters.picture.seed = ~std::uint64_t{0};
  setup.parameters.transport.maxBounces = 5;
  applyRules(setup.parameters.vectors, Rules::Paper);
  setup.parameters.vectors.dlv.rMax = Length::metres(1.0 / 3.0);
  setup.camera = {"left \\ \"over\"",
                  {0.1, 1.0 / 3.0, 1e-7},
                  {1e9, 2.0, -3.5},
                  {0.0, -0.0, 1.0},
                  38.123456789012345,
                  640,
                  481,
                  -1.25};
  setup.lights.resize(3);
  setup.lights[1] = {true, true, {0.1f, 0.7f, 1.0f}, 0.3f};
  setup.lights[2].muted = true;
  setup.cacheLocked = true;
  setup.threads = 3;
  setup.memoryLimitMegabytes = 4096;
  Display& display = workspace.display;
  display.view = PictureView::Depth;
  setup.brightness.exposureStops = -1.0f / 3.0f;
  setup.brightness.toneMapping = ToneMap::Filmic;
  display.smooth = true;
  display.scale = {ColorMap::Cividis, true, -1e-20f, 3.4e38f};
  display.placement = {false, 0.1f, {-17.3f, 1e6f}};
  display.legend = false;
  display.sideBars = false;
  display.leftWidth = 251.7f;
  display.rightWidth = 699.9f;
  display.theme = Theme::Bright;
  display.uiScale = 1.265625f;
  display.reloads = true;
  OverlaySettings& overlays = display.overlays;
  overlays.shown = false;
  for (std::size_t kind = 0; kind < kOverlayKinds; ++kind) {
    OverlaySwitch& layer = overlays.layers[kind];
    layer = {!layer.shown, 1.1f + static_cast<float>(kind), 0.1f * static_cast<float>(kind)};
  }
  overlays.coloring = VectorColoring::Energy;
  overlays.mostRecords = 123'456;
  return workspace;
}

Workspace usualWorkspace(const Document& document) {
  Workspace workspace;
  workspace.setup.camera = document.description.cameras.front();
  workspace.setup.parameters = document.start;
  workspace.setup.lights.resize(document.scene->lights.size());
  return workspace;
}

/// A session that says nothing but which scene.
SessionFile sessionOn(const fs::path& scene) {
  SessionFile session;
  session.scene = scene;
  return session;
}

/// "[table]" and its lines "key = value", without comments; those of the whole file in "".
std::map<std::string, std::map<std::string, std::string>> linesOf(const std::string& text) {
  std::map<std::string, std::map<std::string, std::string>> tables;
  std::istringstream lines(text);
  std::string table;
  for (std::string line; std::getline(lines, line);) {
    line = line.substr(0, line.find("  #"));
    if (line.empty() || line.front() == '#') continue;
    if (line.front() == '[') {
      table = line;
      continue;
    }
    const std::size_t equal = line.find(" = ");
    tables[table][line.substr(0, equal)] = line.substr(equal + 3);
  }
  return tables;
}

// ---- there and back

TEST_F(SessionFileTest, EveryFieldComesBack) {
  const Workspace workspace = changedWorkspace();
  EXPECT_EQ(throughText(workspace), workspace);
}

TEST_F(SessionFileTest, TheTestAboveChangesEveryFieldOfTheDisplay) {
  // A field that has its default on both sides would come back without being saved.
  Workspace usual;
  usual.display.scale.map = ColorMap::Grey;
  const auto before = linesOf(sessionText(sessionOf(usual, document_), session()));
  const auto after = linesOf(sessionText(sessionOf(changedWorkspace(), document_), session()));
  int compared = 0;
  for (const auto& [table, lines] : before) {
    if (table == "[render]") continue;
    for (const auto& [key, value] : lines) {
      if (key == "version" || key == "scene") continue;
      EXPECT_NE(value, after.at(table).at(key)) << table << " " << key;
      ++compared;
    }
  }
  EXPECT_EQ(compared, 37) << "of the camera, the work and the display";
}

TEST_F(SessionFileTest, DefaultsComeBack) {
  const Workspace workspace = usualWorkspace(document_);
  EXPECT_EQ(throughText(workspace), workspace);
}

TEST_F(SessionFileTest, WhatIsOfTheMomentStaysBehind) {
  Workspace workspace = usualWorkspace(document_);
  const Workspace usual = workspace;
  workspace.display.comparison = {CompareMode::Wipe, CompareWith::Reference, true, 0.2f};
  workspace.display.overlays.growth = {false, 12, true};
  workspace.display.fullScreen = true;
  workspace.selection.pixel = PixelRef{3, 4};
  EXPECT_EQ(throughText(workspace), usual);

  Display current;
  current.fullScreen = true;
  current.smooth = true;
  const Workspace restored = applySession(sessionOf(usual, document_), document_, current).workspace;
  EXPECT_TRUE(restored.display.fullScreen) << "the window's own";
  EXPECT_FALSE(restored.display.smooth);
}

TEST_F(SessionFileTest, ParametersDoNotDependOnTheScenesRender) {
  Workspace workspace = usualWorkspace(document_);
  workspace.setup.parameters = Parameters{};  // what the scene sets is set back
  const fs::path other = folder_.write(
      "other.toml", sceneText("[camera]\n") + "[render]\nmethod.rules = \"paper\"\nilv.rows = 5\nseed = 9\n");
  const Document changed = *loadDocument(other);
  EXPECT_EQ(throughText(workspace, changed).setup.parameters, Parameters{});
  EXPECT_EQ(throughText(workspace).setup.parameters, Parameters{});
}

TEST_F(SessionFileTest, EveryRuleAndPresetComesBack) {
  for (const auto& [rules, rulesName] : kRulesNames) {
    for (const auto& [preset, presetName] : kPresetNames) {
      Workspace workspace = usualWorkspace(document_);
      applyRules(workspace.setup.parameters.vectors, rules);
      applyPreset(workspace.setup.parameters, preset);
      EXPECT_EQ(throughText(workspace), workspace) << rulesName << " " << presetName;
    }
  }
}

/// Numbers of every size, and the ends of their range.
class RandomValues {
 public:
  explicit RandomValues(unsigned seed) : engine_(seed) {}

  std::uint64_t bits() { return engine_(); }
  bool flip() { return (bits() & 1U) != 0; }
  int whole(int least, int greatest) { return std::uniform_int_distribution(least, greatest)(engine_); }
  double number(double least, double greatest) {
    switch (whole(0, 7)) {
      case 0:
        return least;
      case 1:
        return greatest;
      case 2:  // few digits
        return std::clamp(std::round(uniform(least, greatest) * 10.0) / 10.0, least, greatest);
      case 3:  // near 0
        return std::clamp(std::exp2(uniform(-60.0, 0.0)) * (flip() ? 1.0 : -1.0), least, greatest);
      default:
        return uniform(least, greatest);
    }
  }
  float real(float least, float greatest) {
    return std::clamp(static_cast<float>(number(static_cast<double>(least), static_cast<double>(greatest))),
                      least, greatest);
  }
  std::string word() {
    constexpr std::string_view kLetters = "ab \"\\'#=[]\n\t\x7f\x01.7";
    std::string text = flip() ? "ü" : "";
    for (int i = whole(0, 8); i > 0; --i) text += kLetters[bits() % kLetters.size()];
    return text;
  }

  // Parameters, by their visitor.
  void operator()(bool& value, const Field&) { value = flip(); }
  template <class E, std::size_t N>
  void operator()(E& value, const Field&, const std::array<Choice<E>, N>& choices) {
    value = choices[bits() % N].value;
  }
  void operator()(std::uint64_t& value, const Field&, const Range<std::uint64_t>&) {
    value = bits() >> whole(0, 63);
  }
  void operator()(int& value, const Field&, const Range<int>& range) { value = whole(range.min, range.max); }
  template <class T>
  void operator()(T& value, const Field&, const Range<T>& range) {
    value = static_cast<T>(number(static_cast<double>(range.min), static_cast<double>(range.max)));
  }
  void operator()(Length& value, const Field&, const Range<Length>&) {
    value = flip() ? Length::metres(number(0.0, 100.0)) : Length::relative(number(0.0, 100.0) / 100.0);
  }

 private:
  double uniform(double least, double greatest) {
    return least + (greatest - least) * std::generate_canonical<double, 53>(engine_);
  }
  std::mt19937_64 engine_;
};

Workspace randomWorkspace(RandomValues& random, std::size_t lights) {
  Workspace workspace;
  Setup& setup = workspace.setup;
  if (random.flip()) visitParameters(setup.parameters, random);
  const auto point = [&](double reach) {
    return Vec3d(random.number(-reach, reach), random.number(-reach, reach), random.number(-reach, reach));
  };
  setup.camera.name = random.word();
  setup.camera.position = point(1e3);
  setup.camera.target = setup.camera.position + Vec3d(random.number(-1.0, 1.0), 0.1, -1.0);
  setup.camera.up = Vec3d(random.number(-0.5, 0.5), 1.0, random.number(-0.5, 0.5));
  if (random.flip()) {
    setup.camera.projection = Projection::Orthographic;
    setup.camera.orthographicHeight = random.number(0.01, 100.0);
  } else {
    setup.camera.fovYDegrees = random.number(0.001, 179.999);
    if (random.flip()) setup.camera.lensRadius = random.number(0.001, 10.0);
    if (random.flip()) setup.camera.focusDistance = random.number(0.01, 1000.0);
  }
  setup.camera.width = random.whole(1, 65536);
  setup.camera.height = random.whole(1, 65536);
  setup.camera.exposureStops = random.number(-100.0, 100.0);
  setup.lights.resize(lights);
  for (LightSetting& light : setup.lights) {
    if (random.flip()) continue;
    light = {random.flip(), random.flip(),
             Rgb(random.real(0.0f, 1.0f), random.real(0.0f, 1.0f), random.real(0.0f, 1.0f)),
             random.real(-20.0f, 20.0f)};
  }
  setup.cacheLocked = random.flip();
  setup.threads = random.whole(0, 1024);
  setup.memoryLimitMegabytes = random.whole(0, 1'000'000);
  Display& display = workspace.display;
  display.view = pictureViews()[random.bits() % pictureViews().size()].view;
  setup.brightness.exposureStops = random.real(-20.0f, 20.0f);
  setup.brightness.toneMapping = kToneMapNames[random.bits() % kToneMapNames.size()].value;
  display.smooth = random.flip();
  if (random.flip()) display.scale.map = static_cast<ColorMap>(random.whole(0, 3));
  display.scale.fixedRange = random.flip();
  display.scale.low = random.real(-1e30f, 1e30f);
  display.scale.high = std::max(display.scale.low, random.real(-1e30f, 1e30f));
  for (OverlaySwitch& layer : display.overlays.layers) {
    layer = {random.flip(), random.real(0.1f, 20.0f), random.real(0.0f, 1.0f)};
  }
  display.overlays.shown = random.flip();
  display.overlays.coloring = kVectorColoringNames[random.bits() % kVectorColoringNames.size()].value;
  display.overlays.mostRecords = random.whole(1, 10'000'000);
  display.placement = {
      random.flip(), random.real(1.0f / 64.0f, 128.0f), {random.real(-1e6f, 1e6f), random.real(-1e6f, 1e6f)}};
  display.legend = random.flip();
  display.sideBars = random.flip();
  display.leftWidth = random.real(kLeastBarWidth, kLargestBarWidth);
  display.rightWidth = random.real(kLeastBarWidth, kLargestBarWidth);
  display.theme = random.flip() ? Theme::Dark : Theme::Bright;
  display.uiScale = random.real(0.6f, 3.0f);
  return workspace;
}

TEST_F(SessionFileTest, RandomValuesComeBack) {
  for (unsigned seed = 0; seed < 300; ++seed) {
    RandomValues random(seed);
    const Workspace workspace = randomWorkspace(random, document_.scene->lights.size());
    ASSERT_EQ(throughText(workspace), workspace) << "seed " << seed;
  }
}

TEST_F(SessionFileTest, LengthsKeepAllTheirDigits) {
  // Neither in nine digits, as settings are written: another unit of a length that was typed, and a step
  // beside the default.
  for (const Length length :
       {Length::relative(0.0815 / 3.7), Length::metres(0.1 / 3.0),
        Length::relative(std::nextafter(1.5, 2.0) / 100.0), Length::relative(0.0), Length::relative(1.0)}) {
    Workspace workspace = usualWorkspace(document_);
    workspace.setup.parameters.vectors.dlv.rMax = length;
    EXPECT_EQ(throughText(workspace).setup.parameters.vectors.dlv.rMax, length)
        << fmt::format("{} {}", length.value(), length.isRelative());
  }
}

TEST_F(SessionFileTest, TheSignOfZeroComesBack) {
  Workspace workspace = usualWorkspace(document_);
  workspace.setup.camera.position.x = -0.0;
  workspace.display.placement.pan.x = -0.0f;
  const Workspace restored = throughText(workspace);
  EXPECT_TRUE(std::signbit(restored.setup.camera.position.x));
  EXPECT_TRUE(std::signbit(restored.display.placement.pan.x));
}

TEST_F(SessionFileTest, TheFloatThatDoubleRoundingMissesComesBack) {
  Workspace workspace = usualWorkspace(document_);
  workspace.display.placement.pan.x = 7.038531e-26f;
  EXPECT_EQ(throughText(workspace).display.placement.pan.x, 7.038531e-26f);
}

// ---- the text

TEST_F(SessionFileTest, IsWrittenForPeople) {
  Workspace workspace = usualWorkspace(document_);
  workspace.setup.parameters.vectors.ilv.nMin = 5;
  workspace.setup.lights[1].muted = true;
  EXPECT_EQ(sessionText(sessionOf(workspace, document_), session()),
            R"(# What was looked at in Lightvane, and how. Whatever is left out has its default.
version = 1
scene = "room.toml"
cache_locked = false  # true: no new light vector is computed
threads = 0  # 0: as many as the machine has cores
memory_limit = 0  # MB; 0: none

[camera]
position = [0.0, 1.0, 8.0]
target = [0.0, 1.0, 0.0]
up = [0.0, 1.0, 0.0]
fov_y = 45.0
resolution = [512, 512]
exposure = 0.0

[render]  # parameters that are not at their defaults; the scene's own do not count
ilv.n_min = 5

[[light]]
name = "lamp"
number = 2  # of the lights of this name
mute = true
solo = false
tint = [1.0, 1.0, 1.0]  # its colour is multiplied by this, linear
stops = 0.0  # its intensity is multiplied by 2^stops

[display]  # how it is shown
view = "beauty"
exposure = 0.0  # stops, beside the camera's
tone_mapping = "clip"
smooth = false  # magnified pixels are blended
legend = true

[display.scale]  # of views of one number
fixed_range = false  # false: the range follows the picture
low = 0.0
high = 1.0

[display.placement]  # of the picture on the screen
fit = true  # true: all of it, as large as there is room
zoom = 1.0  # screen pixels a picture pixel
pan = [0.0, 0.0]  # of its middle, screen pixels

[display.overlays]  # light vectors over the picture
shown = true  # false: none, whatever the kinds say
coloring = "surface"  # what an ILV's colour says
most = 2000  # of a kind, in a picture of 640 x 640 points; of more, every n-th is shown
ilv = { shown = true, size = 1.0, opacity = 1.0 }
ilv_zones = { shown = true, size = 1.0, opacity = 0.35 }
ilv_gradients = { shown = true, size = 1.0, opacity = 1.0 }
dlv = { shown = true, size = 1.0, opacity = 1.0 }
dlv_radius = { shown = false, size = 1.0, opacity = 0.25 }
dlv_directions = { shown = false, size = 1.0, opacity = 1.0 }
mirror_images = { shown = false, size = 1.0, opacity = 1.0 }

[display.window]
side_bars = true
left_width = 290.0  # at UI scale 1
right_width = 330.0
theme = "dark"
ui_scale = 1.0  # beside the monitor's
reload = false  # the scene by itself, when its file changes
)");
}

TEST_F(SessionFileTest, TheManualNamesEveryKey) {
  const std::string manual = readFile(fs::path(LIGHTVANE_SOURCE_DIR) / "docs/manual.md").value();
  Workspace workspace = changedWorkspace();
  for (const auto& [table, lines] : linesOf(sessionText(sessionOf(workspace, document_), session()))) {
    if (table == "[render]" || table == "[camera]") continue;  // docs/scene-format.md has them
    for (const auto& [key, value] : lines) {
      EXPECT_THAT(manual, HasSubstr("`" + key + "`")) << table << " " << key;
    }
  }
  for (const PictureViewInfo& view : pictureViews()) {
    EXPECT_THAT(manual, HasSubstr(fmt::format("`{}`", view.name)));
  }
  for (const auto& [coloring, name] : kVectorColoringNames) {
    EXPECT_THAT(manual, HasSubstr(fmt::format("`{}`", name)));
  }
}

TEST(CameraToml, IsACameraOfASceneFile) {
  const CameraDescription camera = changedWorkspace().setup.camera;
  const auto scene = parseSceneToml(sceneText(cameraToml(camera)), "room.toml");
  ASSERT_TRUE(scene) << scene.error().message();
  EXPECT_THAT(scene->cameras, ElementsAre(camera));
}

TEST(CameraToml, HasNoNameWhereTheCameraHasNone) {
  EXPECT_EQ(cameraToml(CameraDescription{}),
            "[camera]\nposition = [0.0, 0.0, 0.0]\ntarget = [0.0, 0.0, -1.0]\nup = [0.0, 1.0, 0.0]\n"
            "fov_y = 45.0\nresolution = [512, 512]\nexposure = 0.0\n");
}

TEST(CameraToml, HasWhatALensOrAnOrthographicCameraTakes) {
  CameraDescription lens;
  lens.lensRadius = 0.05;
  lens.focusDistance = 2.0 / 3.0;
  EXPECT_THAT(cameraToml(lens), HasSubstr("lens_radius = 0.05\nfocus_distance = 0.6666666666666666\n"));
  CameraDescription onTarget;
  onTarget.lensRadius = 0.05;
  EXPECT_THAT(cameraToml(onTarget), Not(HasSubstr("focus_distance")));
  CameraDescription flat;
  flat.projection = Projection::Orthographic;
  flat.orthographicHeight = 2.5;
  EXPECT_THAT(cameraToml(flat), HasSubstr("projection = \"orthographic\"\nheight = 2.5\n"));
  EXPECT_THAT(cameraToml(flat), Not(HasSubstr("fov_y")));
  for (const CameraDescription& camera : {lens, onTarget, flat}) {
    const auto scene = parseSceneToml(sceneText(cameraToml(camera)), "room.toml");
    ASSERT_TRUE(scene) << scene.error().message();
    EXPECT_THAT(scene->cameras, ElementsAre(camera));
  }
}

// ---- what is missing, what the scene does not have

TEST_F(SessionFileTest, OfWhatIsMissingTheSceneDecides) {
  const auto read = parseSession("version = 1\nscene = \"room.toml\"\n", session());
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(*read, sessionOn(path_));
  const RestoredSession restored = applySession(*read, document_, Display{});
  EXPECT_EQ(restored.workspace, usualWorkspace(document_));
  EXPECT_EQ(restored.workspace.setup.parameters.vectors.ilv.nMin, 7) << "the scene's";
  EXPECT_THAT(restored.warnings, IsEmpty());
}

TEST_F(SessionFileTest, AnEmptyRenderIsOfDefaults) {
  const auto read = parseSession("version = 1\nscene = \"room.toml\"\n[render]\n", session());
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(applySession(*read, document_, Display{}).workspace.setup.parameters, Parameters{});
}

TEST_F(SessionFileTest, RenderTakesWhatAScenesDoes) {
  const auto read = parseSession(
      "version = 1\nscene = \"a.toml\"\n[render]\npreset = \"draft\"\n[render.ilv]\nn_min = 3\n", session());
  ASSERT_TRUE(read) << read.error().message();
  Parameters expected;
  applyPreset(expected, Preset::Draft);
  expected.vectors.ilv.nMin = 3;
  EXPECT_EQ(read->parameters, expected);
}

TEST_F(SessionFileTest, WarnsOfLightsThatTheSceneDoesNotHave) {
  SessionFile session = sessionOf(usualWorkspace(document_), document_);
  const LightSetting muted{.muted = true};
  session.lights = {{"moon", 1, muted}, {"lamp", 2, muted}, {"lamp", 3, muted}};
  const RestoredSession restored = applySession(session, document_, Display{});
  EXPECT_THAT(
      restored.warnings,
      ElementsAre("The session changes the light \"moon\", which room.toml does not have.",
                  "The session changes the light \"lamp\", number 3, which room.toml does not have."));
  EXPECT_THAT(restored.workspace.setup.lights, ElementsAre(LightSetting{}, muted, LightSetting{}));
}

TEST_F(SessionFileTest, LightsAreFoundByNameWhereverTheyWent) {
  Workspace workspace = usualWorkspace(document_);
  workspace.setup.lights[2].soloed = true;
  SessionFile session = sessionOf(workspace, document_);
  const fs::path other =
      folder_.write("other.toml", sceneText("[camera]\nposition = [0.0, 1.0, 8.0]\n") +
                                      "[[light]]\ntype = \"point\"\nname = \"last\"\n"
                                      "[[shape]]\ntype = \"sphere\"\nname = \"first\"\nmaterial = \"lamp\"\n"
                                      "center = [9.0, 9.0, 9.0]\n");
  const Document changed = *loadDocument(other);
  const RestoredSession restored = applySession(session, changed, Display{});
  EXPECT_THAT(restored.warnings, IsEmpty());
  for (std::size_t i = 0; i < changed.scene->lights.size(); ++i) {
    EXPECT_EQ(restored.workspace.setup.lights[i].soloed, changed.scene->lightNames[i] == "the \"key\" light");
  }
}

TEST_F(SessionFileTest, WarnsOfACameraThatCannotBe) {
  SessionFile session = sessionOf(usualWorkspace(document_), document_);
  CameraDescription camera;
  camera.target = {0.0, 0.0, -1e-200};  // too near to tell in which direction
  session.camera = camera;
  const RestoredSession restored = applySession(session, document_, Display{});
  ASSERT_EQ(restored.warnings.size(), 1U);
  EXPECT_THAT(restored.warnings.front(), HasSubstr("The session's camera"));
  EXPECT_EQ(restored.workspace.setup.camera, document_.description.cameras.front());
}

// ---- where the scene is

TEST_F(SessionFileTest, AFolderCanBeMoved) {
  fs::create_directories(folder_ / "work/sessions");
  fs::create_directories(folder_ / "work/scenes");
  fs::copy(path_, folder_ / "work/scenes/room.toml");
  const Document document = *loadDocument(folder_ / "work/scenes/room.toml");
  const SessionFile session = sessionOf(usualWorkspace(document), document);
  ASSERT_TRUE(saveSession(session, folder_ / "work/sessions/a.lvsession"));
  fs::rename(folder_ / "work", folder_ / "moved");
  const auto read = loadSession(folder_ / "moved/sessions/a.lvsession");
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(read->scene, folder_ / "moved/scenes/room.toml");
  EXPECT_TRUE(loadDocument(read->scene));
}

struct PathRow {
  const char* name;
  const char* scene;
  const char* where;
  const char* written;
};
void PrintTo(const PathRow& row, std::ostream* out) { *out << row.name; }

class ScenePath : public testing::TestWithParam<PathRow> {};

TEST_P(ScenePath, IsRelativeWhereItIsNear) {
  const PathRow& row = GetParam();
  const std::string text = sessionText(sessionOn(row.scene), row.where);
  EXPECT_THAT(text, HasSubstr(fmt::format("scene = \"{}\"\n", row.written)));
  const auto read = parseSession(text, row.where);
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(fs::absolute(read->scene), fs::absolute(row.scene).lexically_normal());
}

INSTANTIATE_TEST_SUITE_P(
    SessionFile, ScenePath,
    testing::Values(
        PathRow{"Beside", "/home/ann/room.toml", "/home/ann/a.lvsession", "room.toml"},
        PathRow{"Below", "/home/ann/in/a \"b\"/room.toml", "/home/ann/a.lvsession",
                R"(in/a \"b\"/room.toml)"},
        PathRow{"OneUp", "/home/ann/room.toml", "/home/ann/in/a.lvsession", "../room.toml"},
        PathRow{"TwoUp", "/home/ann/b/room.toml", "/home/ann/in/in/a.lvsession", "../../b/room.toml"},
        PathRow{"TooFarUp", "/home/ann/room.toml", "/home/ann/a/b/c/a.lvsession", "/home/ann/room.toml"},
        PathRow{"NothingInCommon", "/usr/room.toml", "/home/a.lvsession", "/usr/room.toml"},
        PathRow{"AtTheRoot", "/usr/room.toml", "/a.lvsession", "usr/room.toml"},
        PathRow{"Roundabout", "/home/ann/x/../room.toml", "/home/ann/./a.lvsession", "room.toml"},
        PathRow{"OfTheCurrentFolder", "room.toml", "a.lvsession", "room.toml"},
        PathRow{"BelowTheCurrentFolder", "scenes/room.toml", "sessions/a.lvsession", "../scenes/room.toml"}),
    [](const auto& row) { return row.param.name; });

TEST(SessionScene, StaysRelativeToTheCurrentFolderWhereTheSessionIs) {
  const auto read = parseSession("version = 1\nscene = \"../b/room.toml\"\n", "a/x.lvsession");
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(read->scene, "b/room.toml");
}

// ---- bad input

struct BadRow {
  const char* name;
  const char* text;
  const char* message;
};
void PrintTo(const BadRow& row, std::ostream* out) { *out << row.name; }

class BadSession : public testing::TestWithParam<BadRow> {};

TEST_P(BadSession, GetsOneMessageWithItsPlace) {
  const BadRow& row = GetParam();
  const auto read = parseSession(row.text, "a.lvsession");
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().message(), row.message);
}

#define GOOD "version = 1\nscene = \"a.toml\"\n"
INSTANTIATE_TEST_SUITE_P(
    SessionFile, BadSession,
    testing::Values(
        BadRow{
            "Empty", "",
            "a.lvsession:1:1: this is no session (a session starts with version = 1 and scene = \"FILE\")"},
        BadRow{
            "Scene", "version = 1\n[camera]\n[[shape]]\n",
            "a.lvsession:1:1: this is a scene, not a session (a session starts with version = 1 and scene = "
            "\"FILE\")"},
        BadRow{
            "OtherToml", "[package]\nname = \"a\"\n",
            "a.lvsession:1:1: this is no session (a session starts with version = 1 and scene = \"FILE\")"},
        BadRow{"NewerVersion", "version = 2\nscene = 7\nnews = true\n",
               "a.lvsession:1:11: version of the file: 2 is of a later Lightvane; this one reads 1"},
        BadRow{"VersionWithoutMeaning", "version = \"new\"\nscene = \"a.toml\"\n",
               "a.lvsession:1:11: version of the file: expected a whole number from 1, found \"new\""},
        BadRow{"NoVersion", "scene = \"a.toml\"\n",
               "a.lvsession:1:1: version of the file: missing, expected version = 1"},
        BadRow{
            "NoScene", "version = 1\n[display]\n",
            "a.lvsession:1:1: scene of the file: missing, expected the scene's file, relative to this one"},
        BadRow{"EmptyScene", "version = 1\nscene = \"\"\n",
               "a.lvsession:2:9: scene of the file: expected a file, found \"\""},
        BadRow{"UnknownKey", GOOD "treads = 2\n",
               "a.lvsession:3:1: treads of the file: unknown key (did you mean threads?)"},
        BadRow{"UnknownTable", GOOD "[displai]\n",
               "a.lvsession:3:2: displai of the file: unknown key (did you mean display?)"},
        BadRow{"UnknownKeyInATable", GOOD "[display.scale]\nlov = 0.0\n",
               "a.lvsession:4:1: lov of [display.scale]: unknown key (did you mean low?)"},
        BadRow{"UnknownKeyOfAKind", GOOD "[display.overlays]\nilv = { opacty = 1.0 }\n",
               "a.lvsession:4:9: opacty of [display.overlays.ilv]: unknown key (did you mean opacity?)"},
        BadRow{"UnknownParameter", GOOD "[render]\nilv.n_mim = 3\n",
               "a.lvsession:4:5: there is no parameter 'ilv.n_mim' (did you mean ilv.n_min?)"},
        BadRow{"ParameterOutOfRange", GOOD "[render]\nilv.n_min = 0\n",
               "a.lvsession:4:5: ilv.n_min takes a value from 1 to 1000, not '0'"},
        BadRow{"CameraOutOfRange", GOOD "[camera]\nfov_y = 200.0\n",
               "a.lvsession:4:9: fov_y of [camera]: expected a number from 0.001 to 179.999, found 200"},
        BadRow{
            "SeveralCameras", GOOD "[[camera]]\n",
            "a.lvsession:3:1: camera of the file: expected one table, found an array of 1 (a session has one "
            "camera)"},
        BadRow{
            "Zoom", GOOD "[display.placement]\nzoom = 0.0\n",
            "a.lvsession:4:8: zoom of [display.placement]: expected a number from 0.0001 to 100000, found 0"},
        BadRow{
            "Pan", GOOD "[display.placement]\npan = [0.0, nan]\n",
            "a.lvsession:4:13: pan of [display.placement]: expected [a, b], two finite numbers up to 3.4e38, "
            "found nan"},
        BadRow{"Exposure", GOOD "[display]\nexposure = 20.5\n",
               "a.lvsession:4:12: exposure of [display]: expected a number from -20 to 20, found 20.5"},
        BadRow{"Opacity", GOOD "[display.overlays]\ndlv = { opacity = 1.5 }\n",
               "a.lvsession:4:19: opacity of [display.overlays.dlv]: expected a number in [0, 1], found 1.5"},
        BadRow{"Size", GOOD "[display.overlays]\ndlv = { size = 0 }\n",
               "a.lvsession:4:16: size of [display.overlays.dlv]: expected a number from 0.1 to 20, found 0"},
        BadRow{
            "Most", GOOD "[display.overlays]\nmost = 1.5\n",
            "a.lvsession:4:8: most of [display.overlays]: expected a whole number from 1 to 10000000, found "
            "1.5"},
        BadRow{
            "Width", GOOD "[display.window]\nleft_width = 10\n",
            "a.lvsession:4:14: left_width of [display.window]: expected a number from 250 to 700, found 10"},
        BadRow{"UiScale", GOOD "[display.window]\nui_scale = inf\n",
               "a.lvsession:4:12: ui_scale of [display.window]: expected a number from 0.6 to 3, found inf"},
        BadRow{"Theme", GOOD "[display.window]\ntheme = \"drak\"\n",
               "a.lvsession:4:9: theme of [display.window]: expected dark or bright, found \"drak\" (did you "
               "mean dark?)"},
        BadRow{"View", GOOD "[display]\nview = \"beaty\"\n",
               "a.lvsession:4:8: view of [display]: expected beauty, direct, indirect, specular, "
               "where-computed, "
               "vectors-used, nearest-vector, error, estimated-error, error-sources, albedo, normal or "
               "depth, found "
               "\"beaty\" (did you mean "
               "beauty?)"},
        BadRow{
            "ColorMap", GOOD "[display.scale]\ncolor_map = \"jet\"\n",
            "a.lvsession:4:13: color_map of [display.scale]: expected grey, viridis, cividis or diverging, "
            "found \"jet\""},
        BadRow{"UpsideDownRange", GOOD "[display.scale]\nfixed_range = true\nlow = 2.0\n",
               "a.lvsession:5:7: low of [display.scale]: expected low up to high, found 2 to 1"},
        BadRow{"Smooth", GOOD "[display]\nsmooth = 1\n",
               "a.lvsession:4:10: smooth of [display]: expected true or false, found 1"},
        BadRow{"Threads", GOOD "threads = -1\n",
               "a.lvsession:3:11: threads of the file: expected a whole number from 0 to 1024, found -1"},
        BadRow{"DisplayIsNoTable", GOOD "display = 3\n",
               "a.lvsession:3:11: display of the file: expected one table, found 3"},
        BadRow{"LightWithoutName", GOOD "[[light]]\nmute = true\n",
               "a.lvsession:3:1: name of [[light]] 1: missing, expected the light's name"},
        BadRow{"LightIsNoArray", GOOD "[light]\n",
               "a.lvsession:3:1: light of the file: expected an array of tables, found a table (write "
               "[[light]])"},
        BadRow{"LightTwice", GOOD "[[light]]\nname = \"a\"\n[[light]]\nname = \"a\"\n",
               "a.lvsession:6:8: name of [[light]] 2 (a): there is a [[light]] \"a\" already (lights of one "
               "name "
               "are told apart by number = 1, 2, ...)"},
        BadRow{"LightStops", GOOD "[[light]]\nname = \"a\"\nstops = 21\n",
               "a.lvsession:5:9: stops of [[light]] 1 (a): expected a number from -20 to 20, found 21"},
        BadRow{"LightTint", GOOD "[[light]]\nname = \"a\"\ntint = [1, -1, 1]\n",
               "a.lvsession:5:12: tint of [[light]] 1 (a): expected [a, b, c], three numbers from 0 to 1000, "
               "found -1"}),
    [](const auto& row) { return row.param.name; });
#undef GOOD

TEST(DamagedSession, IsRefusedAtItsPlace) {
  const auto read = parseSession("version = 1\nscene = \"a.toml\n", "a.lvsession");
  ASSERT_FALSE(read);
  EXPECT_THAT(read.error().message(), testing::StartsWith("a.lvsession:2:"));
}

TEST_F(SessionFileTest, NoHalfOfAFileIsTakenForMore) {
  // Cut anywhere, it is refused or says less, and never ends the program.
  const std::string text = sessionText(sessionOf(changedWorkspace(), document_), session());
  for (std::size_t length = 0; length < text.size(); ++length) {
    const auto read = parseSession(text.substr(0, length), session());
    EXPECT_TRUE(read || !read.error().message().empty()) << length;
  }
}

// ---- files

TEST_F(SessionFileTest, IsSavedAndLoaded) {
  const SessionFile saved = sessionOf(changedWorkspace(), document_);
  ASSERT_TRUE(saveSession(saved, session()));
  const auto read = loadSession(session());
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(*read, saved);
}

TEST_F(SessionFileTest, ThatCannotBeReadIsNotSaved) {
  SessionFile broken = sessionOf(changedWorkspace(), document_);
  broken.scene = folder_ / "r\xe4um.toml";
  const auto named = saveSession(broken, session());
  ASSERT_FALSE(named);
  EXPECT_THAT(named.error().message(),
              testing::StartsWith(session().string() + ": not written, as it could not be read: "));
  broken = sessionOf(changedWorkspace(), document_);
  broken.display.placement.pan.x = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(saveSession(broken, session()));
  EXPECT_THAT(folder_.files(), ElementsAre("room.toml"));
}

TEST_F(SessionFileTest, ThatIsNotThereIsNamed) {
  const auto read = loadSession(folder_ / "none.lvsession");
  ASSERT_FALSE(read);
  EXPECT_THAT(read.error().message(), HasSubstr("none.lvsession"));
}

}  // namespace
}  // namespace lightvane
