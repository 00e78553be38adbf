# SPDX-License-Identifier: Apache-2.0
"""Hours of sun on a terrain, on the day of an equinox at 47 degrees north."""

import numpy as np

import meshes
import picture
import pierce


def sun(hour, latitude=np.radians(47)):
    """Where the sun stands at an equinox; x is east, y north, z up."""
    angle = np.radians(15 * (hour - 12))
    return np.array([-np.sin(angle), -np.cos(angle) * np.sin(latitude),
                     np.cos(angle) * np.cos(latitude)])


def main(out="sun_hours.png", size=200, minutes=10):
    mesh = meshes.terrain()
    scene = pierce.Scene(*mesh)
    down = pierce.rays.grid((0, 0, 0), (10, 10, 4), (size, size), reverse=True)
    hits = scene.closest_hit(down)
    ground = scene.next_origin(hits)  # just above, (size, size, 3)
    hours = np.zeros(hits.shape)
    for hour in np.arange(6, 18, minutes / 60) + minutes / 120:
        hours += ~scene.any_hit(ground, sun(hour)) * (minutes / 60)
    image = picture.colours(hours, 2, 12) * picture.light(hits.normals)[..., None]
    picture.save(out, image[:, ::-1].swapaxes(0, 1))
    return hours


if __name__ == "__main__":
    found = main()
    print(f"{found.min():.1f} to {found.max():.1f} hours of sun: sun_hours.png")
