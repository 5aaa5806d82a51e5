#!/usr/bin/env python3
"""Draws what `heliodon bench cost --json` measured: a frame's time over its work, both relative to the first row.

usage: heliodon bench cost --json > cost.json && bench/plot_cost.py cost.json cost.svg

Both axes are logarithmic; a line below the diagonal grows more slowly than its work.
"""
import html
import json
import math
import sys

WIDTH, HEIGHT, MARGIN = 640, 480, 60
COLORS = {"voxels": "#0072b2", "pixels": "#009e73", "triangles": "#d55e00", "lights": "#cc79a7"}


def relative(series):
    first = series["rows"][0]
    return [(row[series["work"]] / first[series["work"]], row["frame_median_ms"] / first["frame_median_ms"])
            for row in series["rows"]]


def draw(report):
    decades = max(1, math.ceil(math.log10(max(work for series in report["series"] for work, _ in relative(series)))))
    along_x = lambda value: MARGIN + (WIDTH - 2 * MARGIN) * math.log10(value) / decades
    along_y = lambda value: HEIGHT - MARGIN - (HEIGHT - 2 * MARGIN) * math.log10(value) / decades
    text = lambda x, y, words, extra="": f'<text x="{x:.1f}" y="{y:.1f}" {extra}>{html.escape(words)}</text>'
    lines = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{HEIGHT}" font-family="sans-serif" '
             'font-size="13"><rect width="100%" height="100%" fill="white"/>']
    for decade in range(decades + 1):
        x, y = along_x(10**decade), along_y(10**decade)
        lines.append(f'<path d="M{x:.1f} {MARGIN}V{HEIGHT - MARGIN}M{MARGIN} {y:.1f}H{WIDTH - MARGIN}" stroke="#ddd"/>')
        lines.append(text(x, HEIGHT - MARGIN + 18, f"{10**decade}×", 'text-anchor="middle"'))
        lines.append(text(MARGIN - 8, y + 4, f"{10**decade}×", 'text-anchor="end"'))
    lines.append(f'<path d="M{MARGIN} {HEIGHT - MARGIN}L{WIDTH - MARGIN} {MARGIN}" stroke="#999" stroke-dasharray="5 4"/>')
    for row, series in enumerate(report["series"]):
        color = COLORS[series["work"]]
        points = [(along_x(work), along_y(max(1.0, time))) for work, time in relative(series)]
        lines.append(f'<polyline fill="none" stroke="{color}" stroke-width="2" points="' +
                     " ".join(f"{x:.1f},{y:.1f}" for x, y in points) + '"/>')
        lines += [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="4" fill="{color}"/>' for x, y in points]
        lines.append(text(MARGIN + 14, MARGIN + 20 + 18 * row, series["work"], f'fill="{color}" font-weight="bold"'))
    lines.append(text(WIDTH / 2, HEIGHT - 14, "work", 'text-anchor="middle"'))
    lines.append(text(WIDTH / 2, MARGIN - 24, f'time of a frame, {report["device"]}', 'text-anchor="middle"'))
    return "\n".join(lines + ["</svg>", ""])


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    with open(sys.argv[1], encoding="utf-8") as source:
        picture = draw(json.load(source))
    with open(sys.argv[2], "w", encoding="utf-8") as target:
        target.write(picture)


if __name__ == "__main__":
    main()
