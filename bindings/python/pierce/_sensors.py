# SPDX-License-Identifier: Apache-2.0
"""Beam patterns of spinning lidars, as their makers' manuals print them.

Every unit leaves the factory with a calibration of its own, up to a few tenths of a degree from
these; pass yours to `pierce.rays.lidar` as `elevations` and `offsets`.
"""

from __future__ import annotations

from typing import NamedTuple


class Sensor(NamedTuple):
    """A spinning lidar.

    Attributes:
        elevations: degrees above the horizon of each beam, from the top one down.
        offsets: degrees by which each beam is ahead, clockwise, of the column it belongs to.
        columns: firings a revolution, at ten revolutions a second.
        source: where the numbers stand.
    """

    elevations: tuple[float, ...]
    offsets: tuple[float, ...]
    columns: int
    source: str


def _even(top: float, bottom: float, count: int) -> tuple[float, ...]:
    step = (bottom - top) / (count - 1)
    return tuple(top + step * i for i in range(count))


def _rake(outer: float, inner: float, count: int) -> tuple[float, ...]:
    """Four columns of emitters side by side, beam after beam."""
    return tuple((outer, inner, -inner, -outer)[i % 4] for i in range(count))


SENSORS = {
    "VLP-16": Sensor(
        _even(15, -15, 16), (0.0,) * 16, 1808,
        "Velodyne, VLP-16 User Manual (63-9243): 16 beams 2 degrees apart, a firing every "
        "55.296 us"),
    "HDL-32E": Sensor(
        _even(32 / 3, -92 / 3, 32), (0.0,) * 32, 2170,
        "Velodyne, HDL-32E User Manual (63-9113): +10.67 to -30.67, 4/3 degree apart, a firing "
        "every 46.08 us"),
    "HDL-64E": Sensor(
        tuple(2 - i / 3 for i in range(32)) + tuple(-8.83 - i / 2 for i in range(32)),
        (0.0,) * 64, 2083,
        "Velodyne, HDL-64E S2 and S3 User's Manual: upper block +2 to -8.33 at 1/3 degree, lower "
        "block -8.83 to -24.33 at 1/2 degree, 0.1728 degree between firings"),
    "OS1-64": Sensor(
        _even(16.611, -16.611, 64), _rake(3.164, 1.055, 64), 1024,
        "Ouster, OS1 Software User Guide: design values of the first generation's "
        "beam_altitude_angles and beam_azimuth_angles"),
    "OS1-128": Sensor(
        _even(21.2, -21.2, 128), _rake(4.23, 1.41, 128), 1024,
        "Ouster, OS1 datasheet, revision 7: 128 beams evenly over 42.4 degrees; the four columns "
        "of emitters as its sensors report them"),
}
