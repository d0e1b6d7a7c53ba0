#include "app/paper_command.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "app/command_load.h"
#include "app/output_files.h"
#include "app/progress.h"
#include "app/settings.h"
#include "app/shipped_files.h"
#include "app/statistics_file.h"
#include "app/stop.h"
#include "app/view.h"
#include "core/image/image_file.h"
#include "core/inspect/picture_style.h"
#include "core/inspect/units.h"
#include "core/measure/picture_error.h"
#include "core/scene/load_scene.h"

namespace lightvane {
namespace {

namespace fs = std::filesystem;

/// What the paper says of one picture; 0 where it says nothing.
struct PaperNumbers {
  double minutes = 0.0;
  int indirectVectors = 0;
  int directVectors = 0;
};

struct Figure {
  int number;
  const char* scene;
  PaperNumbers vectors, naive, direct;
};

/// Section 6; the times are those of a Silicon Graphics Indigo.
constexpr Figure kFigures[] = {{3, "fig3-cornell", {8.0, 0, 0}, {}, {}},
                               {4, "fig4-spheres", {10.0, 4200, 0}, {180.0, 0, 0}, {2.0, 0, 0}},
                               {5, "fig5-interior", {180.0, 11000, 15000}, {}, {}}};

struct MethodOfPaper {
  Method method;
  const char* text;  ///< of the table
  PaperNumbers Figure::*numbers;
};

/// The quick ones first: a run that is stopped has most of its rows.
constexpr MethodOfPaper kMethods[] = {{Method::Vectors, "light vectors", &Figure::vectors},
                                      {Method::Direct, "direct, ambient term", &Figure::direct},
                                      {Method::Naive, "naive, {} samples", &Figure::naive}};

/// A finished picture and what it took.
struct Rendered {
  ImageRgb beauty;
  ImageRgb variance;  ///< of `path`
  RenderStatistics statistics;
  Parameters parameters;
  PictureRegion region;
  double cpuSeconds = 0.0;
};

struct Row {
  const MethodOfPaper* method;
  Rendered rendered;
  std::optional<PictureError> error;
};

/// All that one figure is rendered with.
class FigureRun {
 public:
  FigureRun(const PaperArguments& arguments, const StopFlag& stop, const Figure& figure,
            SceneDescription description)
      : arguments_(arguments), stop_(stop), figure_(figure), description_(std::move(description)) {}

  /// The table's rows of the figure; fewer where it was stopped.
  Expected<std::vector<Row>> run() {
    std::vector<Row> rows;
    for (const MethodOfPaper& method : kMethods) {
      auto rendered = render(method.method, {});
      if (!rendered) return tl::unexpected(rendered.error());
      if (!*rendered) return rows;
      rows.push_back({&method, **std::move(rendered), {}});
    }
    if (arguments_.referenceSamples == 0) return rows;
    const auto reference =
        render(Method::Path, {{"path.samples", std::to_string(arguments_.referenceSamples), "--reference"},
                              // Another seed than theirs: what they have in common would be no error.
                              {"seed", "2", "--reference"}});
    if (!reference) return tl::unexpected(reference.error());
    if (!*reference) return rows;
    for (Row& row : rows)
      row.error = pictureError(row.rendered.beauty, (*reference)->beauty, (*reference)->variance);
    return rows;
  }

 private:
  /// Nothing where it was stopped.
  Expected<std::optional<Rendered>> render(Method method, std::vector<RenderSetting> settings) const {
    const std::string name(choiceName(kMethodNames, method));
    settings.push_back({"method.name", name, "paper"});
    const auto parameters = resolveParameters(description_.render, {settings, {}});
    if (!parameters) return tl::unexpected(parameters.error());
    if (!arguments_.quiet) printNote(fmt::format("figure {}, {}", figure_.number, name));

    const double begun = processCpuSeconds();
    const auto tracer = untilStopped([&]() -> Expected<std::shared_ptr<const Tracer>> {
      CommandLoad loading(stop_, arguments_.quiet);
      const auto compiled = Scene::compile(description_, energyRuleFor(*parameters), loading.watch());
      if (!compiled) return tl::unexpected(compiled.error());
      return std::make_shared<const Tracer>(*compiled, loading.watch());
    });
    if (!tracer && tracer.error().isStop) return std::nullopt;
    if (!tracer) return tl::unexpected(tracer.error());
    const std::shared_ptr<const Scene> scene = (*tracer)->sharedScene();
    RenderArguments asked;
    const CameraDescription& camera = description_.cameras.front();
    const auto scaled = [&](int side) {
      return std::max(1, static_cast<int>(std::lround(arguments_.scale * side)));
    };
    asked.size = PictureSize{scaled(camera.width), scaled(camera.height)};
    const auto view = chooseView(description_, *scene, asked);
    if (!view) return tl::unexpected(view.error());
    const RenderContext context{scene,        *tracer,     view->camera,
                                view->region, *parameters, std::make_shared<TaskPool>(arguments_.threads)};
    const std::unique_ptr<Renderer> renderer = makeRenderer(context);
    {
      const FlushDenormals flush;
      ProgressDisplay display(progressStyle(arguments_.quiet));
      display.update(*renderer);
      while (!renderer->done()) {
        if (!renderer->runPass(stop_)) return std::nullopt;
        display.update(*renderer);
      }
    }
    Rendered rendered;
    rendered.cpuSeconds = processCpuSeconds() - begun;
    rendered.statistics = renderer->statistics();
    rendered.parameters = *parameters;
    rendered.region = view->region;
    const RenderFrame frame = makeFrame(context, *renderer);
    rendered.beauty = frame.film->beauty();
    rendered.variance = frame.film->variance;
    if (auto written = write(frame, name); !written) return tl::unexpected(written.error());
    return rendered;
  }

  Expected<void> write(const RenderFrame& frame, const std::string& method) const {
    const fs::path base = arguments_.folder / fmt::format("{}-{}", figure_.scene, method);
    if (auto written = writeImage(base.string() + ".png", screenPicture(frame)); !written) return written;
    return writeImage(base.string() + ".exr", frame.film->toLayers(*frame.scene));
  }

  const PaperArguments& arguments_;
  const StopFlag& stop_;
  const Figure& figure_;
  SceneDescription description_;
};

std::string orDash(bool isKnown, const std::string& text) { return isKnown ? text : "–"; }

std::string timesText(double part, double whole) {
  return orDash(part > 0.0 && whole > 0.0, numberText(part / std::max(whole, 1e-9), 2));
}

std::string errorText(const std::optional<PictureError>& error) {
  if (!error) return "–";
  return fmt::format("{:.1f} ± {:.1f}", 100.0 * error->relative, 100.0 * error->standardError);
}

std::string rowsText(const Figure& figure, std::span<const Row> rows) {
  std::string text;
  if (rows.empty()) return text;
  const Rendered& vectors = rows.front().rendered;
  for (const Row& row : rows) {
    const PaperNumbers& paper = figure.*row.method->numbers;
    const Rendered& ours = row.rendered;
    const bool isOfVectors = row.method->method == Method::Vectors;
    text += fmt::format(
        "| {} | {}x{} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |\n", figure.number,
        ours.region.width, ours.region.height,
        fmt::format(fmt::runtime(row.method->text), ours.parameters.picture.naiveSamples),
        orDash(paper.minutes > 0.0, fmt::format("{:g} min", paper.minutes)),
        timesText(paper.minutes, figure.vectors.minutes),
        orDash(paper.indirectVectors > 0, std::to_string(paper.indirectVectors)),
        orDash(paper.directVectors > 0, std::to_string(paper.directVectors)),
        fmt::format("{} s", numberText(ours.cpuSeconds, 3)), timesText(ours.cpuSeconds, vectors.cpuSeconds),
        orDash(isOfVectors, std::to_string(ours.statistics.ilvRecords)),
        orDash(isOfVectors, std::to_string(ours.statistics.dlvRecords)), errorText(row.error));
  }
  return text;
}

std::string tableHead(const PaperArguments& arguments) {
  std::string text =
      "The paper's figures (section 6, a Silicon Graphics Indigo) beside ours: CPU time of all threads, and "
      "as a multiple of\nthat of light vectors.";
  if (arguments.referenceSamples > 0) {
    text += fmt::format(
        " Error: root of the mean squared relative difference from {} paths a pixel, whose own\nnoise is "
        "taken off, in per cent.",
        arguments.referenceSamples);
  }
  return text +
         "\n\n| figure | pixels | method | paper: time | times | ILVs | DLVs | ours: time | times | ILVs | "
         "DLVs | error, % |\n|--:|---|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n";
}

}  // namespace

Expected<ExitCode> renderPaper(const PaperArguments& arguments) {
  // All that can be wrong is found before hours of work.
  if (auto made = makeFolder(arguments.folder); !made) return tl::unexpected(made.error());
  if (auto writable = checkWritableImage(arguments.folder / "fig3-cornell-vectors.png"); !writable)
    return tl::unexpected(writable.error());
  const StopFlag& stop = stopOnSignals();
  std::vector<std::pair<const Figure*, SceneDescription>> figures;
  for (const Figure& figure : kFigures) {
    const auto isAsked = std::find(arguments.figures.begin(), arguments.figures.end(), figure.number);
    if (!arguments.figures.empty() && isAsked == arguments.figures.end()) continue;
    const std::string name = fmt::format("assets/scenes/{}.toml", figure.scene);
    const auto path = shippedFile(name);
    if (!path) {
      return makeError(name, "is not there: the paper's scenes belong to the source tree",
                       "use the program in the folder where it was built");
    }
    CommandLoad loading(stop, arguments.quiet);
    auto description = loadScene(*path, loading.watch());
    if (!description) return endWithoutScene(description.error(), arguments.quiet);
    figures.emplace_back(&figure, *std::move(description));
  }

  if (auto printed = printAnswer(tableHead(arguments)); !printed) return tl::unexpected(printed.error());
  for (auto& [figure, description] : figures) {
    const auto rows = FigureRun(arguments, stop, *figure, std::move(description)).run();
    if (!rows) return tl::unexpected(rows.error());
    if (auto printed = printAnswer(rowsText(*figure, *rows)); !printed)
      return tl::unexpected(printed.error());
    if (stop) return ExitCode::Stopped;
  }
  if (!arguments.quiet) printNote(fmt::format("the pictures are in {}", arguments.folder.string()));
  return ExitCode::Success;
}

}  // namespace lightvane
