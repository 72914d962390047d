"""Maps of nodes coloured by their numbers, from the .vtu files that a study writes with --vtk."""
import os
import re
import textwrap

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend must be chosen first)
import numpy as np  # noqa: E402
from matplotlib.collections import LineCollection  # noqa: E402
from matplotlib.colors import LogNorm, Normalize, TwoSlopeNorm  # noqa: E402

import surfaces  # noqa: E402
from vtu import MapError, distances, read_vtu  # noqa: E402

# Sizes without a sign, which are drawn on a logarithmic scale when they span this many decades.
MAGNITUDES = re.compile(r"condition_|lebesgue_|residual$|.*error$")
DECADES_FOR_LOG = 1.5
DECADES_OF_ERRORS = 5  # below lies what boundary rows prescribe, down to round-off
SIGNS = re.compile(r"laplacian_centre")  # numbers whose sign alone says something, however small
LOPSIDED = 0.2  # share of the longer side above which numbers of both signs get a scale about zero
ROUND_OFF = 1e-9  # numbers that differ by less, relatively, are one number
TITLE_WIDTH = 80  # characters
MOST_LEVELS = 12  # whole numbers that take no more values than this get a tick each
LONG_SIDE = 5.0  # inches
UNDEFORMED = "#CCCCCC"
RC = {"font.size": 9, "axes.titlesize": 8, "axes.axisbelow": True}


def scale_of(name, values):
    """Colour scale and map: logarithmic over decades, diverging about zero where signs differ."""
    low, high = values.min(), values.max()
    if high - low <= ROUND_OFF * max(abs(low), abs(high)):
        margin = max(abs(high), 1.0) / 2  # one colour, not a picture of the last digits
        return Normalize(low - margin, low + margin), "viridis"
    if low < 0 < high and SIGNS.match(name):
        return TwoSlopeNorm(0.0, low, high), "RdBu_r"
    if min(-low, high) > LOPSIDED * max(-low, high):
        return Normalize(-max(-low, high), max(-low, high)), "RdBu_r"
    positive = values[values > 0]
    if MAGNITUDES.match(name) and len(positive) and high / positive.min() > 10**DECADES_FOR_LOG:
        least = high / 10**DECADES_OF_ERRORS if name.endswith("error") else 0.0
        return LogNorm(max(positive.min(), least), high), "viridis"
    return Normalize(low, high), "viridis"


def dimension_of(positions):
    extents = np.ptp(positions, axis=0)
    return max(1, int(np.max(np.nonzero(extents > 0), initial=-1)) + 1)


def marker_sizes(axes, places):
    """Areas of markers, in points squared, that nearly touch their neighbours' in a plane."""
    axes.update_datalim(places)
    axes.autoscale_view()
    axes.figure.draw_without_rendering()
    scale = np.ptp(axes.get_window_extent().intervalx) / np.ptp(axes.get_xlim())
    points = scale * 72 / axes.figure.dpi
    flat = np.column_stack([places, np.zeros(len(places))])
    return np.maximum(0.5, points * distances(flat, 1))**2


def add_colour_bar(axes, drawn, name, values, norm):
    """A colour bar; a few whole numbers get a tick each."""
    whole = np.unique(values)
    few = len(whole) <= MOST_LEVELS and np.all(whole == np.round(whole)) and norm.vmin >= 0
    axes.figure.colorbar(drawn, ax=axes, label=name, shrink=0.85, pad=0.12 if axes.name == "3d" else 0.05,
                         extend="min" if values.min() < norm.vmin else "neither",
                         ticks=whole if few and not isinstance(norm, LogNorm) else None)


def draw_coloured(axes, places, values, scale):
    """Nodes (N, 2 or 3) coloured by finite numbers; infinite ones are red crosses, missing ones grey.

    Returns what a colour bar takes, if there is a finite number.
    """
    sizes = marker_sizes(axes, places) if places.shape[1] == 2 else np.full(len(values), 12.0)
    finite, infinite = np.isfinite(values), np.isinf(values)
    drawn = None
    if finite.any():
        norm, colours = scale
        shown = np.maximum(values, norm.vmin) if isinstance(norm, LogNorm) else values
        drawn = axes.scatter(*places[finite].T, c=shown[finite], norm=norm, cmap=colours, s=sizes[finite],
                             linewidths=0)
    for chosen, colour, marker, label in ((infinite, "#CC0000", "x", "infinite"),
                                          (np.isnan(values), "#AAAAAA", ".", "none")):
        if chosen.any():
            axes.scatter(*places[chosen].T, c=colour, marker=marker, s=np.maximum(sizes[chosen], 12),
                         label=f"{label}: {chosen.sum()}")
    if not finite.all():
        axes.legend(loc="upper left", bbox_to_anchor=(0, -0.1), frameon=False, ncols=2)
    return drawn


def draw_filled(axes, places, values, name, before, scale):
    """A surface between nodes (N, 2) coloured by their numbers, linear between them.

    Triangles are those of the nodes where they were `before` they were moved. Returns what a colour bar takes.
    """
    triangles = surfaces.surface(before, values)
    if triangles is None:
        raise MapError(f"--array {name}: the nodes that have a number span no surface; draw it without --filled "
                       "and --plane")
    norm, colours = scale
    shown = np.where(np.isfinite(values), np.maximum(values, norm.vmin), norm.vmin)
    triangles.x, triangles.y = places.T
    drawn = axes.tripcolor(triangles, shown, norm=norm, cmap=colours, shading="gouraud", rasterized=True)
    axes.update_datalim(places)
    axes.autoscale_view()
    return drawn


def draw_undeformed(axes, places):
    """In grey: the outline of the nodes in a plane, or the nodes in space."""
    triangles = surfaces.surface(places) if places.shape[1] == 2 else None
    if triangles is None:
        axes.scatter(*places.T, c=UNDEFORMED, s=2, linewidths=0)
        return
    axes.add_collection(LineCollection(places[surfaces.outline(triangles)], colors="#888888", linewidths=0.8))
    axes.update_datalim(places)


def draw_line(axes, positions, values, name, scale, exact=None):
    """Numbers over the nodes of a line, and below them those that are exact."""
    order = np.argsort(positions[:, 0])
    positions, values = positions[order], values[order]
    finite = np.isfinite(values)
    if exact is not None:
        axes.plot(positions[:, 0], exact[order], "-", color="#D55E00", linewidth=2.5, alpha=0.5, label="exact")
        axes.legend()
    axes.plot(positions[finite, 0], values[finite], "o-", color="#0072B2", markersize=3, linewidth=0.8)
    if scale is not None and isinstance(scale[0], LogNorm):
        axes.set_yscale("log", nonpositive="mask")
    for x in positions[np.isinf(values), 0]:
        axes.axvline(x, color="#CC0000", linewidth=0.8)
    axes.set_xlabel("x")
    axes.set_ylabel(name)


class View:
    """What of a map is drawn: its nodes, perhaps those on a plane, perhaps moved."""

    def __init__(self, path, options):
        self.nodes = read_vtu(path)
        self.title, self.suffix = self.nodes.title, ""
        dimension = dimension_of(self.nodes.positions)
        self.shown = list(range(dimension))
        if options.plane:
            if dimension < 3:
                raise MapError(f"--plane {options.plane}: '{path}' has {dimension} dimensions; only 3D is cut")
            extent = np.ptp(self.nodes.positions)
            self.nodes, self.shown = surfaces.on_plane(self.nodes, options.plane)
            axis, value = surfaces.parsed_plane(options.plane)
            exact = np.ptp(np.append(self.nodes.positions[:, axis], value)) <= surfaces.ROUND_OFF * extent
            next_to = "" if exact else "nodes next to "
            self.add(f"{next_to}plane\N{NO-BREAK SPACE}{options.plane}", "plane-" + options.plane.replace("=", ""))
        self.filled = options.filled or bool(options.plane)
        if self.filled and len(self.shown) != 2:
            raise MapError(f"--filled: '{path}' has {dimension} dimensions; fill 2D maps, or cut 3D ones with --plane")
        self.before = self.after = self.nodes.positions[:, self.shown]
        if options.warp is not None:
            if dimension == 1 or not np.isfinite(options.warp):
                raise MapError(f"--warp {options.warp:g}: give a number, of a map in 2D or 3D")
            moved = self.before + options.warp * surfaces.displacement(self.nodes, path)[:, self.shown]
            self.after = moved
            self.add(f"displacements times\N{NO-BREAK SPACE}{options.warp:g}", f"warp-{options.warp:g}")
        self.warped = options.warp is not None

    def add(self, words, suffix):
        self.title += ", " + words
        self.suffix += "_" + suffix

    def numbers(self, name):
        """(N) an array, of vectors their lengths, and what it is called."""
        values = self.nodes.arrays[name]
        return (values, name) if values.ndim == 1 else (np.linalg.norm(values, axis=1), f"|{name}|")

    def figure_size(self):
        """Inches; that of a plane follows its shape."""
        if len(self.shown) != 2:
            return LONG_SIDE + 1, LONG_SIDE * 0.75 + 0.7
        everything = np.vstack([self.before, self.after])
        wide, high = np.ptp(everything, axis=0)
        return LONG_SIDE + 1, LONG_SIDE * (np.clip(high / wide, 0.3, 2) if wide > 0 else 0.75) + 0.7

    def scale(self, name):
        """Colour scale and map of an array; none without a finite number."""
        values = self.numbers(name)[0]
        finite = values[np.isfinite(values)]
        return scale_of(name, finite) if len(finite) else None

    def draw_on(self, axes, name, scale):
        """Draws an array; returns what a colour bar takes, if there is any colour."""
        values, label = self.numbers(name)
        drawn = None
        if len(self.shown) == 1:
            draw_line(axes, self.nodes.positions, values, label, scale, self.nodes.arrays.get(f"{name}_exact"))
        else:
            if len(self.shown) == 2:
                axes.set_aspect("equal")
            if self.warped:
                draw_undeformed(axes, self.before)
            if self.filled:
                drawn = draw_filled(axes, self.after, values, label, self.before, scale)
            else:
                drawn = draw_coloured(axes, self.after, values, scale)
        return drawn

    def projection(self):
        return "3d" if len(self.shown) == 3 else None

    def draw(self, name, scale=None):
        """A figure of one array, on a scale of its own unless one is given."""
        scale = scale or self.scale(name)
        figure = plt.figure(figsize=self.figure_size())
        axes = figure.add_subplot(projection=self.projection())
        drawn = self.draw_on(axes, name, scale)
        values, label = self.numbers(name)
        if drawn is not None:
            add_colour_bar(axes, drawn, label, values[np.isfinite(values)], scale[0])
        if len(self.shown) > 1:
            if len(self.shown) == 3:
                axes.set_aspect("equal")  # in space it fixes the limits to what is drawn already
            for place, axis in zip("xyz", self.shown):
                getattr(axes, f"set_{place}label")(surfaces.AXES[axis])
        axes.set_title(textwrap.fill(self.title, TITLE_WIDTH))
        return figure


def save(figure, target):
    figure.savefig(target, dpi=150, bbox_inches="tight", metadata={"Software": None})
    plt.close(figure)
    print(target)


def chosen_arrays(view, path, options):
    """The names of the arrays to draw: every one unless some are asked for."""
    known = view.nodes.arrays
    for name in options.array or []:
        if name not in known:
            raise MapError(f"--array {name}: not in '{path}'; known: {', '.join(known)}")
    if not known:
        raise MapError(f"'{path}' holds nodes but no numbers to draw")
    return options.array or known


def draw(path, directory, options):
    """Draws one PNG for each array chosen (every array when none is) and prints their names."""
    view = View(path, options)
    stem = os.path.splitext(os.path.basename(path))[0]
    with plt.rc_context(RC):
        for name in chosen_arrays(view, path, options):
            save(view.draw(name), os.path.join(directory, f"{stem}_{name}{view.suffix}.png"))
