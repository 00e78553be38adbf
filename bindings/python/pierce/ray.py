# SPDX-License-Identifier: Apache-2.0
"""Rays in the data sets of Ray Data, cast batch by batch; for parquet files, say.

`import ray` is yours: nothing here needs it. (Rays that are made are in `pierce.rays`.)
"""

from __future__ import annotations

from typing import Any, Mapping

import numpy as np

from ._arrays import Array
from ._blocks import (RAY_COLUMNS, answers, checked_options, checked_query, file_of,
                      opened)


class Caster:
    """What `map_batches` calls: rays in, the same batch and its answers out.

    Args:
        scene: the path of a scene file (`Scene.save`, `pierce build`) that every worker sees, or a
            Scene that `pierce.open` opened. Each process opens it once; only its path travels.
        query: "closest": columns t, u, v, w, geometry, triangle, facing, a miss with t = inf and
            triangle = -1; "any": hit, bool; "count": hits, uint32.
        threads: how many each batch takes; 1 as Ray has its own processes.
        options: those of closest_hit, any_hit or count_hits that are the same for all rays.

    A batch has the columns ox oy oz dx dy dz, perhaps t_min and t_max, or one column `rays` of
    arrays (6,) or (8,), in float32 for a scene of float32; other columns stay as they are.

    Raises ValueError and TypeError; in a batch what the query raises, and BadFile if the file is
    not the one that it was.

        rays = ray.data.read_parquet("rays/")
        hits = rays.map_batches(pierce.ray.Caster("city.pierce"), batch_size=1 << 20)
        hits.write_parquet("hits/")

    >>> import os, tempfile
    >>> mesh = pierce.Scene([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    >>> with tempfile.TemporaryDirectory() as there:
    ...     mesh.save(os.path.join(there, "one.pierce"))
    ...     caster = Caster(os.path.join(there, "one.pierce"), query="any")
    ...     caster({"rays": np.array([[0.25, 0.25, 1, 0, 0, -1], [5.0, 5, 1, 0, 0, -1]])})["hit"]
    array([ True, False])
    """

    def __init__(self, scene: Any, *, query: str = "closest", threads: int = 1, **options: Any):
        self._query, self._threads = checked_query(query), threads
        self._options = checked_options(query, options)
        self._file, _ = file_of(scene)

    def __call__(self, batch: Mapping[str, Any]) -> dict[str, Any]:
        rays = _rays(batch)
        found = answers(opened(*self._file), rays, self._query, self._threads, self._options)
        taken = [name for name in found if name in batch]
        if taken:
            raise ValueError(f"the batch has a column {taken[0]!r} already; rename or drop it")
        return {**batch, **found}


def _rays(batch: Mapping[str, Any]) -> Array:
    if "rays" in batch:
        rays = np.asarray(batch["rays"])
        if rays.ndim != 2 or rays.shape[1] not in (6, 8):
            raise ValueError(f"the column rays has the shape {rays.shape}; give arrays of 6 or 8 "
                             "numbers")
        return rays
    names = RAY_COLUMNS if "t_min" in batch or "t_max" in batch else RAY_COLUMNS[:6]
    missing = [name for name in names if name not in batch]
    if missing:
        raise ValueError(f"the batch has no column {missing[0]!r}; it has {', '.join(batch)}; "
                         "rays are ox oy oz dx dy dz, perhaps t_min and t_max, or rays")
    return np.stack([np.asarray(batch[name]) for name in names], axis=1)
