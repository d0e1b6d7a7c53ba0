#include "app/notice_list.h"

namespace lightvane {
namespace {

constexpr std::size_t kMostNotices = 50;

}  // namespace

void NoticeList::add(Severity severity, const std::string& text, double now) {
  if (!entries_.empty() && entries_.back().notice.severity == severity && entries_.back().notice.text == text)
    entries_.pop_back();
  entries_.push_back({{++lastId_, severity, text, 0.0}, now});
  if (entries_.size() > kMostNotices) entries_.erase(entries_.begin());
}

void NoticeList::dismiss(std::uint64_t id) {
  std::erase_if(entries_, [&](const Entry& entry) { return entry.notice.id == id; });
}

std::vector<Notice> NoticeList::at(double now) const {
  std::vector<Notice> notices;
  for (const Entry& entry : entries_) {
    notices.push_back(entry.notice);
    notices.back().ageSeconds = now - entry.time;
  }
  return notices;
}

}  // namespace lightvane
