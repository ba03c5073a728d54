#pragma once
/// One wire through the points of a sketch.

#include "mien/deform/bind_wires.h"
#include "mien/extract/draw_wires.h"

namespace mien::detail {

/// Its curve and range, without bindings.
///   throws  as draw_wires, but for what the range reaches
Wire draw_curve(const WireBinder& binder, const WireSketch& sketch);

/// With its bindings.
///   throws  as draw_wires
Wire draw_wire(const WireBinder& binder, const WireSketch& sketch);

}  // namespace mien::detail
