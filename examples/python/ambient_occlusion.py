# SPDX-License-Identifier: Apache-2.0
"""Ambient occlusion: how much of the sky each point of a surface sees."""

import numpy as np

import meshes
import picture
import pierce


def main(out="ambient_occlusion.png", size=300, samples=64):
    scene = pierce.Scene(*meshes.join(meshes.knot(), meshes.box((-9, -9, -2), (9, 9, -1.5))))
    rays = pierce.rays.pinhole(size, size, fov=45, center=(0, 0, -0.4), eye=(3, -7, 5),
                               up=(0, 0, -1))
    hits = scene.closest_hit(rays)
    seen = hits[hits.hit]
    starts = scene.next_origin(seen)  # beside the surface, without an epsilon
    sky = pierce.rays.hemisphere(starts, seen.normals, samples, sampling="cosine")
    light = 1 - scene.any_hit(sky).mean(axis=-1)  # the share of rays that get out
    image = np.full(hits.shape, 255.0)
    image[hits.hit] = 255 * light
    picture.save(out, image)
    return light


if __name__ == "__main__":
    print(f"{main().mean():.3f} of the sky, on average: ambient_occlusion.png")
