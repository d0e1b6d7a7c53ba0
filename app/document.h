#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/background_job.h"
#include "core/base/error.h"
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

Expected<Document> loadDocument(const std::filesystem::path& path);

/// The same scene with its materials compiled by another rule. Cost: as loading it, without its files.
Expected<Document> recompiled(const Document& document, EnergyRule energy);

/// Loads documents in a thread of its own; the latest wish wins, and what is loaded for another is thrown
/// away. All methods on one thread; `done` is called on the loader's.
class DocumentLoader {
 public:
  explicit DocumentLoader(std::function<void()> done) : job_(std::move(done)) {}

  void load(const std::filesystem::path& path);
  void recompile(const Document& document, EnergyRule energy);
  /// What is being loaded will not arrive.
  void cancel();

  /// The file that is being loaded; empty where none is.
  const std::filesystem::path& loading() const { return loading_; }
  /// Whether that is read, and not only compiled again.
  bool isReading() const { return isReading_; }
  /// What was asked for last, once, when it is there.
  std::optional<Expected<Document>> take();

 private:
  void start(const std::filesystem::path& path, std::function<Expected<Document>()> work);

  std::filesystem::path loading_;
  bool isReading_ = false;
  BackgroundJob<Expected<Document>> job_;
};

}  // namespace lightvane
