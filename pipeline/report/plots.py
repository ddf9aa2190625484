"""The plots of the report, drawn by matplotlib into PNG bytes. Same figures, same bytes."""

import io
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

COLOURS = ("#8a94a3", "#c8643c", "#2f7f86", "#7a5ea8")


@dataclass(frozen=True, slots=True)
class Curve:
    """One line of a plot: points (n,), and optionally lower and upper ends of an interval at each."""

    label: str
    x: Sequence[float]
    y: Sequence[float]
    low: Sequence[float] | None = None
    high: Sequence[float] | None = None


def lines(curves: Sequence[Curve], *, title: str, x: str, y: str, y_range: tuple[float, float] | None = None, log: bool = False) -> bytes:
    """Draw curves with their intervals as error bars and return a PNG."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(6.4, 3.8), dpi=130, layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.subplots()
    for colour, curve in zip(COLOURS, curves, strict=False):
        axes.plot(curve.x, curve.y, "-o" if len(curve.x) < 40 else "-", color=colour, label=curve.label, markersize=4, linewidth=1.6)
        if curve.low is not None and curve.high is not None:
            axes.fill_between(curve.x, curve.low, curve.high, color=colour, alpha=0.15, linewidth=0)
    axes.set(title=title, xlabel=x, ylabel=y)
    if y_range:
        axes.set_ylim(*y_range)
    if log:
        axes.set_yscale("log")
    axes.grid(color="#e6eaef")
    axes.spines[["top", "right"]].set_visible(False)
    axes.legend(frameon=False)
    return _png(figure)


def bars(groups: Mapping[str, Sequence[float]], labels: Sequence[str], *, title: str, y: str) -> bytes:
    """Draw grouped bars, one group of bars per label, and return a PNG."""
    import numpy as np
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(max(6.4, 0.32 * len(labels)), 3.8), dpi=130, layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.subplots()
    width = 0.8 / len(groups)
    for i, (name, values) in enumerate(groups.items()):
        axes.bar(np.arange(len(labels)) + (i + 0.5) * width - 0.4, values, width, label=name, color=COLOURS[i])
    axes.set(title=title, ylabel=y)
    axes.set_xticks(range(len(labels)), labels, rotation=90 if len(labels) > 8 else 0, fontsize=8)
    axes.spines[["top", "right"]].set_visible(False)
    axes.legend(frameon=False)
    return _png(figure)


def _png(figure: object) -> bytes:
    buffer = io.BytesIO()
    # Without the metadata matplotlib would write its version; the bytes shall depend on the figures only.
    figure.savefig(buffer, format="png", metadata={"Software": None})  # type: ignore[attr-defined]
    return buffer.getvalue()
