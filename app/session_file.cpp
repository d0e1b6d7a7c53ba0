#include "app/session_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "app/panels/layout.h"
#include "app/settings.h"
#include "core/base/file.h"
#include "core/base/tasks.h"
#include "core/base/text.h"
#include "core/scene/toml_tables.h"
#include "core/scene/toml_text.h"
#include "core/scene/write_scene.h"

namespace lightvane {
namespace {

namespace fs = std::filesystem;

constexpr int kVersion = 1;
constexpr const char* kExample = "a session starts with version = 1 and scene = \"FILE\"";

// A scene at most so many folders up is moved together with the session.
constexpr std::ptrdiff_t kMostFoldersUp = 2;

// What the window's controls can reach is never refused. Written as double: 0.6f would be above its own text.

constexpr Interval kAnyVersion{1.0, 1e9, "whole ", " from 1"};
constexpr Interval kLightNumber{1.0, 1e9, "whole ", " from 1"};
constexpr Interval kLightTint{0.0, 1000.0, "", " from 0 to 1000"};
constexpr Interval kLightStops{-20.0, 20.0, "", " from -20 to 20"};
constexpr Interval kThreads{0.0, kMostThreads, "whole ", " from 0 to 1024"};
constexpr Interval kMemoryLimit{0.0, 1e6, "whole ", " from 0 to 1000000"};
constexpr Interval kExposure{-20.0, 20.0, "", " from -20 to 20"};
static_assert(kExposure.greatest == static_cast<double>(kMaxExposureStops));
constexpr double kLargestFloat = std::numeric_limits<float>::max();
constexpr Interval kFiniteFloat{-kLargestFloat, kLargestFloat, "finite ", " up to 3.4e38"};
// More than the wheel reaches: small pictures that fill their place are larger, huge ones smaller.
constexpr Interval kZoom{1e-4, 1e5, "", " from 0.0001 to 100000"};
constexpr Interval kOverlaySize{0.1, 20.0, "", " from 0.1 to 20"};
constexpr Interval kMostRecords{1.0, 1e7, "whole ", " from 1 to 10000000"};
constexpr Interval kBarWidth{250.0, 700.0, "", " from 250 to 700"};
static_assert(kBarWidth.least == static_cast<double>(kLeastBarWidth) &&
              kBarWidth.greatest == static_cast<double>(kLargestBarWidth));
constexpr Interval kUiScale{0.6, 3.0, "", " from 0.6 to 3"};

// Words of files; labels of controls may change.

constexpr std::array kThemeWords{Choice{Theme::Dark, "dark"}, Choice{Theme::Bright, "bright"}};
/// In the order of OverlayKind.
constexpr std::array<const char*, kOverlayKinds> kOverlayKeys{
    "ilv", "ilv_zones", "ilv_gradients", "dlv", "dlv_radius", "dlv_directions", "mirror_images"};
static_assert(kOverlayKeys.back() != nullptr, "a kind of overlay has no key");

// ---- the list of fields, for the writer and the reader
//
// Every struct is taken apart by its fields' names, so that nothing compiles once it has another field, until
// somebody says here whether that is saved.

template <class Light, class Visit>
void visitLight(Light& light, Visit& visit) {
  auto& [muted, soloed, tint, stops] = light;
  visit("mute", muted, "");
  visit("solo", soloed, "");
  visit("tint", tint, kLightTint, "its colour is multiplied by this, linear");
  visit("stops", stops, kLightStops, "its intensity is multiplied by 2^stops");
}

template <class Bool, class Int, class Visit>
void visitWork(Bool& cacheLocked, Int& threads, Int& memoryLimit, Visit& visit) {
  visit("cache_locked", cacheLocked, "true: no new light vector is computed");
  visit("threads", threads, kThreads, "0: as many as the machine has cores");
  visit("memory_limit", memoryLimit, kMemoryLimit, "MB; 0: none");
}

template <class Scale, class Visit>
void visitScale(Scale& scale, Visit& visit) {
  auto& [map, fixedRange, low, high] = scale;
  visit.table("display.scale", "of views of one number");
  visit("color_map", map, kColorMapWords, "without it, each view has its own");
  visit("fixed_range", fixedRange, "false: the range follows the picture");
  visit("low", low, kFiniteFloat, "");
  visit("high", high, kFiniteFloat, "");
}

template <class Placement, class Visit>
void visitPlacement(Placement& placement, Visit& visit) {
  auto& [fit, zoom, pan] = placement;
  visit.table("display.placement", "of the picture on the screen");
  visit("fit", fit, "true: all of it, as large as there is room");
  visit("zoom", zoom, kZoom, "screen pixels a picture pixel");
  visit("pan", pan, kFiniteFloat, "of its middle, screen pixels");
}

template <class Overlays, class Visit>
void visitOverlays(Overlays& overlays, Visit& visit) {
  // Vectors are computed again, in another order where others are looked at: a moment of their growth would
  // show something else.
  [[maybe_unused]] auto& [shown, layers, coloring, mostRecords, growth] = overlays;
  visit.table("display.overlays", "light vectors over the picture");
  visit("shown", shown, "false: none, whatever the kinds say");
  visit("coloring", coloring, kVectorColoringNames, "what an ILV's colour says");
  visit("most", mostRecords, kMostRecords,
        "of a kind, in a picture of 640 x 640 points; of more, every n-th is shown");
  for (std::size_t kind = 0; kind < kOverlayKinds; ++kind) visit(kOverlayKeys[kind], layers[kind]);
}

template <class Width, class Look, class Scale, class Bool, class Visit>
void visitSettings(Width& leftWidth, Width& rightWidth, Look& theme, Scale& uiScale, Bool& reloads,
                   Visit& visit) {
  visit("left_width", leftWidth, kBarWidth, "at UI scale 1");
  visit("right_width", rightWidth, kBarWidth, "");
  visit("theme", theme, kThemeWords, "");
  visit("ui_scale", uiScale, kUiScale, "beside the monitor's");
  visit("reload", reloads, "the scene by itself, when its file changes");
}

template <class Settings, class Visit>
void visitSettings(Settings& settings, Visit& visit) {
  auto& [leftWidth, rightWidth, theme, uiScale, reloads] = settings;
  visit.table("window", "");
  visitSettings(leftWidth, rightWidth, theme, uiScale, reloads, visit);
}

template <class D, class B, class Visit>
void visitDisplay(D& display, B& brightness, Visit& visit) {
  // Comparison: the picture to compare with is not saved. Full screen is the window's own affair.
  [[maybe_unused]] auto& [view, source, smooth, scale, overlays, placement, comparison, legend, sideBars,
                          leftWidth, rightWidth, theme, uiScale, reloads, fullScreen] = display;
  visit.table("display", "how it is shown");
  visit("view", view, "");
  visit("source", source, kErrorSourceNames, "of the view error-sources; without it, which is the largest");
  visit("exposure", brightness.exposureStops, kExposure, "stops, beside the camera's");
  visit("tone_mapping", brightness.toneMapping, kToneMapWords, "");
  visit("smooth", smooth, "magnified pixels are blended");
  visit("legend", legend, "");
  visitScale(scale, visit);
  visitPlacement(placement, visit);
  visitOverlays(overlays, visit);
  visit.table("display.window", "");
  visit("side_bars", sideBars, "");
  visitSettings(leftWidth, rightWidth, theme, uiScale, reloads, visit);
}

/// The display without what a session leaves behind.
Display savedPart(const Display& display) {
  Display saved = display;
  saved.comparison = {};
  saved.overlays.growth = {};
  saved.fullScreen = false;
  return saved;
}

// ---- writing

std::string arrayText(const Vec2& v) { return fmt::format("[{}, {}]", tomlNumber(v.x), tomlNumber(v.y)); }
/// Writes the fields that it is shown.
class FieldWriter {
 public:
  explicit FieldWriter(std::string& text) : text_(text) {}

  void table(const char* name, std::string_view help) {
    text_ += fmt::format("\n[{}]{}{}\n", name, help.empty() ? "" : "  # ", help);
  }
  void operator()(const char* key, const bool& value, const char* help) {
    add(key, value ? "true" : "false", help);
  }
  void operator()(const char* key, const int& value, const Interval&, const char* help) {
    add(key, std::to_string(value), help);
  }
  void operator()(const char* key, const float& value, const Interval&, const char* help) {
    add(key, tomlNumber(value), help);
  }
  void operator()(const char* key, const Vec2& value, const Interval&, const char* help) {
    add(key, arrayText(value), help);
  }
  void operator()(const char* key, const Rgb& value, const Interval&, const char* help) {
    add(key, tomlTriple(value), help);
  }
  template <class E, std::size_t N>
  void operator()(const char* key, const E& value, const std::array<Choice<E>, N>& words, const char* help) {
    add(key, tomlString(choiceName(words, value)), help);
  }
  template <class E, std::size_t N>
  void operator()(const char* key, const std::optional<E>& value, const std::array<Choice<E>, N>& words,
                  const char* help) {
    if (value) (*this)(key, *value, words, help);
  }
  void operator()(const char* key, const PictureView& value, const char* help) {
    add(key, tomlString(pictureViewInfo(value).name), help);
  }
  void operator()(const char* key, const OverlaySwitch& value) {
    const auto& [shown, size, opacity] = value;
    add(key,
        fmt::format("{{ shown = {}, size = {}, opacity = {} }}", shown, tomlNumber(size),
                    tomlNumber(opacity)),
        "");
  }

 private:
  void add(const char* key, std::string_view value, const char* help) { text_ += tomlLine(key, value, help); }

  std::string& text_;
};

bool readsAs(const std::string& text, const Length& length) {
  Length read = Length::metres(0.0);
  return parameter_text::parse(text, read).empty() && read == length;
}

/// A length as text that reads back as it, where any does: percents are divided by 100, which leaves some
/// numbers out that no control gives either.
std::string exactLengthText(const Length& length) {
  std::string usual = parameter_text::format(length);
  if (readsAs(usual, length)) return usual;
  if (!length.isRelative()) return fmt::format("{}m", length.value());
  const double percent = length.value() * 100.0;
  for (const double end : {-HUGE_VAL, HUGE_VAL}) {
    std::string neighbour = fmt::format("{}%", std::nextafter(percent, end));
    if (readsAs(neighbour, length)) return neighbour;
  }
  return fmt::format("{}%", percent);
}

/// Gives lengths all their digits: settings are made for people, and round them.
class LengthRefiner {
 public:
  explicit LengthRefiner(std::vector<std::pair<std::string, std::string>>& settings) : settings_(settings) {}

  template <class... Anything>
  void operator()(const Anything&...) {}
  void operator()(const Length& value, const Field& field, const Range<Length>&) {
    const std::string exact = exactLengthText(value);
    const auto found = std::find_if(settings_.begin(), settings_.end(),
                                    [&](const auto& setting) { return setting.first == field.key; });
    if (found != settings_.end()) {
      found->second = exact;
    } else if (exact != parameter_text::format(value)) {
      settings_.emplace_back(field.key, exact);
    }
  }

 private:
  std::vector<std::pair<std::string, std::string>>& settings_;
};

/// By what differs from the defaults, whatever the scene says: its `[render]` may change.
std::string renderToml(const Parameters& parameters) {
  auto settings = reproducingSettings({}, parameters);
  LengthRefiner refiner(settings);
  visitParameters(parameters, refiner);
  std::string text = "[render]  # parameters that are not at their defaults; the scene's own do not count\n";
  for (const auto& [key, value] : settings) text += tomlLine(key, tomlSetting(value));
  return text;
}

std::string lightToml(const SessionLight& light) {
  std::string text = "\n[[light]]\n" + tomlLine("name", tomlString(light.name));
  if (light.number != 1)
    text += tomlLine("number", std::to_string(light.number), "of the lights of this name");
  FieldWriter writer(text);
  visitLight(light.setting, writer);
  return text;
}

/// The scene as a session at `where` names it.
std::string writtenScene(const fs::path& scene, const fs::path& where) {
  std::error_code ignored;
  const fs::path folder = fs::absolute(where, ignored).lexically_normal().parent_path();
  const fs::path target = fs::absolute(scene, ignored).lexically_normal();
  const fs::path relative = target.lexically_relative(folder);
  const std::ptrdiff_t up = std::count(relative.begin(), relative.end(), "..");
  const fs::path below = folder.relative_path();
  // With nothing in common but the root, two paths are not near.
  const bool isNear = !relative.empty() && up <= kMostFoldersUp &&
                      (up == 0 || up < std::distance(below.begin(), below.end()));
  return (isNear ? relative : target).generic_string();
}

// ---- reading

/// Reads the fields that it is shown; those of tables that are not there keep their values.
class FieldReader {
 public:
  explicit FieldReader(TomlTable& root) : root_(root), current_(&root) {}

  /// Goes on in the table of that name: "display", or "display.scale" after "display".
  void table(std::string_view name, std::string_view) {
    const std::size_t dot = name.rfind('.');
    TomlTable* outer = dot == std::string_view::npos ? &root_ : opened(name.substr(0, dot));
    const std::string_view key = dot == std::string_view::npos ? name : name.substr(dot + 1);
    std::optional<TomlTable> table = outer ? outer->subtable(key) : std::nullopt;
    current_ = table ? &tables_.emplace(name, *std::move(table)).first->second : nullptr;
  }
  void operator()(const char* key, bool& value, const char*) {
    if (current_) current_->read(key, value);
  }
  template <class T>
  void operator()(const char* key, T& value, const Interval& interval, const char*) {
    if (current_) current_->read(key, value, interval);
  }
  template <class E, std::size_t N>
  void operator()(const char* key, E& value, const std::array<Choice<E>, N>& words, const char*) {
    value = choiceNamed(words, readWord(key, choiceNames(words))).value_or(value);
  }
  template <class E, std::size_t N>
  void operator()(const char* key, std::optional<E>& value, const std::array<Choice<E>, N>& words,
                  const char*) {
    value = choiceNamed(words, readWord(key, choiceNames(words)));
  }
  void operator()(const char* key, PictureView& value, const char*) {
    std::vector<std::string> names;
    for (const PictureViewInfo& view : pictureViews()) names.emplace_back(view.name);
    value = pictureViewNamed(readWord(key, names)).value_or(value);
  }
  void operator()(const char* key, OverlaySwitch& value) {
    std::optional<TomlTable> table = current_ ? current_->subtable(key) : std::nullopt;
    if (!table) return;
    auto& [shown, size, opacity] = value;
    table->read("shown", shown);
    table->read("size", size, kOverlaySize);
    table->read("opacity", opacity, kUnitInterval);
    table->finish();
  }

  /// The table of that name, once it was gone on in; null where the file has none.
  TomlTable* opened(std::string_view name) {
    const auto found = tables_.find(name);
    return found == tables_.end() ? nullptr : &found->second;
  }
  /// Of all tables.
  void finish() {
    for (auto& [name, table] : tables_) table.finish();
    root_.finish();
  }

 private:
  /// Empty where the key is missing or not one of these words.
  std::string readWord(const char* key, std::span<const std::string> words) {
    std::string word;
    if (current_) current_->readWord(key, word, words);
    return word;
  }

  TomlTable& root_;
  TomlTable* current_;
  std::map<std::string, TomlTable, std::less<>> tables_;
};

/// Other files are told apart first: what is wrong with their keys would only confuse.
bool isSession(TomlTable& root) {
  if (root.table().contains("shape")) {
    root.report().fail({}, "this is a scene, not a session", kExample);
  } else if (!root.has("version") && !root.has("scene")) {
    root.report().fail({}, "this is no session", kExample);
  }
  return !root.report().error();
}

/// Whether the file's meaning is known.
bool readVersion(TomlTable& root) {
  int version = kVersion;
  root.require("version", "version = 1");
  root.read("version", version, kAnyVersion);
  if (version > kVersion) {
    root.fail("version", fmt::format("{} is of a later Lightvane; this one reads {}", version, kVersion));
  }
  return !root.report().error();
}

fs::path readScene(TomlTable& root, const fs::path& where) {
  std::string scene;
  root.require("scene", "the scene's file, relative to this one");
  if (root.read("scene", scene) && scene.empty()) root.fail("scene", "expected a file, found \"\"");
  return (where.parent_path() / scene).lexically_normal();
}

std::optional<Parameters> readParameters(TomlTable& root) {
  std::optional<TomlTable> table = root.subtable("render");
  if (!table) return std::nullopt;
  Expected<Parameters> parameters = resolveParameters(readSettings(*table), {});
  if (parameters) return *parameters;
  root.report().fail(parameters.error());
  return std::nullopt;
}

std::vector<SessionLight> readLights(TomlTable& root) {
  std::vector<SessionLight> lights;
  std::set<std::pair<std::string, int>> seen;
  for (TomlTable& table : root.subtables("light", "write [[light]]")) {
    SessionLight& light = lights.emplace_back();
    table.require("name", "the light's name");
    table.read("name", light.name);
    table.read("number", light.number, kLightNumber);
    FieldReader reader(table);
    visitLight(light.setting, reader);
    reader.finish();
    if (!seen.emplace(light.name, light.number).second) {
      table.fail("name", fmt::format("there is a [[light]] \"{}\" already", light.name),
                 "lights of one name are told apart by number = 1, 2, ...");
    }
  }
  return lights;
}

void checkScale(FieldReader& reader, const ScaleOverride& scale) {
  TomlTable* table = reader.opened("display.scale");
  if (!table || !scale.fixedRange || scale.low <= scale.high) return;
  table->fail(table->has("low") ? "low" : "high",
              fmt::format("expected low up to high, found {} to {}", scale.low, scale.high));
}

SessionFile readSession(TomlTable& root, const fs::path& where, const WindowSettings& usual) {
  SessionFile session;
  applySettings(usual, session.display);
  if (!isSession(root) || !readVersion(root)) return session;
  session.scene = readScene(root, where);
  if (std::optional<TomlTable> camera = root.subtable("camera", "a session has one camera")) {
    session.camera = readCamera(*camera);
  }
  session.parameters = readParameters(root);
  session.lights = readLights(root);
  FieldReader reader(root);
  visitWork(session.cacheLocked, session.threads, session.memoryLimitMegabytes, reader);
  visitDisplay(session.display, session.brightness, reader);
  reader.finish();
  checkScale(reader, session.display.scale);
  return session;
}

// ---- the window's state

/// The lights that are not as the scene has them.
std::vector<SessionLight> changedLights(const std::vector<LightSetting>& settings,
                                        const std::vector<std::string>& names) {
  std::vector<SessionLight> lights;
  std::map<std::string, int> counts;
  for (std::size_t i = 0; i < std::min(settings.size(), names.size()); ++i) {
    const int number = ++counts[names[i]];
    if (settings[i] != LightSetting{}) lights.push_back({names[i], number, settings[i]});
  }
  return lights;
}

/// The index of a session's light; nothing where the scene has none of that name and number.
std::optional<std::size_t> lightIndex(const SessionLight& light, const std::vector<std::string>& names) {
  int number = 0;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == light.name && ++number == light.number) return i;
  }
  return std::nullopt;
}

std::vector<LightSetting> restoredLights(const SessionFile& session, const Document& document,
                                         std::vector<std::string>& warnings) {
  std::vector<LightSetting> settings(document.scene->lights.size());
  for (const SessionLight& light : session.lights) {
    if (const auto index = lightIndex(light, document.scene->lightNames)) {
      settings[*index] = light.setting;
      continue;
    }
    const std::string number = light.number == 1 ? "" : fmt::format(", number {}", light.number);
    warnings.push_back(fmt::format("The session changes the light \"{}\"{}, which {} does not have.",
                                   light.name, number, document.path.filename().string()));
  }
  return settings;
}

CameraDescription restoredCamera(const SessionFile& session, const Document& document,
                                 std::vector<std::string>& warnings) {
  const CameraDescription& own = document.description.cameras.front();
  if (!session.camera) return own;
  const auto compiled = compileCamera(document.scene->normalisation, *session.camera, "The session's camera");
  if (compiled) return *session.camera;
  warnings.push_back(compiled.error().message() + ". The scene's own is used.");
  return own;
}

}  // namespace

std::string sessionText(const SessionFile& session, const fs::path& where) {
  std::string text = "# What was looked at in Lightvane, and how. Whatever is left out has its default.\n";
  text += tomlLine("version", std::to_string(kVersion));
  text += tomlLine("scene", tomlString(writtenScene(session.scene, where)));
  FieldWriter writer(text);
  visitWork(session.cacheLocked, session.threads, session.memoryLimitMegabytes, writer);
  if (session.camera) text += "\n" + cameraToml(*session.camera);
  if (session.parameters) text += "\n" + renderToml(*session.parameters);
  for (const SessionLight& light : session.lights) text += lightToml(light);
  visitDisplay(session.display, session.brightness, writer);
  return text;
}

Expected<SessionFile> parseSession(std::string_view text, const fs::path& where,
                                   const WindowSettings& usual) {
  SessionFile session;
  const auto done =
      readToml(text, where, [&](TomlTable& root) { session = readSession(root, where, usual); });
  if (!done) return tl::unexpected(done.error());
  return session;
}

Expected<void> saveSession(const SessionFile& session, const fs::path& where) {
  const std::string text = sessionText(session, where);
  if (const auto again = parseSession(text, where); !again) {
    return makeError(where.string(), "not written, as it could not be read: " + again.error().what);
  }
  return writeFileAtomically(where, text);
}

Expected<SessionFile> loadSession(const fs::path& where, const WindowSettings& usual) {
  const auto text = readFile(where);
  if (!text) return tl::unexpected(text.error());
  return parseSession(*text, where, usual);
}

std::string windowSettingsText(const WindowSettings& settings) {
  std::string text =
      "# What Lightvane's window keeps from start to start, and writes when it changes. Whatever is left out "
      "has its default.\n";
  text += tomlLine("version", std::to_string(kVersion));
  FieldWriter writer(text);
  visitSettings(settings, writer);
  return text;
}

ReadSettings parseWindowSettings(std::string_view text, const fs::path& where) {
  ReadSettings read;
  const auto done = readToml(text, where, [&](TomlTable& root) {
    if (!readVersion(root)) return;
    FieldReader reader(root);
    visitSettings(read.settings, reader);
    reader.finish();
  });
  if (!done) read.error = done.error();
  return read;
}

SessionFile sessionOf(const Workspace& workspace, const Document& document) {
  // The selection is of pixels and vectors of a picture that is not saved.
  [[maybe_unused]] const auto& [setup, display, selection] = workspace;
  // Nor are vectors, and what was done to them.
  [[maybe_unused]] const auto& [parameters, brightness, camera, lights, indirectFactors, cacheLocked, threads,
                                memoryLimit, recordState] = setup;
  return {document.path,     camera,  parameters,  changedLights(lights, document.scene->lightNames),
          cacheLocked,       threads, memoryLimit, brightness,
          savedPart(display)};
}

RestoredSession applySession(const SessionFile& session, const Document& document, const Display& current) {
  RestoredSession restored;
  auto& [setup, display, selection] = restored.workspace;
  setup.parameters = session.parameters.value_or(document.start);
  setup.camera = restoredCamera(session, document, restored.warnings);
  setup.lights = restoredLights(session, document, restored.warnings);
  setup.brightness = session.brightness;
  setup.cacheLocked = session.cacheLocked;
  setup.threads = session.threads;
  setup.memoryLimitMegabytes = session.memoryLimitMegabytes;
  display = savedPart(session.display);
  display.fullScreen = current.fullScreen;
  return restored;
}

}  // namespace lightvane
