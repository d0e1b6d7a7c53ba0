#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/background_job.h"
#include "core/base/error.h"
#include "core/base/load_watch.h"
#include "core/render/parameters.h"
#include "core/trace/tracer.h"

namespace lightvane {

/// A scene as it was loaded, ready to be rendered.
struct Document {
  std::filesystem::path path;
  SceneDescription description;
  Parameters start;  ///< what the scene's file asks for
  EnergyRule energy = EnergyRule::Refined;
  std::shared_ptr<const Scene> scene;
  std::shared_ptr<const Tracer> tracer;
  std::vector<std::string> warnings;
};

/// Reads and compiles a scene. Where `watch` stops it, the error has isStop.
Expected<Document> loadDocument(const std::filesystem::path& path, LoadWatch& watch = LoadWatch::none());

/// The same scene with its materials compiled by another rule. Cost: as loading it, without its files.
/// Where `watch` stops it, the error has isStop.
Expected<Document> recompiled(const Document& document, EnergyRule energy,
                              LoadWatch& watch = LoadWatch::none());

/// Loads documents in a thread of its own; the latest wish wins, and the loading of another ends within
/// milliseconds (LoadWatch) and leaves nothing. The destructor waits for that. All methods on one thread;
/// `done` is called on the loader's.
class DocumentLoader {
 public:
  explicit DocumentLoader(std::function<void()> done) : job_(std::move(done)) {}

  void load(const std::filesystem::path& path);
  void recompile(const Document& document, EnergyRule energy);
  /// What is being loaded will not arrive, and its thread ends soon.
  void cancel();

  /// The file that is being loaded; empty where none is.
  const std::filesystem::path& loading() const { return loading_; }
  /// What is done for it, and how far that is.
  LoadProgress::State progress() const { return progress_->state(); }
  /// Whether that is read, and not only compiled again.
  bool isReading() const { return isReading_; }
  /// What was asked for last, once, when it is there.
  std::optional<Expected<Document>> take();

 private:
  using Work = std::function<Expected<Document>(LoadWatch&)>;
  void start(const std::filesystem::path& path, Work work);

  std::filesystem::path loading_;
  bool isReading_ = false;
  std::shared_ptr<LoadProgress> progress_ = std::make_shared<LoadProgress>();  ///< its thread's, too
  BackgroundJob<Expected<Document>> job_;
};

}  // namespace lightvane
