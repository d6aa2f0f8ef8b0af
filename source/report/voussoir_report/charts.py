"""Charts and maps: matplotlib, without a display."""

import base64
import io

import matplotlib
import numpy as np
from matplotlib import ticker
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import PolyCollection
from matplotlib.colors import Normalize, TwoSlopeNorm
from matplotlib.figure import Figure
from PIL import Image

from .page import number

matplotlib.rcParams.update({"font.size": 9.5, "axes.grid": True, "grid.alpha": 0.3,
                            "axes.axisbelow": True, "lines.linewidth": 1.,
                            "legend.fontsize": 8.5, "axes.titlesize": 9.5,
                            "xtick.labelsize": 9., "ytick.labelsize": 9., "axes.spines.top": False,
                            "axes.spines.right": False})

WIDTH = 5.0  # [in], so that the letters can be read on a phone
DPI = 150


class Picture:
    """A picture in a page: PNG and what it shows."""

    def __init__(self, png, caption, name=""):
        self.png, self.caption, self.name = png, caption, name

    @property
    def source(self):
        return "data:image/png;base64," + base64.b64encode(self.png).decode()


def picture(figure, caption, name="", shaded=False):
    """Draws a figure; one that is not shaded with few colours, which makes the page
    smaller."""
    figure.set_dpi(DPI)
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    image = Image.fromarray(np.asarray(canvas.buffer_rgba())).convert("RGB")
    memory = io.BytesIO()
    if not shaded:
        image = image.quantize(256, dither=Image.Dither.NONE)
    image.save(memory, "png")
    return Picture(memory.getvalue(), caption, name)


def new_figure(height=2.9):
    """A figure with room for a chart; margins in inches, as finding them takes matplotlib
    half of its time."""
    figure = Figure(figsize=(WIDTH, height))
    return figure, place(figure, 0.76, 0.5, WIDTH - 0.88, height - 0.8)


def place(figure, left, bottom, width, height):
    """Axes at a place in inches."""
    across, upwards = figure.get_size_inches()
    return figure.add_axes((left / across, bottom / upwards, width / across, height / upwards))


def lines(axes, curves, title="", x="", y="", zero=False, limits=None, log=False):
    """Curves (label, x, y), with a line at zero, or with the axis between limits."""
    cycle_colours(axes, len(curves))
    for label, xs, ys in curves:
        axes.plot(xs, ys, label=label)
    finish(axes, title, x, y, zero, limits, log)


def lines_of_runs(axes, curves, title="", x="", y="", zero=False):
    """Curves (run, x, y), each run in its colour in all charts."""
    for run, xs, ys in curves:
        axes.plot(xs, ys, color=f"C{run.place % 10}", label=run.title_in_chart)
    finish(axes, title, x, y, zero)


def finish(axes, title, x, y, zero, limits=None, log=False):
    """What stands around curves."""
    axes.set(xlabel=x, ylabel=y)
    axes.set_title(title, loc="left")
    axes.margins(x=0)
    if zero:
        axes.axhline(0., color="0.4", linewidth=0.6)
    if limits is not None:
        axes.set_ylim(limits)
    if log:
        axes.set_yscale("log")
    legend_above(axes)


def legend_above(axes):
    """A legend of the curves that have names, over them."""
    names = axes.get_legend_handles_labels()[1]
    if not names:
        return
    columns = 2 if max(len(name) for name in names) > 15 else 3
    rows = -(-len(names) // columns)
    forward, back = axes.yaxis.get_transform(), axes.yaxis.get_transform().inverted()
    low, high = forward.transform(axes.get_ylim())
    axes.set_ylim(top=back.transform(high + 0.09 * rows * (high - low)))
    axes.legend(ncols=columns, frameon=False, loc="upper left", borderaxespad=0.1)


def cycle_colours(axes, n):
    """Colours for more curves than matplotlib has colours."""
    if n > 10:
        axes.set_prop_cycle(color=matplotlib.colormaps["turbo"](np.linspace(0.05, 0.95, n)))


class Scale:
    """Colours of a quantity, the same in all pictures that are compared.

    Of tension and compression each has its colour, red and blue, and its own range.
    The range leaves out the outermost @p cut of the values, as at the ends of
    joints and abutments, where they depend on the mesh.
    """

    def __init__(self, values, label, cut=0.005, colours=None, low=None, high=None):
        if low is None or high is None:
            values = np.concatenate([np.ravel(v) for v in values])
            values = values[np.isfinite(values)] if np.isfinite(values).any() else np.zeros(1)
            low = np.quantile(values, cut) if low is None else low
            high = np.quantile(values, 1. - cut) if high is None else high
            if colours is None and -0.05 * low > high > 0.:
                high = 0.  # as good as no tension
        if high - low < 1e-12 * max(abs(low), abs(high), 1e-30):
            high = low + max(abs(low), 1.) * 1e-3
        self.label = label
        # colours beyond the ends of the bar are values that it leaves out
        self.extend = "both" if cut > 0. else "neither"
        self.both = colours is None and low < 0. < high
        if self.both:
            self.levels = np.unique(np.concatenate([-nice_levels(-low)[::-1], nice_levels(high)]))
            self.norm = TwoSlopeNorm(0., self.levels[0], self.levels[-1])
        else:
            self.levels = ticker.MaxNLocator(8, steps=[1, 2, 2.5, 5, 10]).tick_values(low, high)
            self.norm = Normalize(self.levels[0], self.levels[-1])
        if colours is None:
            colours = "RdBu_r" if self.both else "Reds" if low >= 0. else "Blues_r"
        self.colours = matplotlib.colormaps[colours]

    def bar(self, figure):
        """A colour bar at the bottom, 0.65 inches high with its label."""
        mappable = matplotlib.cm.ScalarMappable(self.norm, self.colours)
        step = 2 if len(self.levels) > 9 else 1
        bar = figure.colorbar(mappable, cax=place(figure, 1.1, 0.5, WIDTH - 1.9, 0.1), label=self.label,
                              extend=self.extend, ticks=self.levels[::step], orientation="horizontal")
        bar.ax.tick_params(labelsize=8)


def nice_levels(most):
    """Round numbers from 0 to beyond this."""
    return ticker.MaxNLocator(5, steps=[1, 2, 2.5, 5, 10]).tick_values(0., most)


def triangles(n_quadrilaterals):
    """Corners of two triangles for each of some quadrilaterals with own corners."""
    first = 4 * np.arange(n_quadrilaterals)[:, None]
    return np.concatenate([first + (0, 1, 2), first + (0, 2, 3)])


def mark_largest(axes, places, values, unit, largest):
    """Writes the extreme value beside its place."""
    at = np.argmax(values) if largest else np.argmin(values)
    x, y = places[at]
    axes.plot(x, y, "o", color="black", markersize=3.5, markerfacecolor="none")
    is_left, is_low = x < 0.5 * sum(axes.get_xlim()), y < 0.5 * sum(axes.get_ylim())
    axes.annotate(f"{number(values[at])} {unit}", (x, y), fontsize=8.5,
                  xytext=(6 if is_left else -6, 6 if is_low else -11),
                  textcoords="offset points", ha="left" if is_left else "right",
                  bbox={"boxstyle": "round,pad=0.15", "fc": "white", "ec": "none", "alpha": 0.75})


def face_map(panels, scale, caption, name, unit="", largest=None):
    """Faces of a dam, each (title, places (n, 4, 2), values (n, 4) or (n,)).

    @p largest: whether to mark the largest or the smallest value; None for neither.
    """
    width = WIDTH - 0.8
    spans = [np.ptp(places.reshape(-1, 2), axis=0) for _, places, _ in panels]
    heights = [min(width * span[1] / span[0], 4.) for span in spans]
    figure = Figure(figsize=(WIDTH, sum(heights) + 0.55 * len(panels) + 0.75))
    top = figure.get_size_inches()[1]
    for (title, places, values), height in zip(panels, heights):
        top -= height + 0.55
        axes = place(figure, 0.68, top + 0.25, width, height)
        if values.ndim == 1:
            axes.add_collection(PolyCollection(places, array=values, norm=scale.norm,
                                               cmap=scale.colours, edgecolors="face",
                                               linewidths=0.3))
            values = np.repeat(values[:, None], 4, axis=1)
            axes.autoscale()
        else:
            axes.tricontourf(*places.reshape(-1, 2).T, triangles(len(places)), values.ravel(),
                             levels=fine(scale.levels), norm=scale.norm, cmap=scale.colours,
                             extend="both")
        axes.set_aspect("equal")
        axes.set_title(title, loc="left")
        axes.set_ylabel("elevation [m]")
        if largest is not None:
            mark_largest(axes, places.reshape(-1, 2), values.ravel(), unit, largest)
    scale.bar(figure)
    return picture(figure, caption, name)


def sections_map(panels, scale, caption, name):
    """Sections through a dam side by side, each (title, polygons (y, z), values), with
    upstream on the left."""
    places = [[polygon * (-1., 1.) for polygon in polygons] for _, polygons, _ in panels]
    ranges = [(np.min([p[:, 0].min() for p in own]), np.max([p[:, 0].max() for p in own]))
              for own in places]
    bottom = min(p[:, 1].min() for own in places for p in own)
    top = max(p[:, 1].max() for own in places for p in own)
    gap = 0.06 * (top - bottom)
    # in rows that are not much longer than high
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
        axes.set(xlim=(-gap, longest - gap), ylim=(bottom - gap, top + 3. * gap), ylabel="elevation [m]")
        axes.set_aspect("equal", anchor="W")
        axes.set_xticks([])
        axes.spines["bottom"].set_visible(False)
        axes.grid(False)
    scale.bar(figure)
    return picture(figure, caption, name)


def fine(levels):
    """Each interval in two."""
    return np.sort(np.concatenate([levels, 0.5 * (levels[1:] + levels[:-1])]))
