#include "app/document.h"

#include <atomic>
#include <mutex>
#include <new>
#include <utility>

#include <fmt/format.h>

#include "app/settings.h"
#include "core/scene/load_scene.h"

namespace lightvane {
namespace {

Expected<Document> compiled(Document document, LoadWatch& watch) {
  auto scene = Scene::compile(document.description, document.energy, watch);
  if (!scene) return tl::unexpected(scene.error());
  document.scene = *std::move(scene);
  document.tracer = std::make_shared<const Tracer>(document.scene, watch);
  document.warnings = document.scene->warnings;
  return document;
}

/// What throws in a loader ends as a message.
Expected<Document> guarded(const std::filesystem::path& path,
                           const std::function<Expected<Document>()>& work) {
  try {
    return work();
  } catch (const std::bad_alloc&) {
    return makeError(path.string(), "takes more memory than there is");
  } catch (const std::exception& broken) {
    return makeError(path.string(), broken.what());
  }
}

}  // namespace

Expected<Document> loadDocument(const std::filesystem::path& path, LoadWatch& watch) {
  Document document;
  document.path = path;
  auto description = loadScene(path, watch);
  if (!description) return tl::unexpected(description.error());
  document.description = *std::move(description);
  const auto parameters = resolveParameters(document.description.render, {});
  if (!parameters) return tl::unexpected(parameters.error());
  document.start = *parameters;
  document.energy = energyRuleFor(document.start);
  return untilStopped([&] { return compiled(std::move(document), watch); });
}

Expected<Document> recompiled(const Document& document, EnergyRule energy, LoadWatch& watch) {
  Document other = document;
  other.energy = energy;
  return untilStopped([&] { return compiled(std::move(other), watch); });
}

void DocumentLoader::load(const std::filesystem::path& path) {
  start(path, [path](LoadWatch& watch) { return loadDocument(path, watch); });
  isReading_ = true;
}

void DocumentLoader::recompile(const Document& document, EnergyRule energy) {
  start(document.path, [document, energy](LoadWatch& watch) { return recompiled(document, energy, watch); });
}

void DocumentLoader::cancel() {
  job_.cancel();
  loading_.clear();
  isReading_ = false;
}

void DocumentLoader::start(const std::filesystem::path& path, Work work) {
  loading_ = path;
  isReading_ = false;
  progress_ = std::make_shared<LoadProgress>();
  job_.start([path, work = std::move(work), progress = progress_](const StopFlag& stop) {
    FlagWatch watch(stop, *progress);
    return guarded(path, [&] { return work(watch); });
  });
}

std::optional<Expected<Document>> DocumentLoader::take() {
  std::optional<Expected<Document>> result = job_.take();
  if (result) cancel();
  return result;
}

}  // namespace lightvane
