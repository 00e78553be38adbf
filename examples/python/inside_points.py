# SPDX-License-Identifier: Apache-2.0
"""Which of a million points are inside? And so: how large is the solid?"""

import time

import numpy as np

import meshes
import picture
import pierce


def main(out="inside_points.png", count=1_000_000, size=300):
    mesh = meshes.knot()
    scene = pierce.Scene(*mesh)
    low, high = mesh[0].min(axis=0), mesh[0].max(axis=0)
    points = np.random.default_rng(0).uniform(low, high, (count, 3))
    start = time.perf_counter()
    inside = scene.locate(points) > 0  # 1 inside, 0 on the surface, -1 outside
    seconds = time.perf_counter() - start
    share = inside.mean() * np.prod(high - low)
    print(f"{inside.sum()} of {count} points inside, {seconds:.2f} s; "
          f"volume {share:.3f}, of the mesh {meshes.volume(mesh):.3f}")
    xy = points[inside][:, :2]
    density, _, _ = np.histogram2d(xy[:, 1], xy[:, 0], size // 2,
                                   [(low[1], high[1]), (low[0], high[0])])
    picture.save(out, np.kron(picture.colours(density[::-1]), np.ones((2, 2, 1))))
    return share, meshes.volume(mesh)


if __name__ == "__main__":
    main()
