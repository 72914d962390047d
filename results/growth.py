"""How each stage's time, and memory, grow with the number of nodes; `plot` draws with them."""

MEMORY = "memory"


def curve(rows):
    """(nodes, seconds or MB) by the number of nodes."""
    return sorted((row["nodes"], row["value"]) for row in rows if row["value"] and row["value"] > 0)


def draw_stages(axes, rows, plot):
    """A curve a stage, and what is proportional to the number of nodes."""
    for place, (stage, members) in enumerate(plot.grouped(rows, "quantity").items()):
        points = curve(members)
        if points:
            exponent = members[-1].get("exponent")
            axes.loglog(*zip(*points), color=plot.LINE_COLOURS[place % len(plot.LINE_COLOURS)],
                        marker=plot.MARKERS[place % len(plot.MARKERS)], markersize=4, linewidth=1.3,
                        label=f"{stage[0]}, N^{float(exponent):.2f}" if exponent else stage[0])
    axes.set_ylabel("seconds")


def draw_guide(axes, rows):
    """A line of slope one down from the last point, as far as the numbers reach."""
    points = curve(rows)
    if len(points) > 1:
        (first, _), (last, value) = points[0], points[-1]
        first = max(first, last * min(v for _, v in points) / value)
        axes.loglog([first, last], [value * first / last, value], color="#999999", linestyle=":", linewidth=1)


def draw(rows, directory, plot):
    """A figure a problem, method, cloud and solver: stages beside memory; how many were drawn."""
    count = 0
    ok = [row for row in rows if row["status"] == "ok" and row["value"] is not None]
    columns = ("study", "problem", "method", "stencil", "cloud", "form", "solver")
    groups = {key: members for key, members in plot.grouped(ok, *columns).items()
              if len({row["nodes"] for row in members}) > 1}
    names = plot.labels_of([key[2:] for key in groups], columns[2:])
    for (study, problem, *case), members in groups.items():
        figure, (left, right) = plot.plt.subplots(1, 2, figsize=(8.4, 3.6), constrained_layout=True)
        draw_stages(left, [row for row in members if row["quantity"] != MEMORY], plot)
        draw_guide(left, [row for row in members if row["quantity"] == "total"])
        memory = [row for row in members if row["quantity"] == MEMORY]
        right.loglog(*zip(*curve(memory)), color=plot.LINE_COLOURS[0], marker="o", markersize=4)
        draw_guide(right, memory)
        right.set_ylabel("MB at most")
        for axes in (left, right):
            axes.set_xlabel("nodes")
        figure.suptitle(f"{problem}: {names[tuple(case)]}", fontsize=10)
        figure.legend(*left.get_legend_handles_labels(), loc="upper center", bbox_to_anchor=(0.5, 0.0), ncol=4,
                      frameon=False)
        plot.save(figure, directory, "_".join(map(plot.slug, (study, problem, *(part for part in case if part)))))
        count += 1
    return count
