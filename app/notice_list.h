#pragma once

#include <string>
#include <vector>

#include "app/panels/panel_io.h"

namespace lightvane {

/// What was told, the oldest first, until it is dismissed; of very many the newest.
class NoticeList {
 public:
  /// `now` in seconds, of the clock that `at` is asked by. What was told last is not told twice: it is new
  /// again.
  void add(Severity severity, const std::string& text, double now);
  void dismiss(std::uint64_t id);
  /// With their ages.
  std::vector<Notice> at(double now) const;

 private:
  struct Entry {
    Notice notice;
    double time;
  };

  std::vector<Entry> entries_;
  std::uint64_t lastId_ = 0;
};

}  // namespace lightvane
