"""Runs in time: the frames of a collection (.pvd) that a study writes with --vtk and --frames."""
import os
import textwrap
import xml.etree.ElementTree

import numpy as np

import maps
from maps import plt
from vtu import MapError

PANEL = 3.4  # inches, its width
TITLE = 0.35  # inches, a panel's title and the gap above


def frames_of(path):
    """The (time, file) of a collection."""
    try:
        tree = xml.etree.ElementTree.parse(path)
        frames = [(float(entry.get("timestep")), entry.get("file")) for entry in tree.iter("DataSet")]
    except OSError as error:
        raise MapError(f"cannot read '{path}': {error.strerror}; give a file written with --vtk and --frames") from None
    except (xml.etree.ElementTree.ParseError, TypeError, ValueError) as error:
        raise MapError(f"'{path}' is not a .pvd collection written by a study: {error}") from None
    if not frames:
        raise MapError(f"'{path}' lists no frames")
    return [(time, os.path.join(os.path.dirname(path), file)) for time, file in frames]


def common_scale(views, name):
    """One scale for all frames; none without a finite number."""
    values = np.concatenate([view.numbers(name)[0] for view in views])
    finite = values[np.isfinite(values)]
    return maps.scale_of(name, finite) if len(finite) else None


def set_limits(axes, scale):
    """Gives a curve the range of all frames."""
    if scale is None:
        return
    low, high = scale[0].vmin, scale[0].vmax
    if axes.get_yscale() == "log":
        axes.set_ylim(low / 1.5, high * 1.5)
    else:
        margin = 0.05 * (high - low)
        axes.set_ylim(low - margin, high + margin)


def sheet_of(times, views, name):
    """A figure with a panel a frame, all of one scale."""
    wide, high = np.ptp(np.vstack([views[0].before, views[0].after]), axis=0) if len(views[0].shown) == 2 else (4, 3)
    height = PANEL * high / wide + TITLE
    columns = int(np.clip(round(np.sqrt(len(views) * height / PANEL)), 1, len(views)))
    rows = -(-len(views) // columns)
    figure, panels = plt.subplots(rows, columns, figsize=(PANEL * columns + 1, height * rows + 0.6), squeeze=False,
                                  sharex=True, sharey=True, layout="constrained",
                                  subplot_kw={"projection": views[0].projection()})
    scale, drawn = common_scale(views, name), None
    for axes, view, time in zip(panels.flat, views, times):
        drawn = view.draw_on(axes, name, scale) or drawn
        axes.set_title(f"t = {time:.4g}")
        axes.label_outer()
    for axes in panels.flat[len(views):]:
        axes.set_axis_off()
    for axes in panels.flat[max(0, len(views) - columns):len(views)]:
        axes.tick_params(labelbottom=True)  # also where no panel stands below
    if len(views[0].shown) == 1:
        set_limits(panels[0, 0], scale)
    label = views[0].numbers(name)[1]
    if drawn is not None:
        figure.colorbar(drawn, ax=panels, label=label, shrink=min(1.0, 4 / (height * rows)))
    figure.suptitle(textwrap.fill(views[0].title.rsplit("; t = ", 1)[0], maps.TITLE_WIDTH), fontsize=9)
    return figure


def draw(path, directory, options):
    """Draws the frames of a collection, every array on one scale: a PNG a frame, or one sheet."""
    frames = frames_of(path)
    views = [maps.View(file, options) for _, file in frames]
    stem = os.path.splitext(os.path.basename(path))[0]
    with plt.rc_context(maps.RC):
        for name in maps.chosen_arrays(views[0], path, options):
            if options.sheet:
                figure = sheet_of([time for time, _ in frames], views, name)
                maps.save(figure, os.path.join(directory, f"{stem}_{name}{views[0].suffix}_sheet.png"))
                continue
            scale = common_scale(views, name)
            for view, (_, file) in zip(views, frames):
                frame = os.path.splitext(os.path.basename(file))[0]
                figure = view.draw(name, scale)
                if len(view.shown) == 1:
                    set_limits(figure.axes[0], scale)
                maps.save(figure, os.path.join(directory, f"{frame}_{name}{view.suffix}.png"))
