# SPDX-License-Identifier: Apache-2.0
"""The plots of docs/performance.md (performance_page.py)."""
import math
from html import escape

# Colours that people with any kind of colour vision tell apart (Okabe and Ito 2008).
COLORS = {"pierce": "#0072b2", "pierce-batch": "#56b4e9", "embree-robust": "#e69f00",
          "embree-16": "#cc79a7"}


def plot(names, groups):
    """Bars by group: speeds relative to Embree's fast mode, log scale."""
    bar, gap, left, width = 7, 8, 230, 860
    scale = (width - left - 60) / math.log2(8 / 0.25)

    def x(ratio):
        return left + scale * math.log2(min(max(ratio, 0.25), 8) / 0.25)

    height = 60 + len(groups) * (bar * len(names) + gap)
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" '
           f'viewBox="0 0 {width} {height}" font-family="sans-serif" font-size="11">',
           '<rect width="100%" height="100%" fill="white"/>']
    for i, name in enumerate(names):
        out.append(f'<rect x="{20 + 150 * i}" y="10" width="12" height="12" fill="{COLORS[name]}"/>'
                   f'<text x="{37 + 150 * i}" y="20">{escape(name)}</text>')
    for ratio in (0.25, 0.5, 1, 2, 4, 8):
        out.append(f'<line x1="{x(ratio):.1f}" x2="{x(ratio):.1f}" y1="44" y2="{height}" '
                   f'stroke="{"#000" if ratio == 1 else "#ddd"}"/>'
                   f'<text x="{x(ratio):.1f}" y="40" text-anchor="middle">{ratio:g}</text>')
    y = 50
    for label, ratios in groups:
        middle = y + bar * len(names) / 2 + 4
        out.append(f'<text x="{left - 8}" y="{middle:.1f}" text-anchor="end">'
                   f'{escape(label)}</text>')
        for name in names:
            if name in ratios:
                low, high = sorted((x(1), x(ratios[name])))
                out.append(f'<rect x="{low:.1f}" y="{y}" width="{max(high - low, 1):.1f}" '
                           f'height="{bar - 1}" fill="{COLORS[name]}"><title>{escape(name)}: '
                           f'{ratios[name]:.2f}</title></rect>')
            y += bar
        y += gap
    return "\n".join(out + ["</svg>"]) + "\n"
