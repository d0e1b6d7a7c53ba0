#include "app/command_line.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/session_file.h"
#include "app/studies.h"
#include "app/version.h"
#include "core/base/file.h"
#include "core/base/parameter.h"
#include "core/base/tasks.h"
#include "core/base/text.h"
#include "core/image/image_file.h"
#include "core/measure/metric.h"
#include "core/measure/picture_error.h"
#include "core/scene/supported.h"

namespace lightvane {
namespace {

// As scene files: core/scene/load_toml.cpp.
constexpr int kLargestSide = 65536;

constexpr const char* kDescription =
    "Lightvane renders scenes with light vectors: global illumination, computed at few points and "
    "interpolated "
    "between them.";

constexpr const char* kExamples =
    "Examples:\n"
    "  lightvane render room.toml -o room.exr             a picture with all its layers\n"
    "  lightvane render room.toml -o room.png --preset draft --size 320x240\n"
    "  lightvane scene room.toml                          what is in a scene, what it needs\n"
    "  lightvane parameters ilv                           the parameters of Indirect Light Vectors\n"
    "  lightvane paper --scale 0.25                       the paper's figures, and its numbers beside ours\n"
    "  lightvane reference room.toml -o truth.exr         a path traced picture to hold others against\n"
    "  lightvane compare room.exr truth.exr               how far a picture is from another\n"
    "  lightvane sweep room.toml --vary ilv.rows=6:48:4 --reference truth.exr -o trade\n"
    "                                                     what a parameter costs and brings\n"
    "  lightvane room.toml                                the previewer (without a display: room.png, here)\n"
    "\n"
    "lightvane COMMAND --help tells more. Exit codes: 0 done; 1 a defect of ours; 2 bad input; 130 stopped "
    "by "
    "Ctrl+C.\n";

constexpr const char* kRenderExamples =
    "Parameters, from weak to strong: defaults, method.rules, the preset, the scene's [render], the command "
    "line.\n"
    "Ctrl+C stops and writes the last whole pass; --resume goes on from there. A second Ctrl+C exits at "
    "once.\n"
    "\n"
    "Examples:\n"
    "  lightvane render room.toml -o room.exr room.png\n"
    "  lightvane render room.toml -o truth.exr --method path --spp 1024 --time-limit 10m\n"
    "  lightvane render room.toml -o truth.exr --method path --spp 1024 --resume\n"
    "  lightvane render room.toml -o paper.exr --set method.rules=paper --set ilv.n_min=3 --seed 4\n"
    "  lightvane render room.toml -o where.png --view where-computed\n"
    "  lightvane render room.toml -o left.exr --camera left --size 1024x768 --crop 100,80,256,256\n"
    "  lightvane render room.toml -o a.exr --save-cache room.lvcache --stats a.json\n"
    "  lightvane render room.toml -o b.exr --cache room.lvcache --lock-cache --camera right\n";

constexpr const char* kSceneExamples =
    "Examples:\n"
    "  lightvane scene room.toml\n"
    "  lightvane scene room.toml --json | jq .lights\n"
    "  lightvane scene room.obj --as-toml > room.toml      to add lights and cameras\n";

constexpr const char* kParametersExamples =
    "Examples:\n"
    "  lightvane parameters                    all of them\n"
    "  lightvane parameters ilv.n_min dlv      one, and a group\n"
    "  lightvane parameters --markdown > docs/parameters.md\n";

constexpr const char* kPaperExamples =
    "The table is printed as Markdown, figure by figure. At full size all takes an hour or more of CPU time, "
    "most of it for the naive method and the reference.\n"
    "\n"
    "Examples:\n"
    "  lightvane paper                                    all pictures, in the folder paper\n"
    "  lightvane paper --scale 0.25                       the same, small and quick\n"
    "  lightvane paper --figure 4 --reference 4096 -o fig4 > fig4.md\n";

constexpr const char* kReferenceExamples =
    "The noise is the error that a perfect picture would have against this one: the root of the mean squared "
    "relative difference, as `lightvane compare --metric relative` tells it. It is estimated from the paths' "
    "scatter, and falls with the root of their number.\n"
    "FILE.resume keeps what was traced, after Ctrl+C and at the end: the same command goes on from there, "
    "with a smaller --target too.\n"
    "\n"
    "Examples:\n"
    "  lightvane reference room.toml -o truth.exr --target 0.5%\n"
    "  lightvane reference room.toml -o truth.exr --target 0.2% --time-limit 8h\n"
    "  lightvane reference room.toml -o truth.exr --size 256x256 --set film.samples=16\n";

constexpr const char* kSweepExamples =
    "Finished renderings are kept in FOLDER/runs.jsonl: the same command goes on from there after Ctrl+C, "
    "and a "
    "larger one takes over what they have in common. CPU times are of one machine with nothing else to do; "
    "--threads 1 makes them alike.\n"
    "\n"
    "Examples:\n"
    "  lightvane sweep room.toml --vary ilv.radius_scale=0.2:1:5 --vary ilv.n_min=2,4,8 --seeds 3 "
    "--reference truth.exr -o trade\n"
    "  lightvane sweep room.toml --vary ilv.rows=6:48:4 --vary dlv.mode=auto,always --around --reference "
    "truth.exr "
    "-o trade\n"
    "  lightvane sweep --study corrections --size 128x128 --seeds 2 --threads 1 --markdown -o study > "
    "study.md\n";

constexpr const char* kCompareExamples =
    "Layers are those that render writes to .exr files: beauty, emission, direct, indirect, specular, "
    "albedo. "
    "The noise of a path traced reference, which its .exr has, is taken off or stated.\n"
    "\n"
    "Examples:\n"
    "  lightvane compare room.exr truth.exr\n"
    "  lightvane compare room.exr truth.exr --metric relmse --metric worst-tile --layer indirect\n"
    "  lightvane compare room.exr truth.exr --without edges,lights --json\n"
    "  lightvane compare room.png truth.png --metric flip --map where.png\n";

/// What CLI11 fills in; strings, so that errors about values are ours.
struct RawWords {
  std::string scene;
  std::vector<std::string> scenes;
  std::vector<std::string> outputs;
  std::string method, preset, seed, samples, camera, size, crop, threads, passes, timeLimit, targetError;
  std::string from, at, up, fov, orthographic, lensRadius, focusDistance;
  std::string view, source, exposure, toneMap, colorMap, range, reference;
  std::string explainSamples, explainStride;
  std::vector<std::string> sets, lights, indirectLights;
  std::string stats, saveCache, cache;
  std::string folder, scale;
  std::vector<std::string> figures;
  std::string pictureFile, referenceFile, map;
  std::vector<std::string> varied, rivals;
  std::string random, seeds, study, referencePaths;
  bool around = false;
  std::vector<std::string> metrics, layers, without;
  std::string target;
  bool explain = false;
  bool resume = false, restart = false, quiet = false, lockCache = false;
  bool json = false, asToml = false, markdown = false;
  std::vector<std::string> keys;
};

std::vector<std::string> viewNames() {
  std::vector<std::string> names;
  for (const PictureViewInfo& info : pictureViews()) names.emplace_back(info.name);
  return names;
}

/// The options of `render` and `reference`: which files.
void addFiles(CLI::App* render, RawWords& raw) {
  render
      ->add_option("-o,--output", raw.outputs,
                   "Picture files to write, each by its extension: " + listWords(imageExtensions()))
      ->type_name("FILE")
      ->group("Picture");
  render->add_option("--stats", raw.stats, "Writes times and counts as JSON")
      ->type_name("FILE")
      ->group("Output");
}

void addSceneFile(CLI::App* render, RawWords& raw) {
  render->add_option("SCENE", raw.scene, "Scene file: .toml, .obj, .ply, .gltf or .glb")->type_name("");
}

/// Of all that render: what is seen, from where.
void addPicture(CLI::App* render, RawWords& raw) {
  render->add_option("--camera", raw.camera, "The camera of this name; the scene's first otherwise")
      ->type_name("NAME")
      ->group("Picture");
  render
      ->add_option("--from", raw.from,
                   "Where the camera is, in the scene's units, in place of its own position")
      ->type_name("X,Y,Z")
      ->group("Picture");
  render->add_option("--at", raw.at, "What it looks at, likewise")->type_name("X,Y,Z")->group("Picture");
  render->add_option("--up", raw.up, "Which way is up, likewise")->type_name("X,Y,Z")->group("Picture");
  render->add_option("--fov-y", raw.fov, "Its vertical field of view, likewise; makes it perspective")
      ->type_name("DEGREES")
      ->group("Picture");
  render
      ->add_option("--orthographic", raw.orthographic,
                   "Makes it orthographic, without a lens; the height of what it shows")
      ->type_name("LENGTH")
      ->group("Picture");
  render
      ->add_option("--lens-radius", raw.lensRadius,
                   "The radius of its lens, likewise; 0 makes all sharp. Smooth with many film.samples")
      ->type_name("LENGTH")
      ->group("Picture");
  render->add_option("--focus-distance", raw.focusDistance, "How far away that lens is sharp, likewise")
      ->type_name("LENGTH")
      ->group("Picture");
  render
      ->add_option(
          "--light", raw.lights,
          "Multiplies a light's radiance by a number, or by one each for red, green and blue; repeatable")
      ->type_name("NAME=FACTOR")
      ->allow_extra_args(false)
      ->group("Picture");
  render
      ->add_option("--indirect-light", raw.indirectLights,
                   "The same for reflected light alone, where that is of other settings; repeatable")
      ->type_name("NAME=FACTOR")
      ->allow_extra_args(false)
      ->group("Picture");
  render->add_option("--size", raw.size, "Pixels of the full picture; the camera's otherwise")
      ->type_name("WxH")
      ->group("Picture");
  render->add_option("--crop", raw.crop, "Only this rectangle of it, in pixels from the top left")
      ->type_name("X,Y,W,H")
      ->group("Picture");
}

/// Likewise: of how the work is done.
void addWork(CLI::App* render, RawWords& raw) {
  render
      ->add_option("--set", raw.sets,
                   "Any parameter by its key, as `lightvane parameters` lists them; repeatable")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false)
      ->group("Method");
  render->add_option("--seed", raw.seed, "Names the random numbers: same seed, same picture")
      ->type_name("N")
      ->group("Method");
  render
      ->add_option("--threads", raw.threads,
                   "Threads; as many as the machine has cores otherwise. Changes no pixel")
      ->type_name("N")
      ->group("Work");
  render
      ->add_option("--time-limit", raw.timeLimit,
                   "Stops after so long (90, 90s, 2m, 1h) at the last whole pass, but not before the first")
      ->type_name("SECONDS")
      ->group("Work");
  render->add_flag("-q,--quiet", raw.quiet, "Says nothing but errors and warnings")->group("Output");
}

CLI::App* addRender(CLI::App& app, RawWords& raw) {
  CLI::App* render = app.add_subcommand("render", "Renders a scene to picture files");
  addFiles(render, raw);
  addSceneFile(render, raw);
  addPicture(render, raw);
  render->add_option("--method", raw.method, "How light is computed: " + listWords(choiceNames(kMethodNames)))
      ->type_name("NAME")
      ->group("Method");
  render->add_option("--preset", raw.preset, "From fast to accurate: " + listWords(choiceNames(kPresetNames)))
      ->type_name("NAME")
      ->group("Method");
  render
      ->add_option("--spp", raw.samples,
                   "Samples per pixel: path.samples for the method path, film.samples for others")
      ->type_name("N")
      ->group("Method");
  render
      ->add_option("--target-error", raw.targetError,
                   "Computes more light vectors where these say that their light is farther off than so much "
                   "of the picture's, until it is not, or for as long as that helps")
      ->type_name("PERCENT")
      ->group("Work");
  render->add_option("--passes", raw.passes, "Stops after so many passes")->type_name("N")->group("Work");
  render->add_flag("--resume", raw.resume, "Goes on where the same rendering was stopped (FILE.resume)")
      ->group("Work");

  constexpr const char* kError = "Where the error comes from";
  render
      ->add_flag(
          "--explain", raw.explain,
          "Computes the complete picture's pixels in full, and tells how much of its error is noise, leaks, "
          "interpolation, a lobe's single direction, missing bounces; an .exr has them as layers")
      ->group(kError);
  render
      ->add_option("--explain-samples", raw.explainSamples,
                   "Samples of each pixel's full computation; 256 otherwise")
      ->type_name("N")
      ->group(kError);
  render
      ->add_option("--explain-stride", raw.explainStride,
                   "One pixel in each square so wide, for a quick answer; 1 otherwise: all")
      ->type_name("N")
      ->group(kError);

  render->add_option("--cache", raw.cache, "Begins with the light vectors of this file")
      ->type_name("FILE")
      ->group("Light vectors");
  render
      ->add_flag("--lock-cache", raw.lockCache, "Interpolates only: computes no vector that --cache has not")
      ->group("Light vectors");
  render
      ->add_option(
          "--save-cache", raw.saveCache,
          "Writes the light vectors to this file; as a point cloud for other programs where it ends in .ply")
      ->type_name("FILE")
      ->group("Light vectors");

  constexpr const char* kScreen = "What a .png shows";
  render->add_option("--view", raw.view, "What of the picture is shown: " + listWords(viewNames()))
      ->type_name("NAME")
      ->group(kScreen);
  render
      ->add_option("--source", raw.source,
                   "What of the error the view `error-sources` shows, in place of which is the largest: " +
                       listWords(choiceNames(kErrorSourceNames)))
      ->type_name("NAME")
      ->group(kScreen);
  render->add_option("--exposure", raw.exposure, "Brightens by so many stops, beside the camera's own")
      ->type_name("STOPS")
      ->group(kScreen);
  render
      ->add_option("--tone-map", raw.toneMap,
                   "How what is too bright is shown: " + listWords(choiceNames(kToneMapWords)))
      ->type_name("NAME")
      ->group(kScreen);
  render
      ->add_option("--color-map", raw.colorMap,
                   "Colours of views of one number: " + listWords(choiceNames(kColorMapWords)))
      ->type_name("NAME")
      ->group(kScreen);
  render->add_option("--range", raw.range, "The numbers at the ends of that map, in the view's unit")
      ->type_name("LOW,HIGH")
      ->group(kScreen);
  render
      ->add_option("--reference", raw.reference,
                   "The picture that the view `error` compares with: .exr, .hdr or .pfm")
      ->type_name("FILE")
      ->group(kScreen);

  addWork(render, raw);
  render->footer(kRenderExamples);
  return render;
}

CLI::App* addReference(CLI::App& app, RawWords& raw) {
  CLI::App* reference =
      app.add_subcommand("reference", "Path traces a scene until the picture is as sure as asked");
  addFiles(reference, raw);
  addSceneFile(reference, raw);
  addPicture(reference, raw);
  reference
      ->add_option("--target", raw.target,
                   "Ends where the noise of the whole picture is no larger; 1% otherwise")
      ->type_name("PERCENT")
      ->group("Method");
  reference->add_option("--spp", raw.samples, "Ends after so many paths a pixel, whatever the noise")
      ->type_name("N")
      ->group("Method");
  reference->add_flag("--restart", raw.restart, "Begins anew, and does not go on from FILE.resume")
      ->group("Work");
  addWork(reference, raw);
  reference->footer(kReferenceExamples);
  return reference;
}

CLI::App* addScene(CLI::App& app, RawWords& raw) {
  CLI::App* scene = app.add_subcommand("scene", "Tells what a scene has, needs and costs");
  addSceneFile(scene, raw);
  CLI::Option* json = scene->add_flag("--json", raw.json, "As JSON");
  scene
      ->add_flag(
          "--as-toml", raw.asToml,
          "Prints the scene itself, as a scene file for the same folder; of OBJ and PLY files with the "
          "camera and the light that were added")
      ->excludes(json);
  scene->footer(kSceneExamples);
  return scene;
}

CLI::App* addParameters(CLI::App& app, RawWords& raw) {
  CLI::App* parameters = app.add_subcommand("parameters", "Lists every parameter: default, range, meaning");
  parameters->add_option("KEY", raw.keys, "Parameters, or groups of them such as ilv; all otherwise")
      ->type_name("");
  parameters->add_flag("--markdown", raw.markdown, "As Markdown (docs/parameters.md)");
  parameters->footer(kParametersExamples);
  return parameters;
}

CLI::App* addPaper(CLI::App& app, RawWords& raw) {
  CLI::App* paper = app.add_subcommand(
      "paper", "Renders the paper's figures by each of its methods, and prints its numbers beside ours");
  paper->add_option("-o,--output", raw.folder, "Folder for the pictures; made where there is none; \"paper\"")
      ->type_name("FOLDER");
  paper->add_option("--figure", raw.figures, "Only this figure: 3, 4 or 5; repeatable")
      ->type_name("N")
      ->allow_extra_args(false);
  paper->add_option("--scale", raw.scale, "Of the pictures' width and height, the paper's being 1")
      ->type_name("FACTOR");
  paper
      ->add_option("--reference", raw.reference,
                   "Paths a pixel of the picture that errors are measured against, 256 otherwise; 0: none")
      ->type_name("N");
  paper->add_option("--threads", raw.threads, "Threads; as many as the machine has cores otherwise")
      ->type_name("N");
  paper->add_flag("-q,--quiet", raw.quiet, "Says nothing but the table, errors and warnings");
  paper->footer(kPaperExamples);
  return paper;
}

/// "corrections (what each correction of the paper is worth)".
std::string studiesText() {
  std::vector<std::string> texts;
  for (const Study& study : studies()) texts.push_back(fmt::format("{} ({})", study.name, study.tells));
  return listWords(texts);
}

CLI::App* addSweep(CLI::App& app, RawWords& raw) {
  CLI::App* sweep =
      app.add_subcommand("sweep", "Measures what parameters cost and bring, over many renderings");
  sweep
      ->add_option("SCENE", raw.scenes,
                   "Scene file: .toml, .obj, .ply, .gltf or .glb; with --study several, or none for all that "
                   "ship")
      ->type_name("");
  sweep->add_option("--study", raw.study, "In place of --vary, over several scenes: " + studiesText())
      ->type_name("NAME")
      ->group("Points");
  sweep
      ->add_option("--vary", raw.varied,
                   "A parameter and its values, one by one or N from LOW to HIGH; repeatable")
      ->type_name("KEY=A,B,C | KEY=LOW:HIGH:N")
      ->allow_extra_args(false)
      ->group("Points");
  CLI::Option* around =
      sweep->add_flag("--around", raw.around, "One parameter at a time, not all combinations")
          ->group("Points");
  sweep->add_option("--random", raw.random, "Only so many of the combinations, drawn by --seed")
      ->type_name("N")
      ->excludes(around)
      ->group("Points");
  sweep
      ->add_option(
          "--seeds", raw.seeds,
          "Each point so many times, with one seed after another; otherwise 1, or what the study needs")
      ->type_name("N")
      ->group("Points");
  sweep
      ->add_option("--rivals", raw.rivals,
                   "Methods on the same axes: direct, path, naive (all, otherwise) or none")
      ->type_name("NAME,...")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->group("Points");
  sweep
      ->add_option("--reference", raw.reference,
                   "The picture that errors are measured against: .exr, .hdr or .pfm; of a study the folder "
                   "of its references, which are path traced where they are not there")
      ->type_name("FILE")
      ->group("Output");
  sweep
      ->add_option(
          "--spp", raw.referencePaths,
          "Paths a pixel, or of lights shadow rays a point, of each half of a study's references; 1024 "
          "otherwise")
      ->type_name("N")
      ->group("Output");
  sweep->add_flag("--markdown", raw.markdown, "Prints a study's tables as Markdown (docs/trade.md)")
      ->group("Output");
  sweep
      ->add_option("--without", raw.without,
                   "Leaves out pixels at edges of the geometry, or that see lights: edges, lights, or both")
      ->type_name("WHAT")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->group("Output");
  sweep->add_option("-o,--output", raw.folder, "Folder for the results; made where there is none")
      ->type_name("FOLDER")
      ->group("Output");
  addPicture(sweep, raw);
  sweep->add_option("--preset", raw.preset, "Of all points: " + listWords(choiceNames(kPresetNames)))
      ->type_name("NAME")
      ->group("Method");
  addWork(sweep, raw);
  sweep->footer(kSweepExamples);
  return sweep;
}

std::vector<std::string> metricNames() {
  std::vector<std::string> names;
  for (const MetricInfo& metric : metrics()) names.emplace_back(metric.name);
  return names;
}

CLI::App* addCompare(CLI::App& app, RawWords& raw) {
  CLI::App* compare = app.add_subcommand("compare", "Tells how far a picture is from another");
  compare->add_option("PICTURE", raw.pictureFile, "A picture: .exr, .hdr, .pfm, .png or .jpg")->type_name("");
  compare->add_option("REFERENCE", raw.referenceFile, "What it should be, of the same size")->type_name("");
  std::string listed;
  for (const MetricInfo& metric : metrics())
    listed += fmt::format("\n{}: {}", metric.name, metric.description);
  compare->add_option("--metric", raw.metrics, "Only this one; repeatable; all otherwise." + listed)
      ->type_name("NAME")
      ->allow_extra_args(false);
  compare
      ->add_option(
          "--layer", raw.layers,
          "Only this layer; repeatable. Otherwise beauty, and direct and indirect where both have them")
      ->type_name("NAME")
      ->allow_extra_args(false);
  compare
      ->add_option("--without", raw.without,
                   "Leaves out pixels at edges of the geometry, or that see lights: edges, lights, or both")
      ->type_name("WHAT")
      ->delimiter(',')
      ->allow_extra_args(false);
  compare->add_option("--map", raw.map, "Writes where the error of the one metric is, of the first layer")
      ->type_name("FILE");
  compare->add_option("--range", raw.range, "The map's numbers that are darkest and brightest")
      ->type_name("LOW,HIGH");
  compare->add_option("--color-map", raw.colorMap, "Of the map: " + listWords(choiceNames(kColorMapWords)))
      ->type_name("NAME");
  compare
      ->add_option("--exposure", raw.exposure,
                   "Stops of brightness of what a screen shows, for psnr, ssim, flip")
      ->type_name("STOPS");
  compare->add_flag("--json", raw.json, "As JSON");
  compare->add_flag("-q,--quiet", raw.quiet, "Says nothing but the answer, errors and warnings");
  compare->footer(kCompareExamples);
  return compare;
}

std::vector<std::string> optionNames(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    for (const std::string& name : option->get_snames()) names.push_back("-" + name);
  }
  return names;
}

/// The error of words that no option and no positional took.
Error unexpectedWord(const CLI::App& command, const std::vector<std::string>& left) {
  const auto option =
      std::find_if(left.begin(), left.end(), [](const std::string& word) { return word.starts_with('-'); });
  const std::string where = command.get_parent() == nullptr ? "" : command.get_name();
  if (option == left.end()) {
    return {where, fmt::format("unexpected word '{}'", left.front()),
            command.get_name() == "compare" ? "two pictures at a time" : "one SCENE at a time"};
  }
  const std::string name = option->substr(0, option->find('='));
  const std::string nearest = suggestion(name, optionNames(command));
  return {where, fmt::format("there is no option {}", name), nearest.empty() ? "--help lists them" : nearest};
}

bool isSceneName(const std::string& word) { return sceneFileKind(word) != SceneFileKind::Unknown; }

/// `-o` takes all words up to the next option, the scene's too where it comes last. No picture has a scene's
/// extension, so that it can be told.
void takeSceneFromOutputs(RawWords& raw) {
  if (!raw.scene.empty()) return;
  const auto found = std::find_if(raw.outputs.begin(), raw.outputs.end(), isSceneName);
  if (found == raw.outputs.end()) return;
  raw.scene = *found;
  raw.outputs.erase(found);
}

Expected<int> parseWhole(const std::string& text, const std::string& where, int most) {
  int value = 0;
  if (!parameter_text::parse(text, value).empty() || value < 1 || value > most) {
    return makeError(where, fmt::format("expected a whole number from 1 to {}, found '{}'", most, text));
  }
  return value;
}

Expected<int> parseThreads(const std::string& text, const std::string& where) {
  return parseWhole(text, where, kMostThreads);
}

/// As scene files: docs/scene-format.md.
Expected<double> parseAngle(const std::string& text, const std::string& where) {
  double degrees = 0.0;
  if (!parameter_text::parse(text, degrees).empty() || degrees < 0.001 || degrees > 179.999) {
    return makeError(where, fmt::format("expected degrees from 0.001 to 179.999, found '{}'", text));
  }
  return degrees;
}

/// As scene files, likewise: above 0.
Expected<double> parseLength(const std::string& text, const std::string& where) {
  double length = 0.0;
  if (!parameter_text::parse(text, length).empty() || !(length >= 1e-100 && length <= 1e100))
    return makeError(where, fmt::format("expected a length above 0, found '{}'", text));
  return length;
}

Expected<double> parseRadius(const std::string& text, const std::string& where) {
  double radius = 0.0;
  if (!parameter_text::parse(text, radius).empty() || !(radius >= 0.0 && radius <= 1e100))
    return makeError(where, fmt::format("expected a length, or 0 for a pinhole, found '{}'", text));
  return radius;
}

/// Numbers with commas between them; as many as `numbers` has, or false.
bool parseNumbers(std::string_view text, std::span<double> numbers) {
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const std::size_t end = i + 1 < numbers.size() ? text.find(',') : text.size();
    if (end == std::string_view::npos || !parameter_text::parse(text.substr(0, end), numbers[i]).empty())
      return false;
    text.remove_prefix(std::min(text.size(), end + 1));
  }
  return true;
}

/// Reads `text` into `value` where it was given.
template <class T, class Parse>
Expected<void> readGiven(const std::string& text, const char* where, T& value, const Parse& parse) {
  if (text.empty()) return {};
  auto parsed = parse(text, where);
  if (!parsed) return tl::unexpected(parsed.error());
  value = *parsed;
  return {};
}

Expected<CommandLineSettings> readSettings(const RawWords& raw) {
  CommandLineSettings read;
  const auto add = [&](const char* key, const std::string& value, const char* option) {
    if (!value.empty()) read.settings.push_back({key, value, option});
  };
  add("method.name", raw.method, "--method");
  add("preset", raw.preset, "--preset");
  add("seed", raw.seed, "--seed");
  if (!raw.samples.empty()) read.samplesPerPixel = RenderSetting{"", raw.samples, "--spp"};
  for (const std::string& set : raw.sets) {
    const std::size_t equals = set.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == set.size()) {
      return makeError("--set", fmt::format("expected key=value, found '{}'", set));
    }
    read.settings.push_back({set.substr(0, equals), set.substr(equals + 1), "--set " + set});
  }
  return read;
}

/// What a word that was looked up by its name means, or which words there are.
template <class T>
Expected<T> orUnknown(const std::optional<T>& named, const std::string& text, const std::string& where,
                      const std::vector<std::string>& names) {
  if (named) return *named;
  return makeError(where, fmt::format("expected {}, found '{}'", listWords(names), text),
                   suggestion(text, names));
}

Expected<float> parseExposure(const std::string& text, const std::string& where) {
  float stops = 0.0f;
  if (!parameter_text::parse(text, stops).empty() || !(std::abs(stops) <= kMaxExposureStops)) {
    return makeError(where, fmt::format("expected stops from {} to {}, found '{}'", -kMaxExposureStops,
                                        kMaxExposureStops, text));
  }
  return stops;
}

/// What pictures for screens show, which no other picture takes.
Expected<void> readLook(const RawWords& raw, RenderArguments& arguments) {
  const auto view = [](const std::string& text, const char* where) {
    return orUnknown(pictureViewNamed(text), text, where, viewNames());
  };
  const auto toneMap = [](const std::string& text, const char* where) {
    return orUnknown(choiceNamed(kToneMapWords, text), text, where, choiceNames(kToneMapWords));
  };
  const auto colorMap = [](const std::string& text, const char* where) {
    return orUnknown(choiceNamed(kColorMapWords, text), text, where, choiceNames(kColorMapWords));
  };
  const auto source = [](const std::string& text, const char* where) {
    return orUnknown(choiceNamed(kErrorSourceNames, text), text, where, choiceNames(kErrorSourceNames));
  };
  PictureLook& look = arguments.look;
  std::optional<ColorMap> map;
  for (const Expected<void>& read : {readGiven(raw.view, "--view", look.view, view),
                                     readGiven(raw.source, "--source", look.source, source),
                                     readGiven(raw.exposure, "--exposure", look.exposureStops, parseExposure),
                                     readGiven(raw.toneMap, "--tone-map", look.toneMap, toneMap),
                                     readGiven(raw.range, "--range", look.scale, parseScaleRange),
                                     readGiven(raw.colorMap, "--color-map", map, colorMap)}) {
    if (!read) return read;
  }
  look.scale.map = map;
  if (!raw.reference.empty()) arguments.reference = raw.reference;

  if (look.view == PictureView::Error && !arguments.reference)
    return makeError("--view", "the view `error` needs a picture to compare with",
                     "--reference FILE; --method path makes one");
  if (look.source && look.view != PictureView::ErrorSources)
    return makeError("--source", "only the view `error-sources` shows one", "add --view error-sources");
  if (look.view != PictureView::Error && arguments.reference)
    return makeError("--reference", "nothing is compared with it", "add --view error");
  const bool anyForScreens =
      std::any_of(arguments.outputs.begin(), arguments.outputs.end(),
                  [](const std::filesystem::path& path) { return isForScreens(fileEnding(path)); });
  if (anyForScreens || look == PictureLook{}) return {};
  return makeError("render", "no .png is written that would show the look asked for",
                   "other formats hold every layer as it was computed");
}

/// What --explain and its like ask for. A view of it asks for it, too.
Expected<void> readExplanation(const RawWords& raw, RenderArguments& arguments) {
  ErrorSourceRequest request;
  const auto samples = [](const std::string& text, const char* where) {
    return parseWhole(text, where, kMostExplainSamples);
  };
  const auto stride = [](const std::string& text, const char* where) {
    return parseWhole(text, where, kMostExplainStride);
  };
  for (const Expected<void>& read :
       {readGiven(raw.explainSamples, "--explain-samples", request.samples, samples),
        readGiven(raw.explainStride, "--explain-stride", request.stride, stride)}) {
    if (!read) return read;
  }
  const bool isAsked = raw.explain || arguments.look.view == PictureView::ErrorSources;
  if (isAsked) arguments.explain = request;
  arguments.tellsError = raw.explain;
  if (isAsked || (raw.explainSamples.empty() && raw.explainStride.empty())) return {};
  return makeError(raw.explainSamples.empty() ? "--explain-stride" : "--explain-samples",
                   "nothing is explained", "add --explain");
}

/// What all that render have in common: addPicture's and addWork's options.
Expected<RenderArguments> readView(const RawWords& raw) {
  RenderArguments arguments;
  arguments.scene = raw.scene;
  Expected<CommandLineSettings> settings = readSettings(raw);
  if (!settings) return tl::unexpected(settings.error());
  arguments.settings = *std::move(settings);

  const auto passes = [](const std::string& text, const char* where) {
    return parseWhole(text, where, std::numeric_limits<int>::max());
  };
  for (const Expected<void>& read :
       {readGiven(raw.size, "--size", arguments.size, parseSize),
        readGiven(raw.crop, "--crop", arguments.crop, parseCrop),
        readGiven(raw.from, "--from", arguments.cameraChanges.position, parsePoint),
        readGiven(raw.at, "--at", arguments.cameraChanges.target, parsePoint),
        readGiven(raw.up, "--up", arguments.cameraChanges.up, parsePoint),
        readGiven(raw.fov, "--fov-y", arguments.cameraChanges.fovYDegrees, parseAngle),
        readGiven(raw.orthographic, "--orthographic", arguments.cameraChanges.orthographicHeight,
                  parseLength),
        readGiven(raw.lensRadius, "--lens-radius", arguments.cameraChanges.lensRadius, parseRadius),
        readGiven(raw.focusDistance, "--focus-distance", arguments.cameraChanges.focusDistance, parseLength),
        readGiven(raw.threads, "--threads", arguments.threads, parseThreads),
        readGiven(raw.passes, "--passes", arguments.passes, passes),
        readGiven(raw.timeLimit, "--time-limit", arguments.timeLimitSeconds, parseDuration),
        readGiven(raw.targetError, "--target-error", arguments.targetError, parsePercentage)}) {
    if (!read) return tl::unexpected(read.error());
  }
  if (!raw.fov.empty() && !raw.orthographic.empty())
    return makeError("--orthographic", "cannot stand beside --fov-y, which makes the camera perspective");
  const auto readLights = [](const std::vector<std::string>& texts, const char* option,
                             std::vector<LightChange>& changes) -> Expected<void> {
    for (const std::string& text : texts) {
      const auto light = parseLight(text, option);
      if (!light) return tl::unexpected(light.error());
      changes.push_back(*light);
    }
    return {};
  };
  if (auto read = readLights(raw.lights, "--light", arguments.lights); !read)
    return tl::unexpected(read.error());
  if (auto read = readLights(raw.indirectLights, "--indirect-light", arguments.indirectLights); !read)
    return tl::unexpected(read.error());
  if (!raw.camera.empty()) arguments.camera = raw.camera;
  arguments.quiet = raw.quiet;
  return arguments;
}

Expected<CommandLine> readRender(RawWords& raw) {
  takeSceneFromOutputs(raw);
  if (raw.scene.empty()) {
    return makeError("render", "which scene? no scene file is given", "lightvane render SCENE -o FILE");
  }
  if (raw.outputs.empty()) {
    return makeError("render", "where to? no picture file is given",
                     fmt::format("-o {}.exr", std::filesystem::path(raw.scene).stem().string()));
  }
  auto view = readView(raw);
  if (!view) return tl::unexpected(view.error());
  RenderArguments& arguments = *view;
  arguments.outputs.assign(raw.outputs.begin(), raw.outputs.end());
  if (auto read = readLook(raw, arguments); !read) return tl::unexpected(read.error());
  if (auto read = readExplanation(raw, arguments); !read) return tl::unexpected(read.error());
  if (!raw.stats.empty()) arguments.stats = raw.stats;
  if (!raw.saveCache.empty()) arguments.saveCache = raw.saveCache;
  if (!raw.cache.empty()) arguments.cache = raw.cache;
  arguments.resume = raw.resume;
  arguments.lockCache = raw.lockCache;
  return arguments;
}

Expected<CommandLine> readReference(RawWords& raw) {
  takeSceneFromOutputs(raw);
  if (raw.scene.empty())
    return makeError("reference", "which scene? no scene file is given", "lightvane reference SCENE -o FILE");
  const bool hasLayers = std::all_of(raw.outputs.begin(), raw.outputs.end(),
                                     [](const std::string& path) { return !isForScreens(fileEnding(path)); });
  if (!hasLayers)
    return makeError("--output", "a .png holds what a screen shows, and nothing can be measured against that",
                     "write an .exr, which also says how sure each pixel is");
  raw.method = "path";
  if (raw.seed.empty()) raw.seed = std::to_string(kReferenceSeed);
  if (raw.samples.empty()) raw.samples = "10000000";
  raw.resume = !raw.restart;
  auto read = readRender(raw);
  if (!read) return read;
  auto& arguments = std::get<RenderArguments>(*read);
  arguments.targetNoise = 0.01;
  if (auto target = readGiven(raw.target, "--target", arguments.targetNoise, parsePercentage); !target)
    return tl::unexpected(target.error());
  return read;
}

Expected<CommandLine> readScene(const RawWords& raw) {
  if (raw.scene.empty()) {
    return makeError("scene", "which scene? no scene file is given", "lightvane scene FILE");
  }
  return SceneArguments{raw.scene, raw.json, raw.asToml};
}

Expected<CommandLine> readPaper(const RawWords& raw) {
  PaperArguments arguments;
  if (!raw.folder.empty()) arguments.folder = raw.folder;
  arguments.quiet = raw.quiet;
  for (const std::string& text : raw.figures) {
    int figure = 0;
    if (!parameter_text::parse(text, figure).empty() || figure < 3 || figure > 5)
      return makeError("--figure", fmt::format("expected 3, 4 or 5, found '{}'", text));
    arguments.figures.push_back(figure);
  }
  const auto scale = [](const std::string& text, const std::string& where) -> Expected<double> {
    double factor = 0.0;
    if (!parameter_text::parse(text, factor).empty() || !(factor >= 0.01 && factor <= 10.0))
      return makeError(where, fmt::format("expected a factor from 0.01 to 10, found '{}'", text));
    return factor;
  };
  const auto reference = [](const std::string& text, const std::string& where) -> Expected<int> {
    constexpr int kMost = 10'000'000;
    int paths = 0;
    if (!parameter_text::parse(text, paths).empty() || paths < 0 || paths == 1 || paths > kMost) {
      return makeError(where, fmt::format("expected 0, or from 2 paths a pixel, which tell their noise, to "
                                          "{}, found '{}'",
                                          kMost, text));
    }
    return paths;
  };
  for (const Expected<void>& read :
       {readGiven(raw.scale, "--scale", arguments.scale, scale),
        readGiven(raw.reference, "--reference", arguments.referenceSamples, reference),
        readGiven(raw.threads, "--threads", arguments.threads, parseThreads)}) {
    if (!read) return tl::unexpected(read.error());
  }
  return arguments;
}

Expected<void> readWithout(const RawWords& raw, bool& edges, bool& lights) {
  for (const std::string& what : raw.without) {
    if (what != "edges" && what != "lights")
      return makeError("--without", fmt::format("expected edges or lights, found '{}'", what));
    (what == "edges" ? edges : lights) = true;
  }
  return {};
}

Expected<void> readSeeds(const RawWords& raw, int& seeds) {
  return readGiven(raw.seeds, "--seeds", seeds, [](const std::string& text, const char* where) {
    return parseWhole(text, where, 10'000);
  });
}

Expected<CommandLine> readStudy(const RawWords& raw) {
  const Study* named = findStudy(raw.study);
  const auto study =
      orUnknown(named != nullptr ? std::optional(*named) : std::nullopt, raw.study, "--study", studyNames());
  if (!study) return tl::unexpected(study.error());
  if (raw.folder.empty()) return makeError("sweep", "where to? no folder is given", "-o FOLDER");
  const bool isVaried = !raw.varied.empty();
  const bool isOfOneView = !raw.camera.empty() || !raw.crop.empty() || !raw.lights.empty() ||
                           !raw.indirectLights.empty() || !raw.from.empty() || !raw.at.empty() ||
                           !raw.up.empty() || !raw.fov.empty() || !raw.orthographic.empty() ||
                           !raw.lensRadius.empty() || !raw.focusDistance.empty();
  if (isVaried || raw.around || !raw.random.empty() || !raw.rivals.empty()) {
    return makeError(
        "--study",
        fmt::format("has points of its own, and {} asks for others", isVaried              ? "--vary"
                                                                     : raw.around          ? "--around"
                                                                     : !raw.random.empty() ? "--random"
                                                                                           : "--rivals"),
        "give one of them");
  }
  if (isOfOneView) {
    return makeError(
        "--study", "sees each scene by its first camera and in its own light",
        "leave out what changes one view: --camera, --from to --focus-distance, --light, --crop");
  }
  StudyArguments arguments;
  auto view = readView(raw);
  if (!view) return tl::unexpected(view.error());
  arguments.sweep.view = *std::move(view);
  arguments.sweep.folder = raw.folder;
  arguments.sweep.reference = raw.reference;
  arguments.sweep.rivals.clear();
  arguments.sweep.seeds = study->seeds;
  arguments.study = study->name;
  arguments.scenes.assign(raw.scenes.begin(), raw.scenes.end());
  arguments.markdown = raw.markdown;
  const auto paths = [](const std::string& text, const char* where) {
    return parseWhole(text, where, 10'000'000);
  };
  for (const Expected<void>& read :
       {readSeeds(raw, arguments.sweep.seeds),
        readGiven(raw.referencePaths, "--spp", arguments.referencePaths, paths),
        readWithout(raw, arguments.sweep.withoutEdges, arguments.sweep.withoutLights)}) {
    if (!read) return tl::unexpected(read.error());
  }
  return arguments;
}

Expected<CommandLine> readSweep(const RawWords& raw) {
  if (!raw.study.empty()) return readStudy(raw);
  for (const auto& [isGiven, option] :
       {std::pair(!raw.referencePaths.empty(), "--spp"), {raw.markdown, "--markdown"}}) {
    if (isGiven) return makeError(option, "is of a study", "--study corrections");
  }
  if (raw.scenes.empty())
    return makeError("sweep", "which scene? no scene file is given", "lightvane sweep SCENE --vary KEY=A,B");
  if (raw.scenes.size() > 1)
    return makeError("sweep", fmt::format("unexpected word '{}'", raw.scenes[1]),
                     "one SCENE at a time, but with --study");
  if (raw.reference.empty()) {
    return makeError("sweep", "there is no reference to measure errors against",
                     "--reference FILE; lightvane reference makes one");
  }
  if (raw.folder.empty()) return makeError("sweep", "where to? no folder is given", "-o FOLDER");
  if (raw.varied.empty())
    return makeError("sweep", "which parameters? nothing is varied", "--vary ilv.radius_scale=0.2:1:5");
  SweepArguments arguments;
  auto view = readView(raw);
  if (!view) return tl::unexpected(view.error());
  arguments.view = *std::move(view);
  arguments.view.scene = raw.scenes.front();
  arguments.folder = raw.folder;
  arguments.reference = raw.reference;
  std::size_t points = 1;
  constexpr std::size_t kMostPoints = 100'000;
  for (const std::string& text : raw.varied) {
    auto varied = parseVaried(text, "--vary");
    if (!varied) return tl::unexpected(varied.error());
    const bool isTwice = std::any_of(arguments.varied.begin(), arguments.varied.end(),
                                     [&](const VariedParameter& other) { return other.key == varied->key; });
    if (isTwice) return makeError("--vary", fmt::format("{} is varied twice", varied->key));
    points *= varied->values.size();
    if (points > kMostPoints)
      return makeError("--vary", fmt::format("more than {} combinations", kMostPoints),
                       "--around, or fewer values");
    arguments.varied.push_back(*std::move(varied));
  }
  arguments.around = raw.around;
  const auto count = [](const std::string& text, const char* where) {
    return parseWhole(text, where, 10'000);
  };
  for (const Expected<void>& read :
       {readGiven(raw.random, "--random", arguments.random, count), readSeeds(raw, arguments.seeds)}) {
    if (!read) return tl::unexpected(read.error());
  }
  if (!raw.rivals.empty()) {
    arguments.rivals = raw.rivals;
    if (raw.rivals == std::vector<std::string>{"none"}) arguments.rivals.clear();
    for (const std::string& rival : arguments.rivals) {
      if (rival != "direct" && rival != "path" && rival != "naive")
        return makeError("--rivals", fmt::format("expected direct, path, naive or none, found '{}'", rival));
    }
  }
  if (auto read = readWithout(raw, arguments.withoutEdges, arguments.withoutLights); !read)
    return tl::unexpected(read.error());
  return arguments;
}

Expected<CommandLine> readCompare(const RawWords& raw) {
  if (raw.pictureFile.empty() || raw.referenceFile.empty())
    return makeError("compare", "which pictures? two are compared", "lightvane compare PICTURE REFERENCE");
  CompareArguments arguments;
  arguments.picture = raw.pictureFile;
  arguments.reference = raw.referenceFile;
  for (const std::string& name : raw.metrics) {
    const std::optional<std::string> known = findMetric(name) != nullptr ? std::optional(name) : std::nullopt;
    const auto metric = orUnknown(known, name, "--metric", metricNames());
    if (!metric) return tl::unexpected(metric.error());
    arguments.metrics.push_back(*metric);
  }
  arguments.layers = raw.layers;
  if (auto read = readWithout(raw, arguments.withoutEdges, arguments.withoutLights); !read)
    return tl::unexpected(read.error());
  const auto colorMap = [](const std::string& text, const char* where) {
    return orUnknown(choiceNamed(kColorMapWords, text), text, where, choiceNames(kColorMapWords));
  };
  std::optional<ColorMap> map;
  for (const Expected<void>& read :
       {readGiven(raw.exposure, "--exposure", arguments.exposureStops, parseExposure),
        readGiven(raw.range, "--range", arguments.scale, parseScaleRange),
        readGiven(raw.colorMap, "--color-map", map, colorMap)}) {
    if (!read) return tl::unexpected(read.error());
  }
  arguments.scale.map = map;
  if (!raw.map.empty()) arguments.map = raw.map;
  if (arguments.map && arguments.metrics.size() != 1)
    return makeError("--map", "a map is of one metric",
                     "name it with --metric, for example relative or flip");
  const bool isForScreen = arguments.map && isForScreens(fileEnding(*arguments.map));
  if (!isForScreen && arguments.scale != ScaleOverride{})
    return makeError("compare", "--range and --color-map are of a --map for screens", "--map FILE.png");
  arguments.json = raw.json;
  arguments.quiet = raw.quiet;
  return arguments;
}

/// What is written without a command: nothing, a scene, or a mistake.
Expected<CommandLine> readOpen(std::span<const std::string> words, const CLI::App& app) {
  if (words.empty()) return OpenArguments{};
  const std::string& first = words.front();
  const bool isSession = fileEnding(first) == kSessionEnding;
  if (isSceneName(first) || isSession) {
    if (words.size() == 1) return OpenArguments{first};
    return makeError(
        "", fmt::format("a {} without a command takes no more words", isSession ? "session" : "scene"),
        isSession ? "" : fmt::format("lightvane render {} -o FILE ...", first));
  }
  if (first.starts_with('-')) return tl::unexpected(unexpectedWord(app, {first}));
  std::vector<std::string> commands;
  for (const CLI::App* command : app.get_subcommands({})) commands.push_back(command->get_name());
  const std::string nearest = suggestion(first, commands);
  return makeError(
      "",
      fmt::format("'{}' is neither a command nor a .toml, .obj, .ply, .gltf, .glb or .lvsession file", first),
      nearest.empty() ? "commands are " + listWords(commands) : nearest);
}

}  // namespace

Expected<double> parseDuration(const std::string& text, const std::string& where) {
  std::string_view digits = text;
  double unit = 1.0;
  if (!digits.empty()) {
    const char last = digits.back();
    if (last == 's' || last == 'm' || last == 'h') {
      unit = last == 's' ? 1.0 : last == 'm' ? 60.0 : 3600.0;
      digits.remove_suffix(1);
    }
  }
  // A century: what clocks add without overflow.
  constexpr double kLongest = 3.0e9;
  double value = 0.0;
  if (!parameter_text::parse(digits, value).empty() || !(value > 0.0) || value * unit > kLongest) {
    return makeError(where, fmt::format("expected a time such as 90, 90s, 2m or 1h, found '{}'", text));
  }
  return value * unit;
}

Expected<double> parsePercentage(const std::string& text, const std::string& where) {
  const bool isPercent = text.ends_with('%');
  const std::string_view digits = std::string_view(text).substr(0, text.size() - (isPercent ? 1 : 0));
  double value = 0.0;
  const bool isNumber = parameter_text::parse(digits, value).empty();
  if (isPercent) value /= 100.0;
  if (!isNumber || !(value > 0.0 && value <= 1.0))
    return makeError(where,
                     fmt::format("expected a part of the picture's light such as 0.5%, found '{}'", text));
  return value;
}

Expected<PictureSize> parseSize(const std::string& text, const std::string& where) {
  const std::size_t cross = text.find('x');
  PictureSize size;
  const auto inRange = [](int side) { return side >= 1 && side <= kLargestSide; };
  if (cross == std::string::npos ||
      !parameter_text::parse(std::string_view(text).substr(0, cross), size.width).empty() ||
      !parameter_text::parse(std::string_view(text).substr(cross + 1), size.height).empty() ||
      !inRange(size.width) || !inRange(size.height)) {
    return makeError(where,
                     fmt::format("expected WIDTHxHEIGHT, each from 1 to {}, found '{}'", kLargestSide, text));
  }
  return size;
}

Expected<PictureCrop> parseCrop(const std::string& text, const std::string& where) {
  std::array<int, 4> numbers{};
  std::string_view left = text;
  bool ok = true;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const std::size_t comma = i + 1 < numbers.size() ? left.find(',') : left.size();
    ok = ok && comma != std::string_view::npos &&
         parameter_text::parse(left.substr(0, comma), numbers[i]).empty();
    left.remove_prefix(std::min(left.size(), comma == std::string_view::npos ? left.size() : comma + 1));
  }
  const PictureCrop crop{numbers[0], numbers[1], numbers[2], numbers[3]};
  if (!ok || crop.x < 0 || crop.y < 0 || crop.width < 1 || crop.height < 1) {
    return makeError(where, fmt::format("expected X,Y,WIDTH,HEIGHT in pixels, found '{}'", text));
  }
  return crop;
}

Expected<Vec3d> parsePoint(const std::string& text, const std::string& where) {
  std::array<double, 3> numbers{};
  if (!parseNumbers(text, numbers))
    return makeError(where, fmt::format("expected X,Y,Z in the scene's units, found '{}'", text));
  return Vec3d(numbers[0], numbers[1], numbers[2]);
}

Expected<ScaleOverride> parseScaleRange(const std::string& text, const std::string& where) {
  std::array<double, 2> ends{};
  const bool areNumbers = parseNumbers(text, ends);
  ScaleOverride scale;
  scale.fixedRange = true;
  scale.low = static_cast<float>(ends[0]);
  scale.high = static_cast<float>(ends[1]);
  if (!areNumbers || !std::isfinite(scale.low) || !std::isfinite(scale.high) || !(scale.low < scale.high)) {
    return makeError(where, fmt::format("expected LOW,HIGH with LOW below HIGH, found '{}'", text));
  }
  return scale;
}

Expected<LightChange> parseLight(const std::string& text, const std::string& where) {
  // Names may have any characters: the last = counts.
  const std::size_t equals = text.rfind('=');
  const auto wrong = [&] {
    return makeError(where, fmt::format("expected NAME=FACTOR or NAME=R,G,B, found '{}'", text));
  };
  if (equals == std::string::npos || equals == 0) return wrong();
  const std::string_view value = std::string_view(text).substr(equals + 1);
  std::array<double, 3> factors{};
  if (parseNumbers(value, std::span(factors).first(1))) {
    factors[1] = factors[2] = factors[0];
  } else if (!parseNumbers(value, factors)) {
    return wrong();
  }
  // Beyond it the light of a bright scene would not be finite any more.
  constexpr double kMostFactor = 1e6;
  for (const double factor : factors) {
    if (!(factor >= 0.0 && factor <= kMostFactor))
      return makeError(where,
                       fmt::format("a light is multiplied by 0 to {:g}, not by '{}'", kMostFactor, value));
  }
  return LightChange{text.substr(0, equals), Rgb(factors[0], factors[1], factors[2])};
}

Expected<CommandLine> parseCommandLine(std::span<const std::string> words) {
  RawWords raw;
  CLI::App app(kDescription, "lightvane");
  app.set_version_flag("--version", fmt::format("lightvane {}", versionText()),
                       "Prints the version and exits");
  app.get_formatter()->column_width(34);
  app.footer(kExamples);
  const std::array commands = {addRender(app, raw), addScene(app, raw),   addParameters(app, raw),
                               addPaper(app, raw),  addCompare(app, raw), addReference(app, raw),
                               addSweep(app, raw)};
  // Words that nothing takes come back from remaining(), so that the message can name the nearest option.
  app.allow_extras();
  for (CLI::App* command : commands) command->allow_extras();

  try {
    app.parse(std::vector<std::string>(words.rbegin(), words.rend()));  // CLI11 takes them from the end
  } catch (const CLI::CallForHelp&) {
    const auto used = app.get_subcommands();
    return TextAnswer{used.empty() ? app.help() : used.front()->help("lightvane")};
  } catch (const CLI::CallForAllHelp&) {
    return TextAnswer{app.help("", CLI::AppFormatMode::All)};
  } catch (const CLI::CallForVersion& version) {
    return TextAnswer{fmt::format("{}\n", version.what())};
  } catch (const CLI::ParseError& error) {
    return makeError("", error.what(), "lightvane --help tells what there is");
  }

  const auto used = app.get_subcommands();
  if (used.empty()) return readOpen(words, app);
  const CLI::App& command = *used.front();
  if (const auto left = app.remaining(true); !left.empty())
    return tl::unexpected(unexpectedWord(command, left));
  for (const CLI::Option* option : command.get_options()) {
    const std::vector<std::string>& values = option->results();
    if (std::find(values.begin(), values.end(), "") != values.end())
      return makeError(option->get_name(), "has an empty value", "leave it out, or give it one");
  }
  if (&command == commands[0]) return readRender(raw);
  if (&command == commands[1]) return readScene(raw);
  if (&command == commands[3]) return readPaper(raw);
  if (&command == commands[4]) return readCompare(raw);
  if (&command == commands[5]) return readReference(raw);
  if (&command == commands[6]) return readSweep(raw);
  return ParametersArguments{raw.keys, raw.markdown};
}

}  // namespace lightvane
