#pragma once

namespace strongpoint {

/// Registers the goals of the neighbour search: against nanoflann on nodes sorted along a Hilbert
/// curve, structure and queries of all nodes timed. `failed` is set when answers differ.
void register_neighbour_goals(bool& failed);

}  // namespace strongpoint
