#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/panels/workspace.h"

namespace lightvane {

/// What is shown of a picture. Where the picture lies on the screen, how far the vectors' growth is played
/// and how the window is laid out are not among it: undo leaves them alone.
struct Shown {
  PictureView view = PictureView::Beauty;
  bool smooth = false;
  ScaleOverride scale;
  OverlaySettings overlays;  ///< their growth apart, which is always the usual
  CompareMode compareMode = CompareMode::Off;
  CompareWith compareWith = CompareWith::Kept;

  bool operator==(const Shown&) const = default;
};

/// All that undo takes back.
struct Undoable {
  Setup setup;
  Shown shown;

  bool operator==(const Undoable&) const = default;
};
Undoable undoableOf(const Workspace& workspace);
/// Sets what of `workspace` is undoable; the rest stays.
void restore(const Undoable& state, Workspace& workspace);

/// What differs, in a few words: "ilv.n_min 4 -> 8", "3 parameters", "Camera", "Light 2", "Overlays". Empty
/// where nothing does.
std::string describeChange(const Setup& before, const Setup& after);
std::string describeChange(const Undoable& before, const Undoable& after);

/// Undo and redo. Told once a frame how all that is undoable stands, it finds the changes by itself. What
/// changes while one gesture lasts (a slider's drag, an orbit) is one step; so is a look through several
/// views with nothing done between. A step sets what it changed and no more, the setup or what is shown:
/// steps that were undone can be made again although something else is shown since.
class History {
 public:
  /// What a step costs are two Undoables: some kilobytes.
  static constexpr std::size_t kDefaultLimit = 500;

  explicit History(Undoable start, std::size_t limit = kDefaultLimit);

  /// `gesture`: a mouse button or a key is still held, so that more of the same may follow. `label` names the
  /// step, where what changed does not ("Orbit"); of several within a step the first counts.
  void update(const Undoable& now, bool gesture, std::string_view label = {});

  /// Forgets all steps: another scene.
  void reset(Undoable start);

  /// All that is undoable before the last step, or after the step undone last. Ends a gesture that is under
  /// way. Nothing where there is no such step.
  std::optional<Undoable> undo();
  std::optional<Undoable> redo();

  bool canUndo() const { return open_.has_value() || !steps_.empty(); }
  bool canRedo() const { return !undone_.empty(); }
  /// The label of the step that undo would take back, and that redo would make again; empty without one.
  std::string undoLabel() const;
  std::string redoLabel() const;

 private:
  struct Step {
    Undoable before;
    Undoable after;
    std::string label;

    bool ofSetup() const { return before.setup != after.setup; }
    bool ofShown() const { return before.shown != after.shown; }
    /// Nothing but the view differs.
    bool isLook() const;
  };

  void close();
  /// Of what the step changed.
  void take(const Step& step, const Undoable& state);

  std::size_t limit_;
  Undoable current_;
  std::optional<Step> open_;  ///< the gesture under way
  std::deque<Step> steps_;
  std::vector<Step> undone_;  ///< the last one is redone first
};

}  // namespace lightvane
