#pragma once
/// An animator's hand on a face: pins that are dragged or held, sliders, tags, undo and redo, one state.

#include <memory>
#include <optional>
#include <vector>

#include "mien/character/character.h"
#include "mien/character/pin.h"
#include "mien/character/pose.h"
#include "mien/pose/attenuate.h"
#include "mien/pose/mirror_pins.h"
#include "mien/pose/solve_pins.h"

namespace mien {

/// Gestures change the pose; each is one step of undo and redo, however many moves of the pointer it took. Pins hold what
/// they are at: a drag of one keeps the others, a slider takes all of them with it. The character must live as long.
class PoseSession {
 public:
  ///   throws  invalid_input: sizes of the pose that differ from the character's
  PoseSession(const Character& character, const RigPose& start, const SolvePinsOptions& options = {});
  ~PoseSession();
  PoseSession(PoseSession&&) noexcept;
  PoseSession& operator=(PoseSession&&) noexcept;

  const RigPose& pose() const;

  /// Holds a point where it is (its goal is not looked at).
  ///   returns  the pin's number
  ///   throws   invalid_input: as PinSolver for the pin
  int add_pin(const Pin& pin);
  ///   throws  invalid_input: no such pin; while it is dragged
  void remove_pin(int number);
  /// Where a pin is held or wanted, model space.
  Eigen::Vector3d pin_goal(int number) const;

  /// A drag: the pose at `begin_drag` is w0 until it ends. With a plane, the other side does the same.
  ///   throws  invalid_input: no such pin; a drag is on already
  void begin_drag(int number, const std::optional<MirrorPlane>& mirror = std::nullopt);
  ///   throws  invalid_input: no drag is on; a goal that is not finite
  const SolvePinsResult& drag_to(const Eigen::Vector3d& goal);
  void end_drag();     ///< keeps the result, as one change
  void cancel_drag();  ///< back to where it began
  /// The sliders that dragging a pin to `goal` would move, without doing it.
  std::vector<int> sliders_moved_by(int number, const Eigen::Vector3d& goal) const;

  /// One change; attenuated while there are tags. The pins go with the face.
  ///   throws  invalid_input: no such slider, a value that is not finite, while a drag is on
  void set_slider(int slider, double value);

  /// Tags these coordinates as they are now; replaces what was tagged.
  void set_tags(const std::vector<Tag>& tags, const AttenuateOptions& options = {});
  /// The pose stays as it is.
  void clear_tags();

  bool can_undo() const;
  bool can_redo() const;
  void undo();  ///< nothing if there is nothing
  void redo();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace mien
