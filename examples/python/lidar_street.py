# SPDX-License-Identifier: Apache-2.0
"""A lidar scan of a street: one revolution of a Velodyne HDL-64E on a roof, as a point cloud."""

import numpy as np

import meshes
import picture
import pierce


def main(out="lidar_street.png", columns=2083, size=480):
    scene = pierce.Scene(*meshes.street())
    beams = pierce.rays.lidar("HDL-64E", pose=(0, -2, 2.0), columns=columns, t_max=80)
    hits = scene.closest_hit(beams)  # a range picture, (64, columns)
    cloud = hits.points[hits.hit]  # the points, (n, 3)
    draw(out, cloud, size)
    return cloud


def draw(out, cloud, size):
    """The cloud, seen at a slant from above: a point a pixel, near ones last."""
    around, tilt = np.radians(25), np.radians(50)
    right = np.array([np.cos(around), np.sin(around), 0])
    away = np.array([-np.sin(around) * np.cos(tilt), np.cos(around) * np.cos(tilt), -np.sin(tilt)])
    x, y = ((cloud @ axis * size / 75 + size / 2).astype(int)
            for axis in (right, np.cross(away, right)))
    order = np.argsort(-cloud @ away)
    order = order[((x >= 0) & (x < size) & (y >= 0) & (y < size))[order]]
    image = np.full((size, size, 3), 16.0)
    image[y[order], x[order]] = picture.colours(np.sqrt(cloud[order, 2]), -1, 2.5)
    picture.save(out, image)


if __name__ == "__main__":
    print(f"{len(main())} points: lidar_street.png")
