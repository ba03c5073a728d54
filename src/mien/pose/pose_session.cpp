#include "mien/pose/pose_session.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "mien/character/sliders.h"
#include "mien/core/error.h"
#include "mien/pose/detail/pin_checks.h"

namespace mien {

struct PoseSession::Impl {
  struct State {
    RigPose pose;
    std::map<int, Pin> pins;  // goals absolute
    SliderValues wished;      // what the sliders say; the pose's own while nothing is tagged
  };
  struct Dragging {
    int number, active;       // the pin, and its place among the solver's
    std::optional<int> twin;  // of its mirror image
    MirrorPlane plane;
    PinSolver solver;
    State before;
  };

  Impl(const Character& given, const RigPose& start, const SolvePinsOptions& given_options)
      : character(given), options(given_options), now{start, {}, start.sliders} {
    detail::check_start(character, start);
  }

  Pin& pin(int number);
  void follow_face(State& state) const;
  void change(State next);
  Dragging begin(int number, const std::optional<MirrorPlane>& mirror) const;
  const SolvePinsResult& move(Dragging& drag, const Eigen::Vector3d& goal) const;

  const Character& character;
  SolvePinsOptions options;
  State now;
  std::vector<State> past, future;
  int next_pin = 0;
  std::optional<Dragging> drag;
  std::optional<Attenuator> attenuator;
};

Pin& PoseSession::Impl::pin(int number) {
  const auto found = now.pins.find(number);
  if (found == now.pins.end())
    throw invalid_input(detail::pin_name(static_cast<std::size_t>(std::max(number, 0))), "does not exist",
                        "one that add_pin gave");
  return found->second;
}

/// Pins hold what they are at.
void PoseSession::Impl::follow_face(State& state) const {
  if (state.pins.empty()) return;
  std::vector<Pin> pins;
  for (auto& [number, pin] : state.pins) {
    pin.goal.setZero();
    pin.goal_is_move = true;
    pins.push_back(pin);
  }
  const PinSolver solver(character, pins, state.pose, options);
  Eigen::Index row = 0;
  for (auto& [number, pin] : state.pins) {
    pin.goal = solver.start_positions().row(row++).transpose();
    pin.goal_is_move = false;
  }
}

void PoseSession::Impl::change(State next) {
  past.push_back(std::move(now));
  future.clear();
  now = std::move(next);
}

PoseSession::Impl::Dragging PoseSession::Impl::begin(int number,
                                                     const std::optional<MirrorPlane>& mirror) const {
  std::vector<Pin> pins;
  int active = 0;
  for (const auto& [other, pin] : now.pins) {
    if (other == number) active = static_cast<int>(pins.size());
    pins.push_back(pin);
  }
  std::optional<int> twin;
  if (mirror) {
    const std::vector<Pin> both = mirror_pins(character, {pins[static_cast<std::size_t>(active)]}, *mirror);
    if (both.size() == 2) {
      twin = static_cast<int>(pins.size());
      pins.push_back(both[1]);
    }
  }
  return {number, active, twin, mirror.value_or(MirrorPlane{}), PinSolver(character, pins, now.pose, options),
          now};
}

const SolvePinsResult& PoseSession::Impl::move(Dragging& dragging, const Eigen::Vector3d& goal) const {
  dragging.solver.set_goal(dragging.active, goal);
  if (dragging.twin) dragging.solver.set_goal(*dragging.twin, dragging.plane.mirrored(goal));
  return dragging.solver.solve();
}

PoseSession::PoseSession(const Character& character, const RigPose& start, const SolvePinsOptions& options)
    : impl_(std::make_unique<Impl>(character, start, options)) {}
PoseSession::~PoseSession() = default;
PoseSession::PoseSession(PoseSession&&) noexcept = default;
PoseSession& PoseSession::operator=(PoseSession&&) noexcept = default;

const RigPose& PoseSession::pose() const {
  return impl_->now.pose;
}

int PoseSession::add_pin(const Pin& pin) {
  Impl::State next = impl_->now;
  next.pins.emplace(impl_->next_pin, pin);
  impl_->follow_face(next);
  impl_->now = std::move(next);
  return impl_->next_pin++;
}

void PoseSession::remove_pin(int number) {
  impl_->pin(number);
  if (impl_->drag) throw invalid_input("pins", "cannot go while a drag is on", "end_drag first");
  impl_->now.pins.erase(number);
}

Eigen::Vector3d PoseSession::pin_goal(int number) const {
  return impl_->pin(number).goal;
}

void PoseSession::begin_drag(int number, const std::optional<MirrorPlane>& mirror) {
  impl_->pin(number);
  if (impl_->drag) throw invalid_input("drag", "is on already", "end_drag or cancel_drag first");
  impl_->drag.emplace(impl_->begin(number, mirror));
}

const SolvePinsResult& PoseSession::drag_to(const Eigen::Vector3d& goal) {
  if (!impl_->drag) throw invalid_input("drag", "is not on", "begin_drag first");
  const SolvePinsResult& result = impl_->move(*impl_->drag, goal);
  impl_->now.pose = result.pose;
  impl_->now.wished = result.pose.sliders;
  impl_->pin(impl_->drag->number).goal = goal;
  return result;
}

void PoseSession::end_drag() {
  if (!impl_->drag) return;
  Impl::State after = impl_->now;
  impl_->now = std::move(impl_->drag->before);
  impl_->drag.reset();
  impl_->change(std::move(after));
}

void PoseSession::cancel_drag() {
  if (!impl_->drag) return;
  impl_->now = std::move(impl_->drag->before);
  impl_->drag.reset();
}

std::vector<int> PoseSession::sliders_moved_by(int number, const Eigen::Vector3d& goal) const {
  impl_->pin(number);
  Impl::Dragging trial = impl_->begin(number, std::nullopt);
  return impl_->move(trial, goal).moved;
}

void PoseSession::set_slider(int slider, double value) {
  const std::size_t count = impl_->character.sliders.size();
  if (slider < 0 || slider >= static_cast<int>(count))
    throw invalid_input("slider " + std::to_string(slider), "does not exist",
                        "there are " + std::to_string(count));
  if (!std::isfinite(value))
    throw invalid_input("slider " + impl_->character.sliders[slider].name, "is not finite",
                        "a finite number");
  if (impl_->drag) throw invalid_input("sliders", "cannot move while a drag is on", "end_drag first");
  Impl::State next = impl_->now;
  next.wished.values[slider] = value;
  next.pose.sliders = impl_->attenuator ? impl_->attenuator->attenuate(next.wished) : next.wished;
  impl_->follow_face(next);
  impl_->change(std::move(next));
}

void PoseSession::set_tags(const std::vector<Tag>& tags, const AttenuateOptions& options) {
  Attenuator attenuator(impl_->character, impl_->now.pose, options);
  for (const Tag& tag : tags) attenuator.add_tag(tag);
  impl_->attenuator = std::move(attenuator);
  impl_->now.wished = impl_->now.pose.sliders;
}

void PoseSession::clear_tags() {
  impl_->attenuator.reset();
  impl_->now.wished = impl_->now.pose.sliders;
}

bool PoseSession::can_undo() const {
  return !impl_->past.empty() && !impl_->drag;
}

bool PoseSession::can_redo() const {
  return !impl_->future.empty() && !impl_->drag;
}

void PoseSession::undo() {
  if (!can_undo()) return;
  impl_->future.push_back(std::move(impl_->now));
  impl_->now = std::move(impl_->past.back());
  impl_->past.pop_back();
}

void PoseSession::redo() {
  if (!can_redo()) return;
  impl_->past.push_back(std::move(impl_->now));
  impl_->now = std::move(impl_->future.back());
  impl_->future.pop_back();
}

}  // namespace mien
