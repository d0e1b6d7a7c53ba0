#include "app/record_history.h"

#include <algorithm>
#include <utility>

namespace lightvane {

std::uint64_t RecordHistory::add(std::uint64_t from, Step step) {
  arrivals_[++last_] = {from, std::move(step)};
  return last_;
}

std::vector<std::uint64_t> RecordHistory::line(std::uint64_t state) const {
  std::vector<std::uint64_t> states = {state};
  for (auto found = arrivals_.find(state); found != arrivals_.end(); found = arrivals_.find(states.back()))
    states.push_back(found->second.from);
  return states;
}

std::vector<RecordHistory::Step> RecordHistory::way(std::uint64_t from, std::uint64_t to) const {
  std::vector<std::uint64_t> back = line(from);
  std::vector<std::uint64_t> forth = line(to);
  while (!back.empty() && !forth.empty() && back.back() == forth.back()) {
    back.pop_back();
    forth.pop_back();
  }
  std::vector<Step> steps;
  for (const std::uint64_t state : back) {
    if (const auto found = arrivals_.find(state); found != arrivals_.end())
      steps.push_back(found->second.step.inverse());
  }
  std::reverse(forth.begin(), forth.end());
  for (const std::uint64_t state : forth) {
    if (const auto found = arrivals_.find(state); found != arrivals_.end())
      steps.push_back(found->second.step);
  }
  return steps;
}

}  // namespace lightvane
