"""Charts and maps: matplotlib, without a display."""

import base64
import dataclasses
import io
import re
import textwrap

import matplotlib
import numpy as np
from matplotlib import ticker
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import PolyCollection
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from PIL import Image

from .page import number

matplotlib.rcParams.update({"font.size": 9.5, "axes.grid": True, "grid.alpha": 0.3,
                            "axes.axisbelow": True, "lines.linewidth": 1.,
                            "legend.fontsize": 8.5, "axes.titlesize": 9.5,
                            "xtick.labelsize": 9., "ytick.labelsize": 9., "axes.spines.top": False,
                            "axes.spines.right": False, "svg.fonttype": "none",
                            "svg.hashsalt": "voussoir", "path.simplify_threshold": 0.2})

WIDTH = 5.0  # [in], so that the letters can be read on a phone
DPI = 220  # two pictures beside each other are printed smaller, and then have 300
FULL_DPI = 300


class Picture:
    """A picture in a page, of the kind "png" or "svg", with its caption."""

    def __init__(self, data, caption, name="", kind="png"):
        self.data, self.caption, self.name, self.kind = data, caption, name, kind

    @property
    def source(self):
        kind = {"png": "png", "svg": "svg+xml"}[self.kind]
        return f"data:image/{kind};base64," + base64.b64encode(self.data).decode()


def picture(figure, caption, name="", vector=True, dpi=None, shaded=False):
    """Draws a figure as vector graphics or else as pixels, with few colours, which
    makes the page smaller; the colours of a shaded figure are chosen with more care."""
    memory = io.BytesIO()
    if vector:
        figure.savefig(memory, format="svg", metadata={"Date": None, "Creator": None})
        # weasyprint does not support the shorthand
        text = re.sub(r"\bfont: ([\d.]+px) ([^;\"]+)", r"font-size: \1; font-family: \2", memory.getvalue().decode())
        return Picture(text.encode(), caption, name, "svg")
    figure.set_dpi(dpi or DPI)
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    image = Image.fromarray(np.asarray(canvas.buffer_rgba())).convert("RGB")
    image = image.quantize(256, Image.Quantize.MAXCOVERAGE, kmeans=int(shaded), dither=Image.Dither.NONE)
    image.save(memory, "png", dpi=(figure.dpi, figure.dpi), optimize=True)
    return Picture(memory.getvalue(), caption, name)


def new_figure(height=2.9):
    """A figure with axes for a chart; margins are given in inches, as their computation takes
    half of matplotlib's time."""
    figure = Figure(figsize=(WIDTH, height))
    return figure, place(figure, 0.78, 0.5, WIDTH - 0.98, height - 0.8)


def place(figure, left, bottom, width, height):
    """Axes at a place in inches."""
    across, upwards = figure.get_size_inches()
    return figure.add_axes((left / across, bottom / upwards, width / across, height / upwards))


def with_margin(values, share=0.03):
    """Limits of an axis around values."""
    low, high = values.min(), values.max()
    return low - share * (high - low), high + share * (high - low)


def lines(axes, curves, title="", x="", y="", zero=False, limits=None, log=False):
    """Draws curves (label, x, y), with a line at zero, or with the axis between limits."""
    cycle_colours(axes, len(curves))
    for label, xs, ys in curves:
        axes.plot(xs, ys, label=label)
    finish(axes, title, x, y, zero, limits, log)


def lines_of_runs(axes, curves, title="", x="", y="", zero=False):
    """Draws curves (run, x, y); each run has its colour in all charts."""
    for run, xs, ys in curves:
        axes.plot(xs, ys, color=f"C{run.place % 10}", label=run.title_in_chart)
    finish(axes, title, x, y, zero)


def finish(axes, title, x, y, zero, limits=None, log=False):
    """Adds titles, limits and legend to curves."""
    axes.set(xlabel=x, ylabel=textwrap.fill(y, 34))
    axes.set_title(title, loc="left")
    axes.margins(x=0)
    if zero:
        axes.axhline(0., color="0.4", linewidth=0.6)
    if limits is not None:
        axes.set_ylim(limits)
    if log:
        axes.set_yscale("log")
    legend_above(axes)


def columns_for(names):
    """Of a legend, as many as have space."""
    return 2 if max(map(len, names), default=0) > 15 else 3


def legend_above(axes):
    """Adds a legend of the curves that have names, above them."""
    names = axes.get_legend_handles_labels()[1]
    if not names:
        return
    columns = columns_for(names)
    rows = -(-len(names) // columns)
    forward, back = axes.yaxis.get_transform(), axes.yaxis.get_transform().inverted()
    low, high = forward.transform(axes.get_ylim())
    line = 1.5 * matplotlib.rcParams["legend.fontsize"] * axes.figure.dpi / 72.
    share = min(rows * line / axes.bbox.height, 0.6)
    axes.set_ylim(top=back.transform(high + share / (1. - share) * (high - low)))
    axes.legend(ncols=columns, edgecolor="none", loc="upper left", borderaxespad=0.1)


def cycle_colours(axes, n):
    """Sets colours for more curves than matplotlib has colours; neighbours also differ by dashes."""
    if n > 10:
        axes.set_prop_cycle(color=matplotlib.colormaps["turbo"](np.linspace(0.05, 0.95, n)),
                            linestyle=[("-", "--")[i % 2] for i in range(n)])


NOISE = 1e-6  # below it a stress [MPa], an opening [mm] or a time [s] is zero


def usual_largest(values, share, least=0.):
    """Twice the value that a @p share of all does not exceed, but not below @p least, or the largest if that is
    less: a fragment that was thrown far must not hide the rest."""
    return min(values.max(), max(2. * np.quantile(values, share), least))


class Scale:
    """Colours of a quantity, the same in all pictures that are compared.

    Tension is red and compression blue, equally deep at the same amount; where there
    are both, the range is symmetric about zero. The range omits the share @p cut of the
    outermost values, as at the ends of joints and abutments, where they depend on
    the mesh; these values have the colours of the ends.
    """

    def __init__(self, values, label, cut=0.005, colours=None, low=None, high=None):
        has_both = False
        values = np.concatenate([np.zeros(0), *(np.ravel(v) for v in values)])
        values = values[np.isfinite(values)] if np.isfinite(values).any() else np.zeros(1)
        if low is None or high is None:
            has_both = values.min() < -NOISE and values.max() > NOISE
            ends = np.quantile(values, (cut, 1. - cut))
            if np.ptp(ends) <= NOISE:  # few values differ from the rest, so none is left out
                ends, cut = (values.min(), values.max()), 0.
            low, high = ends[0] if low is None else low, ends[1] if high is None else high
        low, high = (0. if abs(end) < NOISE else end for end in (low, high))
        if colours is None:
            largest = max(abs(low), abs(high))
            low, high = (-largest, largest) if has_both else (min(low, 0.), max(high, 0.))
        if high - low <= NOISE:
            high, label = low + 1., f"{label}: {number(low)} everywhere"
        elif high - low < 1e-3 * abs(high):
            high = low + 1e-3 * abs(high)
        self.label = label
        self.levels = ticker.MaxNLocator(8, steps=[1, 2, 2.5, 5, 10]).tick_values(low, high)
        # whether there are values beyond the range
        self.below = values.min() < self.levels[0] - NOISE
        self.above = self.is_above(values)
        largest = np.abs(self.levels).max()
        self.norm = Normalize(-largest if colours is None else self.levels[0],
                              largest if colours is None else self.levels[-1])
        self.colours = matplotlib.colormaps[colours or "RdBu_r"]

    def is_above(self, values):
        return np.max(values) > self.levels[-1] + NOISE

    def largest_above(self, values):
        """Words on values of a picture beyond the end of the bar."""
        unit = self.label.rpartition("[")[2].rstrip("]")
        return f"; the largest value is {number(float(np.max(values)))} {unit}" if self.is_above(values) else ""

    def bar(self, figure):
        """A colour bar at the bottom, 0.65 inches high with its label."""
        axes = place(figure, 1.1, 0.5, WIDTH - 1.9, 0.1)
        first, last = self.levels[0], self.levels[-1]
        axes.imshow(np.linspace(first, last, 256)[None, :], norm=self.norm, cmap=self.colours, aspect="auto",
                    extent=(first, last, 0., 1.))
        axes.set_yticks([])
        axes.grid(False)
        texts = [f"{level:g}".replace("-", "−") for level in self.levels]
        # as many numbers as have space, with both ends
        intervals, longest = len(texts) - 1, max(map(len, texts)) + 1.5
        step = next(n for n in range(1, intervals + 1)
                    if intervals % n == 0 and intervals // n * longest <= 44. or n == intervals)
        ticks, texts = self.levels[::step], texts[::step]
        if self.above:
            texts[-1] = f"≥ {texts[-1]}"
        if self.below:
            texts[0] = f"≤ {texts[0]}"
        axes.set_xticks(ticks, texts)
        axes.tick_params(labelsize=8)
        axes.set_xlabel(self.label)

    def picture(self, name):
        """The bar alone."""
        figure = Figure(figsize=(WIDTH, 0.65))
        self.bar(figure)
        return picture(figure, self.label, name)


def distinct(n):
    """RGB (n, 3) of distinct colours."""
    return np.array([matplotlib.colormaps["tab10" if n <= 10 else "tab20"](i % 20)[:3] for i in range(n)])


def framed(image, across, caption, name, scale=None, legend=None, dpi=None):
    """A picture of a scene that is @p across [m] wide, with a scale bar, a colour bar and
    a legend of colours."""
    height = WIDTH * image.shape[0] / image.shape[1]
    columns = columns_for(legend or ())
    rows = -(-len(legend or ()) // columns)
    below = 0.7 if scale else 0.2 * rows
    figure = Figure(figsize=(WIDTH, height + below))
    axes = place(figure, 0., below, WIDTH, height)
    axes.imshow(image, extent=(0., across, 0., across * image.shape[0] / image.shape[1]))
    axes.set_axis_off()
    scale_bar(axes, 0.97 * across, 0.03 * across, 0.12 * across)
    if scale:
        scale.bar(figure)
    if legend:
        figure.legend([Rectangle((0, 0), 1, 1, color=colour) for colour in legend.values()], list(legend),
                      ncols=columns, frameon=False, loc="lower center", borderaxespad=0.)
    return picture(figure, caption, name, vector=False, dpi=dpi, shaded=True)


def triangles(n_quadrilaterals):
    """Corners of two triangles for each quadrilateral, each of which has its own corners."""
    first = 4 * np.arange(n_quadrilaterals)[:, None]
    return np.concatenate([first + (0, 1, 2), first + (0, 2, 3)])


def mark_largest(axes, places, values, unit, largest):
    """Marks the place of the extreme value, with its number."""
    at = np.argmax(values) if largest else np.argmin(values)
    x, y = places[at]
    axes.plot(x, y, "o", color="black", markersize=3.5, markerfacecolor="none", clip_on=False)
    # the abscissa may run to the left
    across, upwards = axes.transAxes.inverted().transform(axes.transData.transform((x, y)))
    is_left, is_low = across < 0.5, upwards < 0.5
    axes.annotate(f"{number(values[at])} {unit}", (x, y), fontsize=8.5,
                  xytext=(6 if is_left else -6, 6 if is_low else -11),
                  textcoords="offset points", ha="left" if is_left else "right",
                  bbox={"boxstyle": "round,pad=0.15", "fc": "white", "ec": "none", "alpha": 0.75})


@dataclasses.dataclass
class Panel:
    """A face of a dam, unrolled: places (n, 4, 2) along the crest and upwards, values
    (n, 4) at corners or (n,) in quadrilaterals, ticks of the abscissa as places
    along the crest [m] with their x, and whether the abscissa runs to the left."""

    title: str
    places: np.ndarray
    values: np.ndarray
    ticks: tuple = ((), ())
    runs_left: bool = False


def face_map(panels, scale, caption, name, unit="", largest=None):
    """A picture of faces of a dam.

    @p largest: whether to mark the largest or the smallest value; None for neither.
    """
    width = WIDTH - 0.8
    spans = [np.ptp(panel.places.reshape(-1, 2), axis=0) for panel in panels]
    heights = [min(width * span[1] / span[0], 4.) for span in spans]
    figure = Figure(figsize=(WIDTH, sum(heights) + 0.74 * len(panels) + 0.7))
    top = figure.get_size_inches()[1]
    for panel, height in zip(panels, heights):
        top -= height + 0.74
        axes = place(figure, 0.68, top + 0.49, width, height)
        draw_panel(axes, panel, scale, unit, largest)
    scale.bar(figure)
    return picture(figure, caption, name, vector=False)


def face_profiles(runs, every, label, caption, name):
    """Values over the elevation on the faces of slices of a dam, the downstream one dashed, of
    each run in its colour."""
    figure, axes = new_figure(3.6)
    for run, panels in zip(runs, every):
        for panel, style in zip(panels, ("-", "--")):
            face = panel.title.split(",")[0]
            levels, row = np.unique(np.round(panel.places[..., 1].ravel(), 3), return_inverse=True)
            values = np.broadcast_to(panel.values.reshape(len(panel.places), -1), panel.places.shape[:2]).ravel()
            axes.plot(np.bincount(row.ravel(), values) / np.bincount(row.ravel()), levels, style,
                      color=f"C{run.place % 10}",
                      label=face if len(runs) == 1 else run.title_in_chart if style == "-" else None)
    axes.axvline(0., color="0.4", linewidth=0.6)
    finish(axes, "", label, "elevation z [m]", zero=False)
    return picture(figure, caption, name)


def draw_panel(axes, panel, scale, unit="", largest=None):
    places, values = panel.places, panel.values
    if values.ndim == 1:
        axes.add_collection(PolyCollection(places, array=values, norm=scale.norm, cmap=scale.colours,
                                           edgecolors="face", linewidths=0.3))
        values = np.repeat(values[:, None], 4, axis=1)
        axes.autoscale()
    else:
        axes.tricontourf(*places.reshape(-1, 2).T, triangles(len(places)), values.ravel(),
                         levels=fine(scale.levels), norm=scale.norm, cmap=scale.colours, extend="both")
    axes.set_aspect("equal")
    if panel.runs_left:
        axes.invert_xaxis()
    axes.set_title(panel.title, loc="left")
    axes.set_xticks(panel.ticks[0], [f"{x:g}".replace("-", "−") for x in panel.ticks[1]])
    axes.set(xlabel="x [m], unrolled along the crest", ylabel="elevation z [m]")
    if largest is not None:
        mark_largest(axes, places.reshape(-1, 2), values.ravel(), unit, largest)


def sections_map(panels, scale, caption, name):
    """A picture of sections through a dam side by side, each (title, polygons (y, z), values),
    with upstream on the left."""
    places = [[polygon * (-1., 1.) for polygon in polygons] for _, polygons, _ in panels]
    ranges = [(np.min([p[:, 0].min() for p in own]), np.max([p[:, 0].max() for p in own]))
              for own in places]
    bottom = min(p[:, 1].min() for own in places for p in own)
    top = max(p[:, 1].max() for own in places for p in own)
    gap = 0.06 * (top - bottom)
    # rows of limited ratio of length to height
    rows, width = [[]], 0.
    for panel, (low, high) in enumerate(ranges):
        if rows[-1] and width + high - low > 3.2 * (top - bottom):
            rows.append([])
            width = 0.
        rows[-1].append(panel)
        width += high - low + gap
    longest = max(sum(ranges[panel][1] - ranges[panel][0] + gap for panel in row) for row in rows) + gap
    height = min((WIDTH - 0.8) * (top - bottom + 4. * gap) / longest, 3.6)
    figure = Figure(figsize=(WIDTH, len(rows) * height + 0.85))
    for n, row in enumerate(reversed(rows)):
        axes = place(figure, 0.68, 0.75 + n * height, WIDTH - 0.8, height)
        at = 0.
        for panel in row:
            low, high = ranges[panel]
            axes.add_collection(PolyCollection([p + (at - low, 0.) for p in places[panel]],
                                               array=panels[panel][2], norm=scale.norm,
                                               cmap=scale.colours, edgecolors="face", linewidths=0.3))
            highest = max(p[:, 1].max() for p in places[panel])
            axes.text(at + 0.5 * (high - low), highest + 0.03 * (top - bottom), panels[panel][0],
                      ha="center", fontsize=8)
            at += high - low + gap
        axes.set(xlim=(-gap, longest - gap), ylim=(bottom - gap, top + 3. * gap), ylabel="elevation z [m]")
        axes.set_aspect("equal", anchor="W")
        axes.set_xticks([])
        axes.spines["bottom"].set_visible(False)
        axes.grid(False)
        scale_bar(axes, axes.get_xlim()[1], bottom - 0.5 * gap, 0.25 * (top - bottom), below=True)
    scale.bar(figure)
    return picture(figure, caption, name, vector=False)


def scale_bar(axes, right, at, about, below=False):
    """Draws a scale bar with its length [m] over or below it, as the abscissa has no numbers."""
    length = float(f"{about:.0e}")
    axes.plot([right - length, right], [at, at], color="black", linewidth=1.5, clip_on=False)
    axes.annotate(f"{length:g} m", (right - 0.5 * length, at), xytext=(0, -2 if below else 2), textcoords="offset points",
                  ha="center", va="top" if below else "bottom", fontsize=8)


def fine(levels):
    """Levels with each interval divided, about sixteen intervals in all."""
    n = len(levels) - 1
    parts = -(-16 // n)
    return np.interp(np.arange(n * parts + 1) / parts, np.arange(n + 1), levels)
