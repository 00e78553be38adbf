# SPDX-License-Identifier: Apache-2.0
"""A depth map: what a depth camera sees of a mesh."""

import numpy as np

import meshes
import picture
import pierce


def main(out="depth_map.png", size=360):
    scene = pierce.Scene(*meshes.knot())
    rays = pierce.rays.pinhole(size, size, fov=50, center=(0, 0, 0), eye=(3, -6.5, 4),
                               up=(0, 0, -1))  # rows of the picture go down
    hits = scene.closest_hit(rays)  # (size, size), as the rays
    depth = hits.t  # along the line of sight; inf where there is nothing
    picture.save(out, picture.colours(-depth))
    return depth


if __name__ == "__main__":
    depths = main()
    print(f"{np.isfinite(depths).sum()} pixels from {depths.min():.3f} on: depth_map.png")
