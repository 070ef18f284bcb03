"""Style and output of the figures."""

import base64
import io
import re
import textwrap
from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple

import matplotlib

matplotlib.use("Agg")
import matplotlib.image
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import EngFormatter, LogLocator, NullFormatter, StrMethodFormatter
from PIL import Image

from ..program import ROOT, ExperimentError
from .statistics import Curve

COLOURS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000", "#8c6d31"]  # Okabe and Ito's
MARKERS = "osD^vPX*"
LARGEST_FILE = 300_000  # bytes
JPEG_QUALITY = 90  # of 100


class Quality(NamedTuple):
    resolution: int  # dots per inch
    palette: bool = False  # PNG: 256 colours, better for drawings and meshes than for photographs


# The first that makes a file small enough is used.
QUALITIES = [Quality(140), Quality(120), Quality(100), Quality(120, palette=True), Quality(90, palette=True)]

COUNTS = ("rays", "elements")
LABELS = {
    "seconds": "time of the solver [s]",
    "processor_seconds": "processor time [s]",
    "rays": "rays",
    "elements": "elements",
    "peak_mib": "peak memory [MiB]",
    "relative_mse_flat": "relative MSE, flat shading",
    "relative_mse_smooth": "relative MSE, smooth shading",
    "perceptual_distance_flat": "perceptual distance, flat shading",
    "perceptual_distance_smooth": "perceptual distance, smooth shading",
    "flip_smooth": "ꟻLIP, smooth shading",
}

plt.rcParams.update(
    {
        "font.size": 9,
        "axes.titlesize": 9,
        "axes.grid": True,
        "axes.axisbelow": True,
        "axes.spines.top": False,
        "axes.spines.right": False,
        "grid.color": "#dddddd",
        "grid.linewidth": 0.6,
        "legend.frameon": False,
        "lines.linewidth": 1.4,
        "lines.markersize": 4.5,
        "svg.hashsalt": "interflect",  # for identical bytes of identical figures
    }
)


def panels(
    columns: int, rows: int = 1, *, size: tuple[float, float] = (3.1, 2.9), share_y: bool = False
) -> tuple[Figure, list[Axes]]:
    """Creates a figure of panels, each `size` inches wide and high, listed row by row."""
    whole = (size[0] * columns, size[1] * rows)
    figure, axes = plt.subplots(rows, columns, figsize=whole, layout="constrained", squeeze=False, sharey=share_y)
    return figure, list(axes.flat)


def style_of(number: int) -> dict:
    again, index = divmod(number, len(COLOURS))  # a second round is dashed, with empty markers
    dashed = {"linestyle": "--", "markerfacecolor": "white"} if again else {}
    return {"color": COLOURS[index], "marker": MARKERS[index]} | dashed


def draw_curve(axes: Axes, c: Curve, label: str, number: int, **style) -> None:
    """Draws a line through the means and its confidence band."""
    style = style_of(number) | style
    axes.plot(c.x, c.y, label=label, **style)
    axes.fill_between(c.x, c.y / c.band, c.y * c.band, color=style["color"], alpha=0.18, linewidth=0)


def logarithmic(axes: Axes, x: str, y: str) -> None:
    """Sets both axes logarithmic, with names from LABELS for columns."""
    axes.set(xscale="log", yscale="log", xlabel=LABELS.get(x, x), ylabel=LABELS.get(y, y))
    for axis, quantity in ((axes.xaxis, x), (axes.yaxis, y)):
        low, high = axis.get_view_interval()
        axis.set_major_locator(LogLocator(subs=(1, 2, 5) if high < 60 * low else (1,)))
        axis.set_major_formatter(EngFormatter(sep="") if quantity in COUNTS else StrMethodFormatter("{x:g}"))
        axis.set_minor_formatter(NullFormatter())


def show_picture(axes: Axes, picture: str, title: str) -> None:
    """Shows a picture from `interflect render`; its path is as in the CSV."""
    path = ROOT / picture
    if not path.is_file():
        raise ExperimentError(f"the picture {picture} is gone: run the experiment again without --only-draw")
    axes.imshow(matplotlib.image.imread(path))
    axes.set_title(title)
    axes.axis("off")


def save(figure: Figure, folder: Path, name: str, caption: str) -> None:
    """Writes NAME.svg and NAME.png with the caption below, each within LARGEST_FILE."""
    folder.mkdir(parents=True, exist_ok=True)
    letters = int(figure.get_figwidth() * 15.5)
    caption = textwrap.fill(" ".join(caption.split()), letters)
    figure.text(0.01, -0.015, caption, va="top", fontsize=8.5, color="#333333")
    for path, write in ((folder / f"{name}.svg", _write_svg), (folder / f"{name}.png", _write_png)):
        sizes = (write(figure, path, quality) for quality in QUALITIES)
        if not any(size <= LARGEST_FILE for size in sizes):
            raise ExperimentError(f"{path} has more than {LARGEST_FILE} bytes even at the lowest resolution")
    plt.close(figure)


def _write_svg(figure: Figure, path: Path, quality: Quality) -> int:
    """Embeds pictures as JPEG, a quarter of the size of matplotlib's. Returns the file's size."""

    def as_jpeg(match: re.Match) -> str:
        data = io.BytesIO()
        Image.open(io.BytesIO(base64.b64decode(match[1]))).convert("RGB").save(data, "jpeg", quality=JPEG_QUALITY)
        return f"data:image/jpeg;base64,{base64.b64encode(data.getvalue()).decode()}"

    figure.savefig(path, dpi=quality.resolution, metadata={"Date": None}, bbox_inches="tight", facecolor="white")
    path.write_text(re.sub(r"data:image/png;base64,\s*([A-Za-z0-9+/=\s]+)", as_jpeg, path.read_text()))
    return path.stat().st_size


def _write_png(figure: Figure, path: Path, quality: Quality) -> int:
    figure.savefig(path, dpi=quality.resolution, metadata={"Software": None}, bbox_inches="tight", facecolor="white")
    if quality.palette:
        Image.open(path).convert("RGB").quantize(256).save(path, optimize=True)
    return path.stat().st_size


def shared_legend(figure: Figure, axes: Axes, columns: int) -> None:
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(handles, labels, loc="lower center", bbox_to_anchor=(0.5, 1), ncols=columns)


def guide(axes: Axes, x: Iterable[float], y: float, slope: float, label: str) -> None:
    """Draws a grey line with this slope from y at the first x."""
    x = np.asarray(list(x), dtype=float)
    axes.plot(x, y * (x / x[0]) ** slope, color="#999999", linestyle=":", linewidth=1.2, label=label)
