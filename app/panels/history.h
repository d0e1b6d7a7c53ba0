#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/panels/workspace.h"

namespace lightvane {

/// What differs between two setups, in a few words: "ilv.n_min 4 -> 8", "3 parameters", "Camera", "Light 2".
/// Empty where nothing does.
std::string describeChange(const Setup& before, const Setup& after);

/// Undo and redo. Told once a frame how the setup stands, it finds the changes by itself; what changes while
/// one gesture lasts (a slider's drag, an orbit) is one step.
class History {
 public:
  /// What a step costs is a Setup: a few hundred bytes.
  static constexpr std::size_t kDefaultLimit = 500;

  explicit History(Setup start, std::size_t limit = kDefaultLimit);

  /// `gesture`: a mouse button or a key is still held, so that more of the same may follow. `label` names the
  /// step, where what changed does not ("Orbit"); of several within a step the first counts.
  void update(const Setup& now, bool gesture, std::string_view label = {});

  /// Forgets all steps: another scene.
  void reset(Setup start);

  /// The setup before the last step, or after the step undone last. Ends a gesture that is under way. Nothing
  /// where there is no such step.
  std::optional<Setup> undo();
  std::optional<Setup> redo();

  bool canUndo() const { return open_.has_value() || !steps_.empty(); }
  bool canRedo() const { return !undone_.empty(); }
  /// The label of the step that undo would take back, and that redo would make again; empty without one.
  std::string undoLabel() const;
  std::string redoLabel() const;

 private:
  struct Step {
    Setup before;
    Setup after;
    std::string label;
  };

  void close();

  std::size_t limit_;
  Setup current_;
  std::optional<Step> open_;  ///< the gesture under way
  std::deque<Step> steps_;
  std::vector<Step> undone_;  ///< the last one is redone first
};

}  // namespace lightvane
