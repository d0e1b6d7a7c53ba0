#include "app/export_job.h"

#include <atomic>
#include <exception>
#include <utility>

namespace lightvane {

struct ExportJob::Shared {
  std::atomic<bool> ready = false;
  Expected<void> done;
};

ExportJob::~ExportJob() {
  if (thread_.joinable()) thread_.join();
}

void ExportJob::start(std::filesystem::path path, std::function<Expected<void>()> write) {
  path_ = std::move(path);
  shared_ = std::make_shared<Shared>();
  thread_ = std::thread([shared = shared_, name = path_.string(), write = std::move(write), done = done_] {
    try {
      shared->done = write();
    } catch (const std::exception& broken) {
      shared->done = makeError(name, broken.what());
    }
    shared->ready = true;
    if (done) done();
  });
}

std::optional<ExportJob::Outcome> ExportJob::take() {
  if (!thread_.joinable() || !shared_->ready) return std::nullopt;
  thread_.join();
  return Outcome{path_, shared_->done};
}

}  // namespace lightvane
