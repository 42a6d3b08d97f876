# SPDX-License-Identifier: MIT
"""Work-precision diagrams: error over cost, both logarithmic, a panel per case.

Ours in one colour, integer code of others, floating point hollow; the front of integer code, of
which nothing is both cheaper and more exact, as a line. What was measured elsewhere has a faint
mark. Every point has a number, named beside the panels.
"""

import csv
import math
import os

KINDS = ("ours", "integer", "float")


class Point:
    def __init__(self, panel, name, kind, cost, error, here=True):
        assert kind in KINDS
        self.panel, self.name, self.kind, self.here = panel, name, kind, here
        self.cost, self.error = float(cost), float(error)


def front(points):
    """The integer points of which none is both cheaper and more exact, by cost."""
    best, kept = math.inf, []
    for p in sorted((p for p in points if p.kind != "float"), key=lambda p: (p.cost, p.error)):
        if p.error < best:
            best = p.error
            kept.append(p)
    return kept


def on_front(points):
    """Of each panel: is one of ours on the front?"""
    panels = list(dict.fromkeys(p.panel for p in points))
    return {k: any(p.kind == "ours" for p in front([q for q in points if q.panel == k]))
            for k in panels}


def bounds(values):
    """A range of an axis, a little wider than the values."""
    lo, hi = math.log10(min(values)), math.log10(max(values))
    more = max(0.08 * (hi - lo), 0.15)
    return 10 ** (lo - more), 10 ** (hi + more)


def stairs(step, x, y):
    """The front's line: down to each of its points, and on to the right end."""
    line = [(step[0].cost, y[1])] if step else []
    for a, b in zip(step, step[1:] + [None]):
        line += [(a.cost, a.error), (b.cost if b else x[1], a.error)]
    return line


def place(points, x, y, width, height, em, line=()):
    """Where the numbers go, shares of the panel from its lower left: each beside its mark, none
    over another one, a mark or the line."""
    def pixel(cost, error):
        return (math.log(cost / x[0]) / math.log(x[1] / x[0]) * width,
                math.log(error / y[0]) / math.log(y[1] / y[0]) * height)

    at = [pixel(p.cost, p.error) for p in points]
    boxes = [(a - 6, b - 6, a + 6, b + 6) for a, b in at]
    corners = [pixel(*c) for c in line]
    boxes += [(min(a, c) - 2, min(b, d) - 2, max(a, c) + 2, max(b, d) + 2)
              for (a, b), (c, d) in zip(corners, corners[1:])]
    out = []
    for k, (a, b) in enumerate(at):
        best = None
        w, h = 0.62 * em * len(points[k].label) / 2 + 1, 0.55 * em
        for ring in range(1, 9):
            for turn in range(16):
                r = 9 + em * 0.5 * ring
                cx, cy = (a + (r + w / 2) * math.cos(turn * math.pi / 8),
                          b + r * math.sin(turn * math.pi / 8))
                box = (cx - w, cy - h, cx + w, cy + h)
                over = sum(max(0, min(box[2], o[2]) - max(box[0], o[0])) *
                           max(0, min(box[3], o[3]) - max(box[1], o[1]))
                           for o in boxes)
                outside = box[0] < 2 or box[1] < 2 or box[2] > width - 2 or box[3] > height - 2
                cost = over * 10 + 1000 * outside + r + (0 if turn % 4 else -1)
                if best is None or cost < best[0]:
                    best = (cost, cx, cy, box)
        out.append((best[1] / width, best[2] / height))
        boxes.append(best[3])
    return out


def draw(out, name, points, floor, x_labels, y_label, columns=0, share=True):
    """Writes OUT/NAME_points.csv, NAME_front.csv and NAME.panels, which work.gp draws. floor:
    errors below it are drawn there. x_labels: of each panel, or one for all; share: panels of one
    row have one range of errors."""
    panels = list(dict.fromkeys(p.panel for p in points))
    names = list(dict.fromkeys(p.name for p in points))
    columns = columns or len(panels)
    rows = -(-len(panels) // columns)
    legend_px, panel_w, panel_h = 480, max(400, min(620, 1560 // columns)), 460 if rows > 1 else 620
    for p in points:
        p.error, p.label = max(p.error, floor), str(names.index(p.name) + 1)
    kind_of = {p.name: p.kind for p in points}
    here = {p.name: p.here for p in points}
    with open(os.path.join(out, name + ".panels"), "w", encoding="utf-8") as g:
        g.write("n_panels = %d; n_columns = %d; n_rows = %d; panel_w = %d.; panel_h = %d.; "
                "legend_px = %d.\n" % (
                    len(panels), columns, rows, panel_w, panel_h, legend_px))
        g.write("y_label = \"%s\"; n_names = %d\n" % (y_label, len(names)))
        for k, n in enumerate(names):
            g.write("name_%d = \"%d  %s%s\"; name_kind_%d = %d\n" %
                    (k + 1, k + 1, n, "" if here[n] else " *", k + 1,
                     KINDS.index(kind_of[n])))
        with open(os.path.join(out, name + "_points.csv"), "w", encoding="utf-8",
                  newline="") as fp, \
                open(os.path.join(out, name + "_front.csv"), "w", encoding="utf-8",
                     newline="") as ff:
            wp, wf = csv.writer(fp), csv.writer(ff)
            wp.writerow(["panel", "kind", "here", "cost", "error", "label_cost", "label_error",
                         "label"])
            wf.writerow(["panel", "cost", "error"])
            for k, title in enumerate(panels):
                mine = [p for p in points if p.panel == title]
                row = ([p for p in points if panels.index(p.panel) // columns == k // columns]
                       if share else mine)
                x, y = bounds([p.cost for p in mine]), bounds([p.error for p in row])
                g.write("x_label_%d = \"%s\"\n" %
                        (k + 1, x_labels if isinstance(x_labels, str) else x_labels[k]))
                g.write("title_%d = \"%s\"; x0_%d = %g; x1_%d = %g; y0_%d = %g; y1_%d = %g\n" % (
                    k + 1, title, k + 1, x[0], k + 1, x[1], k + 1, y[0], k + 1, y[1]))
                line = stairs(front(mine), x, y)
                for p, (lx, ly) in zip(mine,
                                       place(mine, x, y, panel_w - 120, panel_h - 122, 18, line)):
                    wp.writerow([k + 1, KINDS.index(p.kind), int(p.here), "%g" % p.cost,
                                 "%g" % p.error, "%g" % (x[0] * (x[1] / x[0]) ** lx),
                                 "%g" % (y[0] * (y[1] / y[0]) ** ly), p.label])
                for cost, error in line:
                    wf.writerow([k + 1, "%g" % cost, "%g" % error])
