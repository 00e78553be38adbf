# SPDX-License-Identifier: Apache-2.0
"""Picking: which triangle is under the mouse, and which of its corners is nearest?"""

import numpy as np

import meshes
import picture
import pierce


def main(out="picking.png", size=360, click=(0.42, 0.36)):
    vertices, triangles = meshes.knot(along=90, around=12)
    scene = pierce.Scene(vertices, triangles)
    rays = pierce.rays.pinhole(size, size, fov=50, center=(0, 0, 0), eye=(1, -6, 5), up=(0, 0, -1))
    column, row = int(click[0] * size), int(click[1] * size)

    pick = scene.closest_hit(rays[row, column])  # one ray, one answer
    corner = triangles[pick.triangle][np.argmax([pick.w, pick.u, pick.v])]
    print(pick)
    print(f"triangle {pick.triangle}, nearest of its corners: vertex {corner}")

    hits = scene.closest_hit(rays)
    image = 255 * np.where(hits.hit, picture.light(hits.normals), 1)[..., None] * np.ones(3)
    around = np.any(triangles == corner, axis=1)
    image[hits.hit & around[hits.triangle]] *= (1, 0.8, 0.3)  # those about the corner
    image[hits.triangle == pick.triangle] = (220, 60, 40)
    picture.save(out, image)
    return int(pick.triangle), int(corner)


if __name__ == "__main__":
    main()
