#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Draws docs/images/barycentric_regions.svg: the seven regions into which the lines of a triangle's
edges divide the plane, the signs of (w, u, v) in each, and what a zero coordinate means.

    scripts/draw_barycentric_regions.py > docs/images/barycentric_regions.svg

Only the standard library. Every label is placed by its barycentric coordinates.
"""

WIDTH, HEIGHT = 860, 620
A, B, C = (300, 415), (590, 435), (410, 215)  # corners in pixels, y downwards
LINES = "#5b6770"
COLORS = ["#fdf3d7", "#d9e8f6", "#f7dcd4"]  # inside, beyond one edge, beyond two


def point(w, u, v):
    return tuple(w * a + u * b + v * c for a, b, c in zip(A, B, C))


def coordinates(x, y):
    """(w, u, v) of a pixel: signed areas over the whole."""
    def area(p, q, r):
        return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])
    whole = area(A, B, C)
    return tuple(area(*corners) / whole for corners in
                 (((x, y), B, C), (A, (x, y), C), (A, B, (x, y))))


def clip(polygon, index, sign):
    """The part of a polygon where coordinate `index` has the sign (Sutherland and Hodgman)."""
    result = []
    for i, p in enumerate(polygon):
        q = polygon[(i + 1) % len(polygon)]
        s, t = (sign * coordinates(*r)[index] for r in (p, q))
        if s >= 0:
            result.append(p)
        if s * t < 0:
            k = s / (s - t)
            result.append((p[0] + k * (q[0] - p[0]), p[1] + k * (q[1] - p[1])))
    return result


def text(x, y, content, size=15, weight="normal", color="#1f2a30", anchor="middle"):
    return (f'<text x="{x:.0f}" y="{y:.0f}" font-size="{size}" font-weight="{weight}" '
            f'fill="{color}" text-anchor="{anchor}">{content}</text>')


def region(signs):
    polygon = [(0, 0), (WIDTH, 0), (WIDTH, HEIGHT), (0, HEIGHT)]
    for index, sign in enumerate(signs):
        polygon = clip(polygon, index, sign)
    points = " ".join(f"{x:.1f},{y:.1f}" for x, y in polygon)
    return f'<polygon points="{points}" fill="{COLORS[signs.count(-1)]}"/>'


def sign_label(signs):
    return "(" + ", ".join("+" if s > 0 else "&#8722;" for s in signs) + ")"


def main():
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" '
           f'width="{WIDTH}" height="{HEIGHT}" font-family="DejaVu Sans, Helvetica, sans-serif">',
           "<title>The seven barycentric regions of a triangle</title>"]

    labels = {  # signs of (w, u, v): where the label stands, and what it says
        (1, 1, 1): (point(0.36, 0.30, 0.34), "inside", "a hit"),
        (-1, 1, 1): (point(-0.75, 0.90, 0.85), "beyond bc", ""),
        (1, -1, 1): (point(0.70, -0.50, 0.80), "beyond ca", ""),
        (1, 1, -1): (point(0.74, 0.70, -0.44), "beyond ab", ""),
        (1, -1, -1): (point(1.90, -0.50, -0.40), "beyond ca and ab", ""),
        (-1, 1, -1): (point(-0.40, 1.78, -0.38), "beyond ab and bc", ""),
        (-1, -1, 1): (point(-0.38, -0.40, 1.78), "beyond bc and ca", ""),
    }
    out += [region(signs) for signs in labels]

    for p, q in ((A, B), (B, C), (C, A)):  # the lines of the edges, across the whole picture
        d = (q[0] - p[0], q[1] - p[1])
        out.append(f'<line x1="{p[0] - 5 * d[0]}" y1="{p[1] - 5 * d[1]}" '
                   f'x2="{p[0] + 5 * d[0]}" y2="{p[1] + 5 * d[1]}" '
                   f'stroke="{LINES}" stroke-width="1" stroke-dasharray="5 5"/>')
    corners = " ".join(f"{x},{y}" for x, y in (A, B, C))
    out.append(f'<polygon points="{corners}" fill="none" stroke="#1f2a30" stroke-width="3" '
               'stroke-linejoin="round"/>')

    for signs, ((x, y), name, more) in labels.items():
        out.append(text(x, y, sign_label(signs), 19, "bold"))
        out.append(text(x, y + 21, name, 14))
        if more:
            out.append(text(x, y + 39, more, 14))

    edge_color, vertex_color = "#a03a1c", "#174f8a"
    for weights, label, dx, dy, anchor in (
            ((0.5, 0.5, 0), "v = 0 on edge ab", 0, 24, "middle"),
            ((0, 0.50, 0.50), "w = 0 on edge bc", 12, -8, "start"),
            ((0.5, 0, 0.5), "u = 0 on edge ca", -12, -2, "end")):
        x, y = point(*weights)
        out.append(f'<circle cx="{x:.0f}" cy="{y:.0f}" r="4" fill="{edge_color}"/>')
        out.append(text(x + dx, y + dy, label, 14, "bold", edge_color, anchor))
    for weights, label, dx, dy, anchor in (
            ((1, 0, 0), "a: w = 1, u = v = 0", -14, -18, "end"),
            ((0, 1, 0), "b: u = 1, v = w = 0", 16, -8, "start"),
            ((0, 0, 1), "c: v = 1, w = u = 0", 16, 4, "start")):
        x, y = point(*weights)
        out.append(f'<circle cx="{x:.0f}" cy="{y:.0f}" r="6" fill="{vertex_color}"/>')
        out.append(text(x + dx, y + dy, label, 14, "bold", vertex_color, anchor))

    for line, (content, size) in enumerate((("p = w a + u b + v c", 15), ("w + u + v = 1", 15),
                                            ("signs of (w, u, v)", 13))):
        out.append(text(18, 32 + 22 * line, content, size, anchor="start"))
    out.append("</svg>")
    print("\n".join(out))


if __name__ == "__main__":
    main()
