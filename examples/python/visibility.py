# SPDX-License-Identifier: Apache-2.0
"""Visibility between points: which of the cameras see which places of a street?"""

import numpy as np

import meshes
import picture
import pierce

CAMERAS = np.array([[-55.0, -10, 6], [-20, 10, 6], [15, -10, 6], [50, 10, 6]])


def main(out="visibility.png", size=440):
    scene = pierce.Scene(*meshes.street())
    # A place every so often, as high as a face, wherever nothing is built.
    down = pierce.rays.grid((-70, -32, 0), (70, 32, 1.6), (size, size // 2), reverse=True)
    places = down[..., :3]
    free = scene.locate(places, rule="nonzero") < 0  # houses stand in the ground: they unite
    segments = pierce.rays.between(CAMERAS, places[..., None, :])  # every pair, t from 0 to 1
    seen = ~scene.any_hit(segments)  # (size, size / 2, cameras)
    count = np.where(free, seen.sum(axis=-1), np.nan)
    image = picture.colours(count, 0, len(CAMERAS), empty=110)
    for x, y, _ in CAMERAS:
        i, j = int((x + 70) / 140 * size), int((y + 32) / 64 * (size // 2))
        image[max(i - 3, 0):i + 4, max(j - 3, 0):j + 4] = (230, 60, 40)
    picture.save(out, image[:, ::-1].swapaxes(0, 1))
    return count


if __name__ == "__main__":
    found = main()
    print(f"{np.nanmean(found > 0):.0%} of the street is seen by some camera: visibility.png")
