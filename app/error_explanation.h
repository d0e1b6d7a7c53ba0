#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "app/background_job.h"
#include "core/inspect/error_sources.h"
#include "core/render/render_frame.h"

namespace lightvane {

/// Where the error of the picture comes from, found out in the background while somebody looks: of few pixels
/// at first, then of more and more, until all are known. On one thread.
class ErrorExplanation {
 public:
  explicit ErrorExplanation(std::function<void()> wake) : job_(std::move(wake)) {}

  /// Takes what has become known, and goes on while `isAsked`; ends the work otherwise. `rests`: nothing else
  /// is being made.
  void update(const std::shared_ptr<const RenderFrame>& frame, bool isAsked, bool rests);

  /// Of that frame; null where nothing is known.
  std::shared_ptr<const ErrorSources> sourcesOf(const RenderFrame* frame) const;
  /// "1024 of 262144 pixels; finer: 34 %"; what it waits for; empty where there is nothing to tell.
  std::string textOf(const RenderFrame* frame) const;

 private:
  struct Known {
    std::shared_ptr<const RenderFrame> frame;
    std::shared_ptr<const ErrorSources> sources;
  };

  std::optional<Known> known_;
  std::shared_ptr<const RenderFrame> wanted_;  ///< what the job is about
  std::shared_ptr<std::atomic<double>> done_;  ///< which part of the job
  std::string waitsFor_;
  BackgroundJob<Known> job_;
};

}  // namespace lightvane
