# SPDX-License-Identifier: Apache-2.0
"""Wall thickness of a part: from each point of its surface, straight in, to the other side."""

import numpy as np

import meshes
import picture
import pierce


def main(out="wall_thickness.png", size=360):
    scene = pierce.Scene(*meshes.bracket())
    rays = pierce.rays.pinhole(size, size, fov=40, center=(0, 0, 0), eye=(2.2, 3.4, 3.2),
                               up=(0, 0, -1))
    hits = scene.closest_hit(rays)
    seen = hits[hits.hit]
    inward = -seen.normals
    # The next surface that is met from behind, not counting the triangle that we stand on.
    through = scene.closest_hit(seen.points, inward, sides="back", skip=seen)
    thickness = np.full(hits.shape, np.nan)
    thickness[hits.hit] = through.t
    shade = picture.light(hits.normals, (0.5, 0.2, 0.8))[..., None]
    picture.save(out, np.where(hits.hit[..., None],
                               picture.colours(-thickness, -0.6, -0.05) * shade, 255))
    return through.t


if __name__ == "__main__":
    found = main()
    thin, usual = np.percentile(found, [5, 50])
    print(f"a twentieth of it thinner than {thin:.3f}, half than {usual:.3f}: wall_thickness.png")
