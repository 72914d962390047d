"""Figures of a table of the study dispersion: relations in 1D, maps and curves by direction in 2D."""
import os

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend must be chosen first)
import numpy as np  # noqa: E402
from matplotlib.colors import LogNorm  # noqa: E402
from matplotlib.ticker import MaxNLocator  # noqa: E402

CASE = ("method", "stencil", "form")
ERRORS = LogNorm(1e-4, 1.0)  # of the colours of maps: below lies what no one sees, above is useless
TOLERANCE = 0.01  # the error that points per wavelength are counted for
LEAST_ANGLES, LEAST_WAVES = 6, 6  # that make a map
NO_LOSS = 1e-6  # relative dissipation below this is round-off
PANEL = 2.3  # inches, side of a map
GREY = "#777777"


def number(text):
    return float(text) if text else np.nan


def curves(rows, quantity, against):
    """Points (x, value) by case, in the order of the table."""
    found = {}
    for row in rows:
        if row["quantity"] == quantity:
            value = np.nan if row["value"] is None else row["value"]
            found.setdefault(tuple(row[c] for c in CASE), []).append((number(row[against]), value))
    return {key: np.array(sorted(points)) for key, points in found.items()}


def style_of(key, taken, tools):
    """Colour and line of a case: variants of a method get other colours, and lines that show both where
    curves cover each other; so do methods that share a colour."""
    name = tools.base_name(key[0])
    colour, _ = tools.method_style(key[0])
    if any(other == name for other, _ in taken):
        colour = tools.LINE_COLOURS[len(taken) % len(tools.LINE_COLOURS)]
    rivals = sum(name == other or colour == shade for other, shade in taken)
    taken.append((name, colour))
    return {"color": colour, "linestyle": tools.LINES[rivals % len(tools.LINES)]}


def draw_relation(rows, directory, tools):
    """Frequency, group velocity and dissipation against the wavenumber."""
    phase, group, loss = (curves(rows, q, "wave") for q in ("phase_velocity", "group_velocity", "dissipation"))
    if not any(len(points) > 2 for points in phase.values()):
        return 0
    labels = tools.labels_of(list(phase), CASE)
    lossy = any(np.nanmax(np.abs(points[:, 1]), initial=0.0) > NO_LOSS for points in loss.values())
    figure, panels = plt.subplots(1, 3 if lossy else 2, figsize=(11.4 if lossy else 8.0, 3.6),
                                  constrained_layout=True)
    panels[0].plot([0, 1], [0, 1], color=GREY, linewidth=1.0, label="exact")
    panels[1].axhline(1.0, color=GREY, linewidth=1.0)
    taken = []
    for key, points in phase.items():
        style = {"linewidth": 1.4, **style_of(key, taken, tools)}
        x = points[:, 0]
        panels[0].plot(np.append(0, x), np.append(0, x * points[:, 1]), label=labels[key], **style)
        panels[1].plot(*group[key].T, **style)
        if lossy:
            panels[2].plot(*loss[key].T, **style)
    titles = ["frequency $\\omega h / (\\pi c)$", "group velocity / $c$", "Im $\\omega$ / exact $\\omega$"]
    for axes, title in zip(panels, titles):
        axes.set_xlabel("wavenumber $\\xi h / \\pi$")
        axes.set_title(title)
        axes.set_xlim(0, 1)
    handles, texts = panels[0].get_legend_handles_labels()
    figure.legend(handles, texts, loc="upper left", bbox_to_anchor=(1.01, 0.95), frameon=False)
    first = rows[0]
    figure.suptitle(f"{first['problem']}, cloud {first['cloud']}, level {first['level']:g}, time {first['time']}",
                    fontsize=9)
    tools.save(figure, directory, name_of(first, "relation", tools))
    return 1


def name_of(row, kind, tools):
    return "_".join([*(tools.slug(row[c]) for c in ("study", "problem", "cloud")), kind])


def whole_turn(angles, values):
    """Angles of a half-turn and what belongs to them, repeated over the other half, and closed."""
    angles = np.concatenate([angles, angles + 180, [360 + angles[0]]])
    return np.radians(angles), np.concatenate([values, values, values[..., :1, :]], axis=-2)


def map_of(rows):
    """Angles, waves and the error of the phase velocity, (angles, waves)."""
    errors = {(number(r["direction"]), number(r["wave"])): r["value"] for r in rows}
    angles, waves = (np.array(sorted({key[i] for key in errors})) for i in (0, 1))
    grid = np.array([[errors.get((a, w)) for w in waves] for a in angles], dtype=float)
    return angles, waves, np.abs(grid - 1)


def draw_maps(rows, directory, tools):
    """Error of the phase velocity by direction (angle) and wavenumber (radius), a row per branch."""
    chosen = [r for r in rows if r["quantity"] == "phase_velocity"]
    if len({r["direction"] for r in chosen}) < LEAST_ANGLES or len({r["wave"] for r in chosen}) < LEAST_WAVES:
        return 0
    cases = list(dict.fromkeys(tuple(r[c] for c in CASE) for r in chosen))
    branches = list(dict.fromkeys(r["branch"] for r in chosen))
    labels = tools.labels_of(cases, CASE)
    figure, grid = plt.subplots(len(branches), len(cases), subplot_kw={"projection": "polar"}, squeeze=False,
                                figsize=(PANEL * len(cases) + 0.9, PANEL * len(branches) + 0.8),
                                constrained_layout=True)
    for i, branch in enumerate(branches):
        for j, case in enumerate(cases):
            axes = grid[i, j]
            angles, waves, errors = map_of([r for r in chosen if r["branch"] == branch
                                            and tuple(r[c] for c in CASE) == case])
            waves = np.append(0, waves)  # where errors vanish
            errors = np.insert(np.maximum(errors, ERRORS.vmin), 0, ERRORS.vmin, axis=1)
            theta, values = whole_turn(angles, errors)
            picture = axes.contourf(theta, waves, values.T, levels=np.logspace(-4, 0, 17), norm=ERRORS,
                                    cmap="viridis", extend="both")
            axes.contour(theta, waves, values.T, levels=[TOLERANCE], colors="white", linewidths=1.2)
            axes.set_ylim(0, 1)
            axes.set_xticklabels([])
            axes.yaxis.set_major_locator(MaxNLocator(2))
            axes.tick_params(labelsize=6)
            axes.grid(linewidth=0.3)
            if i == 0:
                axes.set_title(labels[case].replace(", ", "\n"), fontsize=8)
            if j == 0:
                axes.set_ylabel(branch, labelpad=18, rotation=0, fontsize=11)
    bar = figure.colorbar(picture, ax=grid, shrink=0.8, ticks=[1e-4, 1e-3, 1e-2, 1e-1, 1])
    bar.set_label("error of the phase velocity (white: 1 %)")
    first = chosen[0]
    figure.suptitle(f"{first['problem']}, cloud {first['cloud']}: radius $\\xi h / \\pi$, angle of the wave",
                    fontsize=9)
    path = os.path.join(directory, name_of(first, "directions", tools) + ".png")  # as SVG it is large
    figure.savefig(path, dpi=150, bbox_inches="tight", metadata={"Software": None})
    print(path)
    plt.close(figure)
    return 1


def draw_points(rows, directory, tools):
    """Points per wavelength that an error of 1 % takes, by direction, a panel per branch."""
    chosen = [r for r in rows if r["quantity"] == "points_per_wavelength"]
    if len({r["direction"] for r in chosen}) < LEAST_ANGLES:
        return 0
    branches = list(dict.fromkeys(r["branch"] for r in chosen))
    figure, panels = plt.subplots(1, len(branches), subplot_kw={"projection": "polar"}, squeeze=False,
                                  figsize=(3.4 * len(branches), 3.6), constrained_layout=True)
    for axes, branch in zip(panels[0], branches):
        found = curves([r for r in chosen if r["branch"] == branch], "points_per_wavelength", "direction")
        labels = tools.labels_of(list(found), CASE)
        taken = []
        for key, points in found.items():
            theta, values = whole_turn(points[:, 0], points[:, 1:])
            axes.plot(theta, values[:, 0], linewidth=1.3, label=labels[key], **style_of(key, taken, tools))
        axes.set_title(f"branch {branch}")
        axes.set_ylim(bottom=0)
        axes.set_xticklabels([])
    figure.legend(*panels[0, 0].get_legend_handles_labels(), loc="upper left", bbox_to_anchor=(1.01, 0.95),
                  frameon=False)
    first = chosen[0]
    figure.suptitle(f"{first['problem']}, cloud {first['cloud']}: points per wavelength for 1 %", fontsize=9)
    tools.save(figure, directory, name_of(first, "points", tools))
    return 1


def draw(rows, directory, tools):
    """All figures of a table, one set per problem and cloud, of the finest level; the number drawn."""
    count = 0
    finest = max(r["level"] for r in rows)
    good = [r for r in rows if r["status"] == "ok" and r["level"] == finest]
    for members in tools.grouped(good, "study", "problem", "cloud").values():
        directions = {r["direction"] for r in members if r["wave"] and r["branch"] != "all"}
        if directions == {"0"} and {r["branch"] for r in members} <= {"P", "all"}:
            count += draw_relation(members, directory, tools)
        elif not any(":" in direction for direction in directions):
            count += draw_maps(members, directory, tools) + draw_points(members, directory, tools)
    return count
