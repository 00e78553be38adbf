# SPDX-License-Identifier: Apache-2.0
"""Filters: a function of the caller's says which hits count, asked about many rays at a time.

Rays step from hit to hit in exact order, those whose hit was rejected go on after it. Meanwhile the
scene is held: an update waits, or raises if the filter itself calls it.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, Callable, Sequence

import numpy as np

from ._arrays import Array
from ._hits import COLUMNS, Hits, HitLists, new_columns, no_hits, read_only
from ._question import Question, Rays

if TYPE_CHECKING:
    from ._scene import Scene

Filter = Callable[[Array, Hits], Any]


def _accepted(accept: Filter, ray: Array, hits: Hits) -> Array:
    if not callable(accept):
        raise TypeError(f"filter is {accept!r}; give a function of rays and hits")
    answer = np.asarray(accept(read_only(ray), hits._read_only()))
    if answer.dtype != np.bool_ or answer.shape != ray.shape:
        raise TypeError(f"filter returned {answer.dtype} of the shape {answer.shape} for "
                        f"{len(ray)} hits; return an array of as many bools")
    return answer


def closest(scene: Scene, rays: Rays, question: Question, accept: Filter,
            wanted: Sequence[str]) -> tuple[dict[str, Array], int]:
    """The wanted columns of the first hit of each ray that is accepted; the scene's version."""
    with scene._core.hold() as held:
        asked = replace(question, version=held.version)
        return _closest(scene, rays, asked, accept, wanted), held.version


def _closest(scene: Scene, rays: Rays, question: Question, accept: Filter,
             wanted: Sequence[str]) -> dict[str, Array]:
    result = new_columns(rays.count, scene.dtype, wanted)
    no_hits(result)
    live: Array = np.arange(rays.count)
    while len(live):
        some = rays.take(live)
        columns = new_columns(some.count, scene.dtype, {*COLUMNS, *wanted})
        scene._fill(some, question.take_at(live), columns)
        hits = Hits(scene, some, columns, some.shape, question.version)
        live, hits = live[hits.hit], hits[hits.hit]
        if not len(live):
            break
        good = _accepted(accept, live, hits)
        for name, column in result.items():
            column[live[good]] = hits._columns[name][good]
        live = live[~good]
        question = question.going_on(rays.count, live, hits[~good]._refs())
    return result


def lists(scene: Scene, rays: Rays, question: Question, accept: Filter) -> HitLists:
    """All hits of each ray that are accepted, at most max_hits."""
    with scene._core.hold() as held:
        return _lists(scene, rays, replace(question, version=held.version), accept)


def _lists(scene: Scene, rays: Rays, question: Question, accept: Filter) -> HitLists:
    if question.distinct and question.max_hits:
        return _distinct_lists(scene, rays, question, accept)
    hits = scene._all(rays, replace(question, max_hits=2**64 - 1))
    good = _accepted(accept, hits.ray, hits) if len(hits) else np.zeros(0, bool)
    ends = np.concatenate([[0], np.cumsum(good)])[hits.offsets]
    rank = np.cumsum(good) - 1 - ends[hits.ray]
    good &= rank < min(question.max_hits, 2**62)
    ends = np.concatenate([[0], np.cumsum(good)])[hits.offsets]
    columns = {name: column[good] for name, column in hits._columns.items()}
    return HitLists(scene, rays, columns, ends, rays.shape, question.version)


def _distinct_lists(scene: Scene, rays: Rays, question: Question, accept: Filter) -> HitLists:
    found: list[tuple[Array, dict[str, Array]]] = []
    count = np.zeros(rays.count, np.int64)
    live = np.arange(rays.count)
    passed = np.ones(rays.count, bool)  # the hit before was accepted: its t is done with
    while len(live):
        asked = []
        for distinct in (False, True):
            group = live[passed[live] == distinct]
            some = rays.take(group)
            ask = replace(question.take_at(group), distinct=distinct)
            columns = new_columns(some.count, scene.dtype)
            scene._fill(some, ask, columns)
            hit = columns["triangle"] >= 0
            asked.append((group[hit], {k: c[hit] for k, c in columns.items()}))
        live = np.concatenate([group for group, _ in asked])
        columns = {k: np.concatenate([c[k] for _, c in asked]) for k in asked[0][1]}
        if not len(live):
            break
        hits = Hits(scene, rays, columns, live.shape, question.version, live)
        good = _accepted(accept, live, hits)
        found.append((live[good], {k: c[good] for k, c in columns.items()}))
        passed[live] = good
        count[live[good]] += 1
        more = count[live] < min(question.max_hits, 2**62)
        question = question.going_on(rays.count, live[more], hits[more]._refs())
        live = live[more]
    offsets = np.concatenate([[0], np.cumsum(count)])
    if not found:
        return HitLists(scene, rays, new_columns(0, scene.dtype), offsets, rays.shape,
                        question.version)
    ray = np.concatenate([r for r, _ in found])
    order = np.argsort(ray, kind="stable")
    merged = {k: np.concatenate([c[k] for _, c in found])[order] for k in found[0][1]}
    return HitLists(scene, rays, merged, offsets, rays.shape, question.version)
