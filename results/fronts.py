"""Work-precision diagrams: error against total time, with the Pareto front; `plot` draws with them."""


def points_of(rows):
    """(seconds, value) of each curve, by the level, where both are positive."""
    return [(row["t_total"], row["value"]) for row in sorted(rows, key=lambda r: r["level"])
            if row["t_total"] and row["value"] and row["value"] > 0]


def front_of(rows):
    """The points that no other one beats in time and error, by time."""
    front = []
    for seconds, value in sorted(points_of(rows)):
        if not front or value < front[-1][1]:
            front.append((seconds, value))
    return front


def draw_cases(axes, rows, plot):
    """Curves of all cases of a quantity, and their front behind them."""
    columns = ("method", "stencil", "cloud", "form", "solver")
    groups = plot.grouped(rows, *columns)
    labels = plot.labels_of(list(groups), columns)
    front = front_of(rows)
    axes.loglog(*zip(*front), color="#bbbbbb", linewidth=6, solid_capstyle="round", label="front", zorder=1)
    taken = {}
    for key, members in groups.items():
        points = points_of(members)
        if not points:
            continue
        lines = taken.setdefault(plot.base_name(key[0]), [])
        colour, marker = plot.method_style(key[0])
        lines.append(plot.line_style("".join(key), lines))
        axes.loglog(*zip(*points), color=colour, marker=marker, linestyle=lines[-1], linewidth=1.2, markersize=4,
                    label=labels[key], markerfacecolor=colour if len(lines) == 1 else "white")
    plot.format_log_axis(axes.xaxis, [row["t_total"] for row in rows if row["t_total"]])


def draw(rows, directory, plot):
    """A figure a problem and quantity; how many were drawn."""
    count = 0
    solved = [row for row in rows if row["status"] == "ok" and points_of([row])]
    for (study, problem, quantity), members in plot.grouped(solved, "study", "problem", "quantity").items():
        figure, axes = plot.plt.subplots(figsize=(6.4, 4.6))
        draw_cases(axes, members, plot)
        axes.set_xlabel("seconds in all stages")
        axes.set_ylabel(quantity)
        axes.set_title(problem)
        axes.legend(loc="upper left", bbox_to_anchor=(1.02, 1.0), borderaxespad=0.0, frameon=False)
        plot.save(figure, directory, "_".join(map(plot.slug, (study, problem, quantity))) + "_time")
        count += 1
    return count
