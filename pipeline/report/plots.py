"""The plots of the report, drawn by matplotlib into PNG bytes. Same figures, same bytes."""

import io
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

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
    figure, axes = _axes(6.4)
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
    return _png(figure, axes)


def bars(groups: Mapping[str, Sequence[float]], labels: Sequence[str], *, title: str, y: str) -> bytes:
    """Draw grouped bars, one group of bars per label, and return a PNG."""
    figure, axes = _axes(max(6.4, 0.32 * len(labels)))
    width = 0.8 / len(groups)
    for i, (name, values) in enumerate(groups.items()):
        axes.bar(np.arange(len(labels)) + (i + 0.5) * width - 0.4, values, width, label=name, color=COLOURS[i])
    axes.set(title=title, ylabel=y)
    axes.set_xticks(range(len(labels)), labels, rotation=90 if len(labels) > 8 else 0, fontsize=8)
    return _png(figure, axes)


def _axes(width: float) -> tuple[Any, Any]:
    """Return an empty figure so many inches wide, and its axes."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width, 3.8), dpi=130, layout="constrained")
    return figure, figure.subplots()


def _png(figure: Any, axes: Any) -> bytes:
    axes.spines[["top", "right"]].set_visible(False)
    axes.legend(frameon=False)
    buffer = io.BytesIO()
    # Without the metadata matplotlib would write its version; the bytes shall depend on the figures only.
    figure.savefig(buffer, format="png", metadata={"Software": None})
    return buffer.getvalue()
