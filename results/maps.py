"""Maps of nodes coloured by their numbers, from the .vtu files that a study writes with --vtk."""
import os
import re
import textwrap

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend must be chosen first)
import numpy as np  # noqa: E402
from matplotlib.colors import LogNorm, Normalize, TwoSlopeNorm  # noqa: E402

from vtu import MapError, distances, read_vtu  # noqa: E402

# Sizes without a sign, which are drawn on a logarithmic scale when they span this many decades.
MAGNITUDES = re.compile(r"condition_|lebesgue_|residual$|.*error$")
DECADES_FOR_LOG = 1.5
TITLE_WIDTH = 80  # characters
MOST_LEVELS = 12  # whole numbers that take no more values than this get a tick each
LONG_SIDE = 5.0  # inches
RC = {"font.size": 9, "axes.titlesize": 8, "axes.axisbelow": True}


def scale_of(name, values):
    """Colour scale and map: logarithmic over decades, diverging about zero where signs differ."""
    low, high = values.min(), values.max()
    if low < 0 < high:
        return TwoSlopeNorm(0.0, low, high), "RdBu_r"
    positive = values[values > 0]
    if MAGNITUDES.match(name) and len(positive) and high / positive.min() > 10**DECADES_FOR_LOG:
        return LogNorm(positive.min(), high), "viridis"
    return Normalize(low, high if high > low else low + 1), "viridis"


def dimension_of(positions):
    extents = np.ptp(positions, axis=0)
    return max(1, int(np.max(np.nonzero(extents > 0), initial=-1)) + 1)


def marker_sizes(axes, places):
    """Areas of markers, in points squared, that nearly touch their neighbours' in a plane."""
    axes.update_datalim(places.T)
    axes.autoscale_view()
    axes.figure.draw_without_rendering()
    scale = np.ptp(axes.get_window_extent().intervalx) / np.ptp(axes.get_xlim())
    points = scale * 72 / axes.figure.dpi
    return np.maximum(0.5, points * distances(np.column_stack([places.T, np.zeros(places.shape[1])]), 1))**2


def draw_coloured(figure, positions, values, name, dimension):
    """Nodes coloured by finite numbers; infinite ones are red crosses, missing ones grey."""
    axes = figure.add_subplot(projection="3d" if dimension == 3 else None)
    axes.set_aspect("equal")
    places = positions[:, :dimension].T
    sizes = marker_sizes(axes, places) if dimension == 2 else np.full(len(values), 12.0)
    finite, infinite = np.isfinite(values), np.isinf(values)
    if finite.any():
        norm, colours = scale_of(name, values[finite])
        shown = np.maximum(values, norm.vmin) if isinstance(norm, LogNorm) else values
        drawn = axes.scatter(*places[:, finite], c=shown[finite], norm=norm, cmap=colours, s=sizes[finite],
                             linewidths=0)
        whole = np.unique(values[finite])
        few = len(whole) <= MOST_LEVELS and np.all(whole == np.round(whole)) and norm.vmin >= 0
        figure.colorbar(drawn, ax=axes, label=name, shrink=0.85,
                        ticks=whole if few and not isinstance(norm, LogNorm) else None)
    for chosen, colour, marker, label in ((infinite, "#CC0000", "x", "infinite"),
                                          (np.isnan(values), "#AAAAAA", ".", "none")):
        if chosen.any():
            axes.scatter(*places[:, chosen], c=colour, marker=marker, s=np.maximum(sizes[chosen], 12),
                         label=f"{label}: {chosen.sum()}")
    if not finite.all():
        axes.legend(loc="upper left", bbox_to_anchor=(0, -0.1), frameon=False, ncols=2)
    for letter in "xyz"[:dimension]:
        getattr(axes, f"set_{letter}label")(letter)
    return axes


def draw_line(figure, positions, values, name):
    """Numbers over the nodes of a line."""
    axes = figure.add_subplot()
    order = np.argsort(positions[:, 0])
    positions, values = positions[order], values[order]
    finite = np.isfinite(values)
    axes.plot(positions[finite, 0], values[finite], "o-", color="#0072B2", markersize=3, linewidth=0.8)
    if finite.any() and isinstance(scale_of(name, values[finite])[0], LogNorm):
        axes.set_yscale("log", nonpositive="mask")
    for x in positions[np.isinf(values), 0]:
        axes.axvline(x, color="#CC0000", linewidth=0.8)
    axes.set_xlabel("x")
    axes.set_ylabel(name)
    return axes


def draw(path, directory, chosen):
    """Draws one PNG for each array chosen (every array when none is) and prints their names."""
    nodes = read_vtu(path)
    positions, arrays, title = nodes.positions, nodes.arrays, nodes.title
    for name in chosen or []:
        if name not in arrays:
            raise MapError(f"--array {name}: not in '{path}'; known: {', '.join(arrays)}")
    if not arrays:
        raise MapError(f"'{path}' holds nodes but no numbers to draw")
    dimension = dimension_of(positions)
    extents = np.ptp(positions[:, :2], axis=0)
    ratio = np.clip(extents[1] / extents[0], 0.3, 2) if dimension == 2 and extents[0] > 0 else 0.75
    with plt.rc_context(RC):
        for name in chosen or arrays:
            figure = plt.figure(figsize=(LONG_SIDE + 1, LONG_SIDE * ratio + 0.7))
            axes = (draw_line(figure, positions, arrays[name], name) if dimension == 1 else
                    draw_coloured(figure, positions, arrays[name], name, dimension))
            axes.set_title(textwrap.fill(title, TITLE_WIDTH))
            stem = os.path.splitext(os.path.basename(path))[0]
            target = os.path.join(directory, f"{stem}_{name}.png")
            figure.savefig(target, dpi=150, bbox_inches="tight", metadata={"Software": None})
            plt.close(figure)
            print(target)
