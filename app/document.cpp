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

Expected<Document> compiled(Document document) {
  auto scene = Scene::compile(document.description, document.energy);
  if (!scene) return tl::unexpected(scene.error());
  document.scene = *std::move(scene);
  document.tracer = std::make_shared<const Tracer>(document.scene);
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

Expected<Document> loadDocument(const std::filesystem::path& path) {
  Document document;
  document.path = path;
  auto description = loadScene(path);
  if (!description) return tl::unexpected(description.error());
  document.description = *std::move(description);
  const auto parameters = resolveParameters(document.description.render, {});
  if (!parameters) return tl::unexpected(parameters.error());
  document.start = *parameters;
  document.energy = energyRuleFor(document.start);
  return compiled(std::move(document));
}

Expected<Document> recompiled(const Document& document, EnergyRule energy) {
  Document other = document;
  other.energy = energy;
  return compiled(std::move(other));
}

void DocumentLoader::load(const std::filesystem::path& path) {
  start(path, [path] { return loadDocument(path); });
  isReading_ = true;
}

void DocumentLoader::recompile(const Document& document, EnergyRule energy) {
  start(document.path, [document, energy] { return recompiled(document, energy); });
}

void DocumentLoader::cancel() {
  job_.cancel();
  loading_.clear();
  isReading_ = false;
}

void DocumentLoader::start(const std::filesystem::path& path, std::function<Expected<Document>()> work) {
  loading_ = path;
  isReading_ = false;
  job_.start([path, work = std::move(work)](const StopFlag&) { return guarded(path, work); });
}

std::optional<Expected<Document>> DocumentLoader::take() {
  std::optional<Expected<Document>> result = job_.take();
  if (result) cancel();
  return result;
}

}  // namespace lightvane
