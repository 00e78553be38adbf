# SPDX-License-Identifier: Apache-2.0
"""Scene.view: the page holds the scene's numbers, and refuses what is not the scene's."""

import base64
import json
import re

import numpy as np
import pytest

import pierce

VERTICES, TRIANGLES = [[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]
RAYS = [[0.25, 0.25, 1, 0, 0, -2], [2, 2, 1, 0, 0, -1]]


def numbers_of(page):
    facts = json.loads(re.search(r'<script id="facts"[^>]*>(.*?)</script>', page, re.S)[1])
    block = base64.b64decode(re.search(r'<script id="bytes"[^>]*>(.*?)</script>', page, re.S)[1])
    real = np.dtype(f"<f{facts['bits'] // 8}")

    def array(place, dtype, columns):
        return np.frombuffer(block, dtype, place[1], place[0]).reshape(-1, columns)

    return facts, [(array(m["vertices"], real, 3), array(m["triangles"], "<u4", 3))
                   for m in facts["meshes"]], (array(facts["rays"], real, 8), array(
                       facts["hits"], real, 4), array(facts["names"], "<u4", 3))


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_the_numbers_are_the_scenes(dtype):
    scene = pierce.Scene(np.array(VERTICES, dtype), TRIANGLES)
    view = scene.view(np.array(RAYS, dtype))
    assert repr(view) == "View(1 triangles, 2 rays, 1 hits)"
    facts, [(vertices, triangles)], (rays, hits, names) = numbers_of(view.html)
    assert facts["bits"] == 8 * np.dtype(dtype).itemsize
    assert vertices.tolist() == VERTICES and triangles.tolist() == TRIANGLES
    assert rays.tolist() == [[*ray, 0, np.inf] for ray in RAYS]
    assert hits[0].tolist() == [0.5, 0.25, 0.25, 0.5]
    assert names.tolist() == [[0, 0, 0], [1, 0xffffffff, 0xffffffff]]


def test_hits_bring_their_rays_and_lists_name_them():
    scene = pierce.Scene([(VERTICES, TRIANGLES), ((VERTICES, TRIANGLES), np.diag([1., 1, 1, 1]))])
    lists = scene.all_hits(RAYS)
    facts, meshes, (rays, hits, names) = numbers_of(scene.view(hits=lists).html)
    assert len(rays) == 2 and names.tolist() == [[0, 0, 0], [0, 1, 0]]
    assert len(meshes) == 2 and facts["meshes"][1]["matrix"][:4] == [1, 0, 0, 0]
    some = scene.closest_hit(RAYS[::-1])
    assert numbers_of(scene.view(hits=some[some.hit]).html)[2][2].tolist() == [[1, 0, 0]]


def test_files_and_notebooks(tmp_path):
    view = pierce.Scene(VERTICES, TRIANGLES).view()
    assert repr(view) == "View(1 triangles)"
    view.save(tmp_path / "v.html")
    assert (tmp_path / "v.html").read_text() == view.html
    frame = view._repr_html_()
    assert frame.startswith("<iframe") and frame.count('srcdoc="') == 1 and "<html" not in frame
    with pytest.raises(pierce.BadFile, match="v.html"):
        view.save(tmp_path / "no" / "v.html")


def test_what_is_refused():
    scene = pierce.Scene(VERTICES, TRIANGLES)
    other = pierce.Scene([*VERTICES, [5, 5, 5]], [[0, 1, 2], [1, 2, 3]])
    with pytest.raises(pierce.IndexOutOfRange, match="triangle 1 of geometry 0"):
        scene.view(hits=other.closest_hit([[4, 4, 4, -1, -1, -1], [1.9, 1.9, 9, 0, 0, -1]]))
    with pytest.raises(TypeError, match="closest_hit or all_hits"):
        scene.view(hits=[1, 2])
    with pytest.raises(ValueError, match="up"):
        scene.view(up="x")
