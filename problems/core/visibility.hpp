#pragma once

#include "problems/core/domain.hpp"

namespace strongpoint {

/// Whether the segment between two places stays in a domain, judged by its distance function alone,
/// which must not change faster than the position. A segment may touch or leave the domain at a
/// grazing angle only, as the chord between two nodes of a hole does: where it is outside, it is
/// outside by at most a tenth of that part's length (chords up to 0.8 radii), and it must come back
/// on the side that it left by. Contact shorter than a sixteenth of the segment between its ends
/// counts as crossing, so that slits without width block, and so do corners that are just touched.
/// Along a boundary the segment is looked at a second time, 1/64 of its length further inside,
/// where it meets slits whose mouth it passes. A place outside, such as a ghost node's, stands for
/// the nearest one of the boundary. In a convex domain all places see each other. Takes 1 distance
/// in the interior, some 20 from a boundary node and about 200 along a boundary.
template <int Dim>
bool sees(const Domain<Dim>& domain, const Point<Dim>& a, const Point<Dim>& b);

/// The same as a function of the two places; the domain must outlive it.
template <int Dim>
Sight<Dim> sight_in(const Domain<Dim>& domain);

}  // namespace strongpoint
