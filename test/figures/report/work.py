# SPDX-License-Identifier: MIT
"""Work-precision diagrams: error over cost, both logarithmic, a panel per case.

Our code has one colour. Other integer code has another, and floating point is hollow. The front of
integer code is a line, if it has two points at least: nothing is both cheaper and more exact. Our
code, the front and the best of floating point have names in the panel. All else is faint and
nameless.
"""

import csv
import math
import os

KINDS = ("ours", "integer", "float")
PANEL_W, PANEL_H = 480, 430
LEFT, RIGHT, TOP, BOTTOM = 92, 18, 48, 72  # of a panel, px
FONT = 14  # points
EM = FONT * 4 / 3  # px
FEW = 6  # points of a panel that are all named


class Point:
    def __init__(self, panel, name, kind, cost, error):
        assert kind in KINDS
        self.panel, self.name, self.kind = panel, name, kind
        self.cost, self.error, self.label = float(cost), float(error), ""


def front(points, kinds=("ours", "integer")):
    """The points of these kinds of which none is both cheaper and more exact, by cost."""
    best, kept = math.inf, []
    for p in sorted((p for p in points if p.kind in kinds), key=lambda p: (p.cost, p.error)):
        if p.error < best:
            best = p.error
            kept.append(p)
    return kept


def on_front(points):
    """Of each panel: is one of ours on the front?"""
    panels = list(dict.fromkeys(p.panel for p in points))
    return {k: any(p.kind == "ours" for p in front([q for q in points if q.panel == k]))
            for k in panels}


def name_some(points):
    """Labels of one panel: all of few points, else those that matter, a rival at least."""
    matter = front(points) + front(points, ("float",)) + [p for p in points if p.kind == "ours"]
    if not any(p.kind == "integer" for p in matter):
        matter += front(points, ("integer",))[:1]
    for p in points:
        p.label = p.name if len(points) <= FEW or p in matter else ""


def bounds(values):
    """A range of an axis, a little wider than the values."""
    lo, hi = math.log10(min(values)), math.log10(max(values))
    more = max(0.12 * (hi - lo), 0.2)
    return 10 ** (lo - more), 10 ** (hi + more)


def stairs(step, x, y):
    """The front's line: down to each of its points, and on to the right end. One point is none."""
    line = [(step[0].cost, y[1])] if len(step) > 1 else []
    for a, b in zip(step, step[1:] + [None]):
        line += [(a.cost, a.error), (b.cost if b else x[1], a.error)] if line else []
    return line


def place(points, x, y, width, height, em, line=()):
    """Places of the labels, and where a line from the mark ends at each. Both are shares of the
    panel from its lower left. Each label is beside its mark, and none covers another one, a mark or
    the line."""
    def pixel(cost, error):
        return (math.log(cost / x[0]) / math.log(x[1] / x[0]) * width,
                math.log(error / y[0]) / math.log(y[1] / y[0]) * height)

    at = [pixel(p.cost, p.error) for p in points]
    boxes = [(a - 6, b - 6, a + 6, b + 6) for a, b in at]
    corners = [pixel(*c) for c in line]
    boxes += [(min(a, c) - 2, min(b, d) - 2, max(a, c) + 2, max(b, d) + 2)
              for (a, b), (c, d) in zip(corners, corners[1:])]
    out = [None] * len(points)
    for k in sorted(range(len(points)), key=lambda k: -len(points[k].label)):
        if not points[k].label:
            continue
        (a, b), best = at[k], None
        w, h = 0.58 * em * len(points[k].label) / 2 + 2, 0.55 * em
        for ring in range(14):
            for turn in range(16):
                r = 10 + em * 0.5 * ring
                cx = a + (r + w) * math.cos(turn * math.pi / 8)
                cy = b + (r + h) * math.sin(turn * math.pi / 8)
                box = (cx - w, cy - h, cx + w, cy + h)
                over = sum(max(0, min(box[2], o[2]) - max(box[0], o[0])) *
                           max(0, min(box[3], o[3]) - max(box[1], o[1]))
                           for o in boxes)
                outside = box[0] < 2 or box[1] < 2 or box[2] > width - 2 or box[3] > height - 2
                cost = over * 10 + 5000 * outside + 3 * r + (0 if turn % 8 else -1)
                if best is None or cost < best[0]:
                    best = (cost, cx, cy, box)
        box = best[3]
        near = (min(max(a, box[0]), box[2]), min(max(b, box[1]), box[3]))
        out[k] = [(u / width, v / height) for u, v in (best[1:3], near)]
        boxes.append(box)
    return out


class Diagram:
    """Writes OUT/NAME.panels, NAME_points.csv, NAME_front.csv, NAME_leader.csv, which work.gp
    draws."""

    def __init__(self, out, name):
        self.files = {k: open(os.path.join(out, name + k), "w", encoding="utf-8", newline="")
                      for k in (".panels", "_points.csv", "_front.csv", "_leader.csv")}
        self.rows = {k: csv.writer(f) for k, f in self.files.items()}
        self.rows["_points.csv"].writerow(["panel", "kind", "named", "cost", "error", "label_cost",
                                           "label_error", "label"])
        self.rows["_front.csv"].writerow(["panel", "cost", "error"])

    def say(self, text):
        self.files[".panels"].write(text + "\n")

    def panel(self, k, title, x_label, mine, row):
        x, y = bounds([p.cost for p in mine]), bounds([p.error for p in row])
        self.say("title_%d = \"%s\"; x_label_%d = \"%s\"" % (k, title, k, x_label))
        self.say("x0_%d = %g; x1_%d = %g; y0_%d = %g; y1_%d = %g" %
                 (k, x[0], k, x[1], k, y[0], k, y[1]))
        name_some(mine)
        line = stairs(front(mine), x, y)
        at = place(mine, x, y, PANEL_W - LEFT - RIGHT, PANEL_H - TOP - BOTTOM, EM, line)

        def value(share):
            return tuple("%g" % (a[0] * (a[1] / a[0]) ** s) for a, s in zip((x, y), share))

        for p, label in zip(mine, at):
            there, end = [value(share) for share in label or ((0, 0), (0, 0))]
            self.rows["_points.csv"].writerow([k, KINDS.index(p.kind), int(bool(p.label)),
                                               "%g" % p.cost, "%g" % p.error, *there, p.label])
            if label:
                self.rows["_leader.csv"].writerows([[k, "%g" % p.cost, "%g" % p.error],
                                                    [k, *end], []])
        self.rows["_front.csv"].writerows([k, "%g" % c, "%g" % e] for c, e in line)

    def close(self):
        for f in self.files.values():
            f.close()


def draw(out, name, points, floor, x_labels, y_label, columns=3, share=True):
    """floor: errors below it are drawn there. x_labels: of each panel, or one for all; share:
    panels of one row have one range of errors."""
    panels = list(dict.fromkeys(p.panel for p in points))
    columns = min(columns, len(panels))
    for p in points:
        p.error = max(p.error, floor)
    d = Diagram(out, name)
    d.say("n_panels = %d; n_columns = %d; n_rows = %d; panel_w = %d.; panel_h = %d." %
          (len(panels), columns, -(-len(panels) // columns), PANEL_W, PANEL_H))
    d.say("left = %d.; right = %d.; top = %d.; bottom = %d.; font = %d" %
          (LEFT, RIGHT, TOP, BOTTOM, FONT))
    d.say("y_label = \"%s\"" % y_label)
    for k, title in enumerate(panels):
        mine = [p for p in points if p.panel == title]
        row = ([p for p in points if panels.index(p.panel) // columns == k // columns]
               if share else mine)
        d.panel(k + 1, title, x_labels if isinstance(x_labels, str) else x_labels[k], mine, row)
    d.close()
