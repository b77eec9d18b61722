"""Curves as SVG inside a page. Colours are those of the page, so that a figure follows light and dark."""

import html
import math


def nice_ticks(low, high, count=6):
    """Round numbers that cover a range."""
    if high <= low:
        high = low + 1.0
    step = 10.0 ** math.floor(math.log10((high - low) / count))
    step *= next(factor for factor in (1, 2, 5, 10) if (high - low) / (step * factor) <= count)
    first = math.ceil(low / step - 1e-9)
    return [k * step for k in range(first, math.floor(high / step + 1e-9) + 1)]


def _label(value):
    return f"{value:.4g}".replace("-", "\N{MINUS SIGN}") if abs(value) > 1e-12 else "0"


class Axes:
    """A frame of 460 x 300 whose curves are given in their own units."""

    WIDTH, HEIGHT, LEFT, RIGHT, TOP, BOTTOM = 460, 300, 62, 10, 10, 46

    def __init__(self, x_range, y_range, x_title, y_title):
        self.x_range, self.y_range = _padded(x_range), _padded(y_range)
        self.parts = []
        self._frame(x_title, y_title)

    def x(self, value):
        low, high = self.x_range
        return self.LEFT + (value - low) / (high - low) * (self.WIDTH - self.LEFT - self.RIGHT)

    def y(self, value):
        low, high = self.y_range
        return self.HEIGHT - self.BOTTOM - (value - low) / (high - low) * (self.HEIGHT - self.TOP - self.BOTTOM)

    def _frame(self, x_title, y_title):
        bottom, right = self.HEIGHT - self.BOTTOM, self.WIDTH - self.RIGHT
        for value in nice_ticks(*self.x_range):
            self._grid(self.x(value), self.TOP, self.x(value), bottom)
            self._text(self.x(value), bottom + 16, _label(value), "middle")
        for value in nice_ticks(*self.y_range):
            self._grid(self.LEFT, self.y(value), right, self.y(value))
            self._text(self.LEFT - 6, self.y(value) + 4, _label(value), "end")
        self._text((self.LEFT + right) / 2, self.HEIGHT - 8, x_title, "middle")
        middle = (self.TOP + bottom) / 2
        self.parts.append(f'<text x="14" y="{middle}" text-anchor="middle" transform="rotate(-90 14 {middle})">'
                          f"{html.escape(y_title)}</text>")

    def _grid(self, x1, y1, x2, y2):
        self.parts.append(f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}" stroke="currentColor" opacity="0.15"/>')

    def _text(self, x, y, text, anchor):
        self.parts.append(f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}">{html.escape(text)}</text>')

    def curve(self, xs, ys, style, dashed=False):
        """A line through the points; at most 600 of them are drawn."""
        every = max(1, len(xs) // 600)
        points = [(self.x(x), self.y(y)) for x, y in zip(xs[::every], ys[::every]) if math.isfinite(x) and math.isfinite(y)]
        dash = ' stroke-dasharray="5 4"' if dashed else ""
        path = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
        self.parts.append(f'<polyline class="{style}" points="{path}" fill="none" stroke-width="1.8"{dash}/>')

    def dots(self, xs, ys, style):
        for x, y in zip(xs, ys):
            self.parts.append(f'<circle class="fill-{style}" cx="{self.x(x):.1f}" cy="{self.y(y):.1f}" r="3.5"/>')

    def svg(self, title):
        return (f'<svg viewBox="0 0 {self.WIDTH} {self.HEIGHT}" role="img" aria-label="{html.escape(title, quote=True)}" '
                f'font-size="12" fill="currentColor">' + "".join(self.parts) + "</svg>")


def _padded(limits):
    low, high = limits
    edge = 0.04 * (high - low) or 0.5
    return low - edge, high + edge


def figure(curves, x_title, y_title, caption, shape="line"):
    """curves: [(style, label, xs, ys)]. A figure with its legend, as HTML."""
    xs = [x for _, _, values, _ in curves for x in values]
    ys = [y for _, _, _, values in curves for y in values]
    axes = Axes((min(xs), max(xs)), (min(ys), max(ys)), x_title, y_title)
    for style, _, x, y in curves:
        axes.curve(x, y, style, dashed=style == "ideal")
        if shape == "dots":
            axes.dots(x, y, style)
    legend = "".join(f'<span><i class="{style}"></i>{html.escape(label)}</span>' for style, label, _, _ in curves)
    return (f'<figure class="drawn"><div class="legend">{legend}</div>{axes.svg(caption)}'
            f"<figcaption>{html.escape(caption)}</figcaption></figure>")


def row(figures):
    """Figures side by side where the page is wide enough, as a block of MyST."""
    return '```{raw} html\n<div class="figure-row">' + "".join(figures) + "</div>\n```\n"
