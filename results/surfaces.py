"""What of a cloud is drawn: the nodes on a plane, moved by their displacement, joined to a surface."""
import matplotlib.tri as tri
import numpy as np

from vtu import MapError, distances

AXES = "xyz"
ROUND_OFF = 1e-9  # of the extent: coordinates that differ by less are one
# Triangles have circumradii of 0.7 spacings on a grid, up to 1.8 on random nodes; those that close a
# hole have the radius of the hole or more, wherever their nodes lie on it.
WIDEST = 2.0
NEIGHBOURS = 4  # a cell's corner has as many neighbours a spacing away; a single one may be too close


def parsed_plane(text):
    """Axis and value of `y=0`."""
    axis, _, value = text.partition("=")
    try:
        if axis not in AXES or len(axis) != 1:
            raise ValueError
        number = float(value)
        if not np.isfinite(number):
            raise ValueError
    except ValueError:
        raise MapError(f"--plane {text}: give an axis and a number, as in --plane y=0") from None
    return AXES.index(axis), number


def on_plane(nodes, text):
    """The nodes next to a plane and the two axes that it shows.

    Of a cloud in layers it is the nearest layer. Of any other a node is taken when it lies within half
    the distance to its nearest neighbour: the nodes on the plane where there are some, else about one
    layer, as they are, which is the rougher the less the cloud is one in layers.
    """
    axis, value = parsed_plane(text)
    places = nodes.positions[:, axis]
    low, high = places.min(), places.max()
    tolerance = ROUND_OFF * (high - low)
    if not low - tolerance <= value <= high + tolerance:
        raise MapError(f"--plane {text}: misses the nodes; {AXES[axis]} runs from {low:g} to {high:g}")
    offsets = np.abs(places - value)
    if len(np.unique(np.round(places / tolerance))) <= len(places)**0.5:
        chosen = np.abs(places - places[offsets.argmin()]) <= tolerance
    else:
        chosen = offsets <= 0.5 * distances(nodes.positions, 1)
    if chosen.sum() < 3:
        raise MapError(f"--plane {text}: has {chosen.sum()} nodes next to it, and a section takes 3; name another")
    shown = [a for a in range(3) if a != axis]
    return nodes.at(chosen), shown


def displacement(nodes, path):
    """(N, 3) the displacement in a file."""
    moved = nodes.arrays.get("displacement")
    if moved is None or moved.shape != (len(nodes.positions), 3):
        raise MapError(f"--warp: '{path}' holds no array 'displacement' of three components; problems of "
                       "elasticity write it")
    return np.nan_to_num(moved)


def surface(places, values=None):
    """Triangles between nodes (N, 2) but across holes and where a value is missing; None for none."""
    try:
        triangles = tri.Triangulation(*places.T)
    except (RuntimeError, ValueError):  # fewer than three nodes, or all on a line
        return None
    corners = places[triangles.triangles]
    a, b, c = (np.linalg.norm(corners[:, i] - corners[:, i - 1], axis=1) for i in range(3))
    (x1, y1), (x2, y2) = (corners[:, 1] - corners[:, 0]).T, (corners[:, 2] - corners[:, 0]).T
    area = np.abs(x1 * y2 - x2 * y1) / 2
    flat = np.column_stack([places, np.zeros(len(places))])
    spacing = distances(flat, min(NEIGHBOURS, len(places) - 1))[triangles.triangles].mean(axis=1)
    masked = a * b * c > 4 * area * WIDEST * spacing  # a b c / (4 area) is the circumradius
    if values is not None:
        masked |= ~np.isfinite(values)[triangles.triangles].all(axis=1)
    if masked.all():
        return None
    triangles.set_mask(masked)
    return triangles


def outline(triangles):
    """Pairs of nodes: the edges of one triangle alone, (edges, 2)."""
    kept = triangles.get_masked_triangles()
    edges = np.sort(np.vstack([kept[:, [0, 1]], kept[:, [1, 2]], kept[:, [2, 0]]]), axis=1)
    unique, counts = np.unique(edges, axis=0, return_counts=True)
    return unique[counts == 1]
