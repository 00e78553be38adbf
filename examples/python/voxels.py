# SPDX-License-Identifier: Apache-2.0
"""Voxels: a solid as a grid of cells, and the cells as a mesh that is drawn by casting rays."""

import numpy as np

import meshes
import picture
import pierce


def main(out="voxels.png", cells=40, size=360):
    mesh = meshes.knot()
    low, high = mesh[0].min(axis=0), mesh[0].max(axis=0)
    step = (high - low).max() / cells
    shape = np.ceil((high - low) / step).astype(int)
    grid = pierce.Scene(*mesh).voxelise(low, step, shape)  # 1 where a cell's centre is inside

    full = np.argwhere(grid > 0)
    cube, faces = meshes.box((0, 0, 0), (step, step, step))
    blocks = (low + full * step)[:, None] + cube
    triangles = faces + 8 * np.arange(len(full))[:, None, None]
    scene = pierce.Scene(blocks.reshape(-1, 3), triangles.reshape(-1, 3))
    rays = pierce.rays.pinhole(size, size, fov=50, center=(0, 0, 0), eye=(3, -6.5, 4),
                               up=(0, 0, -1))
    hits = scene.closest_hit(rays)
    height = full[np.maximum(hits.triangle, 0) // 12, 2]
    image = picture.colours(np.where(hits.hit, height, np.nan))
    picture.save(out, image * np.where(hits.hit, picture.light(hits.normals), 1)[..., None])
    return grid


if __name__ == "__main__":
    found = main()
    print(f"{(found > 0).sum()} of {found.size} cells: voxels.png")
