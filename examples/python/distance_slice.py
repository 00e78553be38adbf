# SPDX-License-Identifier: Apache-2.0
"""A slice through the signed distance of a solid: how far, and on which side."""

import numpy as np

import meshes
import picture
import pierce


def main(out="distance_slice.png", size=360):
    scene = pierce.Scene(*meshes.knot())
    x = np.linspace(-4, 4, size)
    points = np.stack(np.meshgrid(x, x, [0.1], indexing="xy"), axis=-1)[:, :, 0]
    distance = scene.signed_distance(points)  # negative inside
    blue, red = np.array([40, 80, 180]), np.array([200, 60, 40])
    fade = np.exp(-np.abs(distance) / 0.8)[..., None]
    image = np.where((distance < 0)[..., None], blue, red) * fade + 255 * (1 - fade)
    lines = np.abs(distance / 0.25 - np.round(distance / 0.25)) < 0.06  # every quarter
    image[lines] *= 0.75
    picture.save(out, image[::-1])
    return distance


if __name__ == "__main__":
    found = main()
    print(f"from {found.min():.3f} to {found.max():.3f}: distance_slice.png")
