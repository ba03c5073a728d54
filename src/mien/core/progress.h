#pragma once
/// How long work tells a watcher where it is, and asks whether to go on.

#include <functional>
#include <string_view>

namespace mien {

/// Called with the step's name and the fraction done in [0, 1], from the thread that runs the operation.
/// Returning false cancels: the operation throws Error of kind cancelled and leaves its inputs as they were.
/// An empty function is fine: nothing is reported.
using Progress = std::function<bool(std::string_view step, double fraction)>;

/// Reports to `progress` when there is one; throws Error (cancelled) when it says stop.
void report_progress(const Progress& progress, std::string_view step, double fraction);

}  // namespace mien
