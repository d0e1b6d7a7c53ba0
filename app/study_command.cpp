#include "app/study_command.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "app/command_load.h"
#include "app/output_files.h"
#include "app/progress.h"
#include "app/render_command.h"
#include "app/settings.h"
#include "app/shipped_files.h"
#include "app/stop.h"
#include "app/studies.h"
#include "app/sweep_work.h"
#include "app/text_table.h"
#include "core/base/check.h"
#include "core/image/image_file.h"
#include "core/measure/light_study.h"
#include "core/measure/picture_error.h"
#include "core/scene/light_facts.h"

namespace lightvane {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using Works = std::vector<std::unique_ptr<SweepWork>>;

/// What settings of the study are said to come from.
std::string optionOf(const StudyArguments& arguments) { return fmt::format("--study {}", arguments.study); }

std::string nameOf(const fs::path& scene) { return scene.stem().string(); }

Expected<std::vector<fs::path>> scenesOf(const StudyArguments& arguments) {
  std::vector<fs::path> scenes = arguments.scenes;
  if (scenes.empty()) scenes = shippedScenes();
  if (scenes.empty()) {
    return makeError("assets/scenes", "is not there: the shipped scenes belong to the source tree",
                     "name scenes, or use the program in the folder where it was built");
  }
  std::set<std::string> names;
  for (const fs::path& scene : scenes) {
    if (!names.insert(nameOf(scene)).second)
      return makeError(scene.string(),
                       fmt::format("another scene of the study is called {}, too", nameOf(scene)));
  }
  return scenes;
}

fs::path referenceOf(const SweepArguments& work, int half) {
  return half == 0 ? work.reference : work.secondReference.value_or(work.reference);
}

/// Whether the picture is there as a whole: a rendering that was stopped leaves what it has, and says so.
bool isWholePicture(const fs::path& file) {
  std::error_code error;
  if (!fs::exists(file, error)) return false;
  const auto image = readImage(file);
  if (!image) return true;  // what is wrong with it is told where it is used
  const auto complete = image->metadata.find("complete");
  return complete == image->metadata.end() || complete->second == "true";
}

/// False where it was stopped.
Expected<bool> traceHalf(const StudyArguments& study, const SweepArguments& of, int half,
                         const StopFlag& stop) {
  const fs::path file = referenceOf(of, half);
  if (isWholePicture(file)) return true;
  if (stop) return false;
  if (!of.view.quiet)
    printNote(fmt::format("{}: half {} of the reference, {} paths a pixel", nameOf(of.view.scene), half + 1,
                          study.referencePaths));
  RenderArguments reference = of.view;
  reference.timeLimitSeconds.reset();  // that of the whole study
  reference.outputs = {file};
  std::vector<RenderSetting>& settings = reference.settings.settings;
  std::erase_if(settings, [](const RenderSetting& setting) { return setting.key == "seed"; });
  const std::string where = optionOf(study);
  settings.push_back({"method.name", "path", where});
  settings.push_back({"path.samples", std::to_string(study.referencePaths), "--spp"});
  settings.push_back({"seed", std::to_string(kReferenceSeed + static_cast<std::uint64_t>(half)), where});
  std::error_code error;
  reference.resume = fs::exists(file.string() + ".resume", error);
  reference.quiet = progressStyle(of.view.quiet) != ProgressStyle::Terminal;
  const auto done = renderPicture(reference);
  if (!done) return tl::unexpected(done.error());
  return !stop;
}

/// Of a half of the reference of one light. Errors are those of --spp: all else was planned before.
Expected<Parameters> sampledReference(const StudyArguments& study, const SweepWork& work, int half) {
  auto parameters =
      work.parametersOf("vectors", LightStudyPoint{DlvMode::Never, study.referencePaths}.settings(), "--spp");
  if (parameters) parameters->picture.seed = kReferenceSeed + static_cast<std::uint64_t>(half);
  return parameters;
}

/// Sampled direct light, of which rendering on is not worth a file: it takes seconds. False where it was
/// stopped.
Expected<bool> sampleHalf(const StudyArguments& study, SweepWork& work, int half) {
  const SweepArguments& of = work.arguments();
  const fs::path file = referenceOf(of, half);
  if (isWholePicture(file)) return true;
  const auto parameters = sampledReference(study, work, half);
  if (!parameters) return tl::unexpected(parameters.error());
  if (!of.view.quiet)
    printNote(fmt::format("half {} of {}, {} shadow rays a point", half + 1, of.reference.string(),
                          study.referencePaths));
  return work.writeReference(*parameters, file);
}

/// Where the works of a study find and put things.
struct StudyFolders {
  fs::path runs, references;

  explicit StudyFolders(const SweepArguments& arguments)
      : runs(arguments.folder),
        references(arguments.reference.empty() ? arguments.folder / "references" : arguments.reference) {}

  /// Of what is called so below them: "cornell", "yard/sun".
  void place(SweepArguments& work, const std::string& below, const std::string& reference) const {
    work.folder = runs / below;
    work.reference = references / (reference + ".exr");
    work.secondReference = references / (reference + "-2.exr");
  }
};

/// Adds the works of a scene that is loaded, each of its lights by itself after the scene without any.
Expected<void> addLights(const SweepWork& whole, const StudyFolders& folders, LoadWatch& watch,
                         Works& works) {
  // More would tell of one scene, and not of lights.
  constexpr std::size_t kMostStudied = 8;
  const Scene& scene = whole.scene();
  const std::string name = nameOf(whole.arguments().view.scene);
  const std::vector<std::uint32_t> studied = strongestLights(scene, kMostStudied);
  if (studied.size() < scene.lights.size() && !whole.arguments().view.quiet) {
    printNote(fmt::format("{}: {} of {} lights are left out, those with the least power", name,
                          scene.lights.size() - studied.size(), scene.lights.size()));
  }
  const auto add = [&](std::optional<std::uint32_t> light, const std::string& below) -> Expected<void> {
    SweepArguments one = whole.arguments();
    folders.place(one, name + "/" + below, name + "-" + below);
    auto work = whole.litOnlyBy(light, std::move(one), watch);
    if (!work) return tl::unexpected(work.error());
    works.push_back(*std::move(work));
    return {};
  };
  if (auto added = add({}, "no-light"); !added) return added;
  // By their numbers, as two may have one name.
  for (const std::uint32_t light : studied) {
    auto added = add(light, fmt::format("{}-{}", light + 1, plainFileName(scene.lightNames[light])));
    if (!added) return added;
  }
  return {};
}

Expected<void> addStudiedScene(const StudyArguments& arguments, const Study& study, const fs::path& scene,
                               const std::shared_ptr<TaskPool>& pool, const StopFlag& stop, Works& works) {
  const StudyFolders folders(arguments.sweep);
  SweepArguments one = arguments.sweep;
  one.view.scene = scene;
  folders.place(one, nameOf(scene), nameOf(scene));
  auto work = std::make_unique<SweepWork>(std::move(one), stop, pool);
  CommandLoad loading(stop, arguments.sweep.view.quiet);
  if (auto loaded = work->load(loading.watch(), true); !loaded) return loaded;
  if (study.lighting == StudyLighting::EachLight) return addLights(*work, folders, loading.watch(), works);
  works.push_back(std::move(work));
  return {};
}

/// Loads and plans all scenes before the first ray: what is wrong is found at once.
Expected<Works> prepareStudy(const StudyArguments& arguments, const Study& study, const StopFlag& stop) {
  const auto scenes = scenesOf(arguments);
  if (!scenes) return tl::unexpected(scenes.error());
  const auto pool = std::make_shared<TaskPool>(arguments.sweep.view.threads);
  Works works;
  for (const fs::path& scene : *scenes) {
    if (auto added = addStudiedScene(arguments, study, scene, pool, stop, works); !added)
      return tl::unexpected(added.error());
  }
  for (const std::unique_ptr<SweepWork>& work : works) {
    if (auto planned = study.plan(*work); !planned) return tl::unexpected(planned.error());
    if (study.lighting != StudyLighting::EachLight) continue;
    if (auto reference = sampledReference(arguments, *work, 0); !reference)
      return tl::unexpected(reference.error());
  }
  for (const fs::path& folder : {arguments.sweep.folder, StudyFolders(arguments.sweep).references}) {
    if (auto made = makeFolder(folder); !made) return tl::unexpected(made.error());
  }
  return works;
}

/// False where it was stopped.
Expected<bool> beginStudy(const StudyArguments& arguments, const Study& study, const Works& works,
                          const StopFlag& stop) {
  for (const std::unique_ptr<SweepWork>& work : works) {
    for (int half = 0; half < 2; ++half) {
      auto made = study.lighting == StudyLighting::EachLight
                      ? sampleHalf(arguments, *work, half)
                      : traceHalf(arguments, work->arguments(), half, stop);
      if (!made || !*made) return made;
    }
    const auto begun = untilStopped([&] {
      CommandLoad loading(stop, arguments.sweep.view.quiet);
      return work->begin(loading.watch());
    });
    if (!begun && begun.error().isStop) return false;
    if (!begun) return tl::unexpected(begun.error());
  }
  return true;
}

/// What is done of a work.
StudiedScene studied(const SweepWork& work, const Study& study) {
  StudiedScene scene{nameOf(work.arguments().view.scene), work.collected()};
  if (study.lighting != StudyLighting::EachLight) return scene;
  scene.light.emplace();
  if (!work.scene().lights.empty())
    scene.light = {work.scene().lightNames.front(), lightKind(work.scene().lights.front())};
  return scene;
}

/// Seed by seed over all scenes: one that is stopped has compared all of them once before it looks again.
Expected<bool> renderStudy(const StudyArguments& arguments, const Works& works) {
  std::vector<const SweepWork*> all;
  for (const std::unique_ptr<SweepWork>& work : works) all.push_back(work.get());
  SweepProgress progress;
  for (int seed = 0; seed < arguments.sweep.seeds; ++seed) {
    for (const std::unique_ptr<SweepWork>& work : works) {
      auto done = work->runSeed(seed, all, progress);
      if (!done || !*done) return done;
    }
  }
  return true;
}

std::string studyText(const std::vector<StudyTable>& tables) {
  std::string text;
  for (const StudyTable& table : tables)
    text += fmt::format("{}{}\n{}\n\n{}", text.empty() ? "" : "\n", table.title, table.text,
                        alignedTable(table.rows));
  return text;
}

}  // namespace

Expected<ExitCode> runStudy(const StudyArguments& arguments) {
  const Study* study = findStudy(arguments.study);
  LV_CHECK(study != nullptr, "study {}", arguments.study);
  const StopFlag& stop = stopOnSignals();
  const bool isQuiet = arguments.sweep.view.quiet;
  const auto works = untilStopped([&] { return prepareStudy(arguments, *study, stop); });
  if (!works) return endWithoutScene(works.error(), isQuiet);
  std::optional<TimeLimit> limit;
  limitTime(limit, Clock::now(), arguments.sweep.view.timeLimitSeconds);
  auto done = beginStudy(arguments, *study, *works, stop);
  if (done && *done) done = renderStudy(arguments, *works);
  // What is finished is shown, whatever ended the work.
  std::vector<StudiedScene> scenes;
  std::size_t runs = 0;
  for (const std::unique_ptr<SweepWork>& work : *works) {
    const StudiedScene& scene = scenes.emplace_back(studied(*work, *study));
    if (auto written = work->writeReport(scene.sweep); !written) return tl::unexpected(written.error());
    for (const SweepPoint& point : scene.sweep.points) runs += point.runs.size();
  }
  if (!done) return tl::unexpected(done.error());
  if (runs > 0) {
    const std::vector<StudyTable> tables = study->tables(scenes);
    const std::string text = arguments.markdown ? studyMarkdown(tables) : studyText(tables);
    if (auto printed = printAnswer(text); !printed) return tl::unexpected(printed.error());
  }
  if (!isQuiet) {
    printNote(fmt::format("{}{} rendering{} in {}: open index.html in a scene's folder there",
                          *done ? "" : "stopped: ", runs, runs == 1 ? "" : "s",
                          arguments.sweep.folder.string()));
    if (!*done) printNote("the same command goes on from here");
  }
  return stopSignalled() && !*done ? ExitCode::Stopped : ExitCode::Success;
}

}  // namespace lightvane
