#include "app/run.h"

#include <cstdlib>
#include <exception>
#include <filesystem>
#include <new>

#include <fmt/format.h>

#include "app/command_line.h"
#include "app/command_load.h"
#include "app/compare_command.h"
#include "app/messages.h"
#include "app/paper_command.h"
#include "app/parameters_command.h"
#include "app/preview_window.h"
#include "app/render_command.h"
#include "app/scene_report.h"
#include "app/session_file.h"
#include "app/settings.h"
#include "app/shipped_files.h"
#include "app/stop.h"
#include "app/study_command.h"
#include "app/sweep_command.h"
#include "app/version.h"
#include "core/base/check.h"
#include "core/base/file.h"
#include "core/base/text.h"
#include "core/scene/load_scene.h"
#include "core/scene/write_scene.h"

namespace lightvane {
namespace {

namespace fs = std::filesystem;

constexpr const char* kDefaultScene = "assets/scenes/cornell-mirror.toml";

Expected<ExitCode> answer(const std::string& text) {
  return printAnswer(text).map([] { return ExitCode::Success; });
}

Expected<ExitCode> run(const RenderArguments& arguments) { return renderPicture(arguments); }

/// The scene as a scene file, which was read again to be sure. Throws LoadStopped as `watch` says.
Expected<std::string> checkedToml(const SceneDescription& scene, LoadWatch& watch) {
  for (const std::string& warning : scene.warnings) printWarning(warning);
  const Expected<std::string> text = sceneToml(scene);
  if (!text) return tl::unexpected(text.error());
  const auto again = parseSceneToml(*text, scene.path, watch);
  if (!again) return makeError(scene.path.string(), "cannot be written as TOML: " + again.error().message());
  if (sceneHash(*again, HashScope::Picture, watch) != sceneHash(scene, HashScope::Picture, watch))
    return makeError(scene.path.string(), "cannot be written as TOML: that would be another scene");
  return *text;
}

/// Throws LoadStopped as `watch` says.
Expected<std::string> describeScene(const SceneArguments& arguments, LoadWatch& watch) {
  const auto description = loadScene(arguments.scene, watch);
  if (!description) return tl::unexpected(description.error());
  if (arguments.asToml) return checkedToml(*description, watch);
  const auto parameters = resolveParameters(description->render, {});
  if (!parameters) return tl::unexpected(parameters.error());
  const auto scene = Scene::compile(*description, energyRuleFor(*parameters), watch);
  if (!scene) return tl::unexpected(scene.error());
  const SceneReport report = reportScene(*description, *scene, *parameters, watch);
  return arguments.json ? sceneReportJson(report) : withoutCommands(sceneReportText(report));
}

Expected<ExitCode> run(const SceneArguments& arguments) {
  const auto text = untilStopped([&] {
    CommandLoad loading(stopOnSignals(), false);
    return describeScene(arguments, loading.watch());
  });
  if (!text) return endWithoutScene(text.error(), false);
  return answer(*text);
}

Expected<ExitCode> run(const ParametersArguments& arguments) {
  const auto text = describeParameterList(arguments);
  if (!text) return tl::unexpected(text.error());
  return answer(*text);
}

Expected<ExitCode> run(const PaperArguments& arguments) { return renderPaper(arguments); }
Expected<ExitCode> run(const CompareArguments& arguments) { return comparePictures(arguments); }
Expected<ExitCode> run(const SweepArguments& arguments) { return runSweep(arguments); }
Expected<ExitCode> run(const StudyArguments& arguments) { return runStudy(arguments); }

/// The scene to show when none is named.
Expected<fs::path> defaultScene() {
  if (const auto scene = shippedFile(kDefaultScene)) return *scene;
  return makeError("", "which scene? no scene file is given", "lightvane --help tells what there is");
}

/// Whether there is a desktop to open a window on.
bool hasDisplay() {
  const auto isSet = [](const char* name) {
    const char* value = std::getenv(name);
    return value != nullptr && *value != '\0';
  };
  return isSet("DISPLAY") || isSet("WAYLAND_DISPLAY");
}

Expected<ExitCode> run(const OpenArguments& arguments) {
  const auto scene = arguments.file ? Expected<fs::path>(*arguments.file) : defaultScene();
  if (!scene) return tl::unexpected(scene.error());
  if (hasDisplay()) return runPreviewWindow(*scene);
  if (fileEnding(*scene) == kSessionEnding) {
    return makeError(scene->string(), "there is no display for the window that a session is of",
                     "set DISPLAY, or render its scene by the command that the window copies");
  }
  // Without a display there is a picture all the same.
  RenderArguments render;
  render.scene = *scene;
  render.outputs = {fs::path(scene->stem()).concat(".png")};
  printNote(fmt::format("there is no display for the window: rendering {} to {}", scene->string(),
                        render.outputs.front().string()));
  return renderPicture(render);
}

Expected<ExitCode> run(const TextAnswer& arguments) { return answer(arguments.text); }

}  // namespace

ExitCode runCommandLine(std::span<const std::string> words) {
  try {
    const auto commandLine = parseCommandLine(words);
    if (!commandLine) {
      printError(commandLine.error().message());
      return ExitCode::BadInput;
    }
    const auto ended = std::visit([](const auto& command) { return run(command); }, *commandLine);
    if (!ended) printError(ended.error().message());
    return ended.value_or(ExitCode::BadInput);
  } catch (const std::bad_alloc&) {
    printError("this takes more memory than there is (a smaller --size or --crop takes less)");
    return ExitCode::BadInput;
  } catch (const InvariantViolation& broken) {
    printError(fmt::format("lightvane {} has a defect: {}. Please report it with the command and the scene.",
                           versionText(), broken.what()));
  } catch (const std::exception& unexpected) {
    printError(fmt::format("lightvane {} has a defect: {}. Please report it with the command and the scene.",
                           versionText(), unexpected.what()));
  }
  return ExitCode::InternalError;
}

}  // namespace lightvane
