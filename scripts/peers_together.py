#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""pierce, Open3D and embreex in one process, imported in the order given: all still answer.

usage: peers_together.py NAME NAME NAME     pierce, open3d, embreex, in the order of import
"""

import importlib
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

for name in sys.argv[1:]:
    importlib.import_module(name)

sys.path.insert(0, str(Path(__file__).resolve().parent))
sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "examples" / "python"))
import meshes  # noqa: E402
import numpy as np  # noqa: E402
import peers_engines  # noqa: E402

vertices, triangles = meshes.knot(300, 60)
vertices = vertices.astype(np.float32)
random = np.random.default_rng(1)
origins = random.uniform(-4, 4, (200_000, 3)).astype(np.float32)
directions = random.standard_normal((200_000, 3)).astype(np.float32)
names = {"pierce": "pierce", "open3d": "Open3D", "embreex": "embreex"}


def cast(engine):
    return engine.closest(origins, directions)


engines = [peers_engines.ENGINES[names[name]](vertices, triangles) for name in sys.argv[1:]]
alone = [cast(engine) for engine in engines]
with ThreadPoolExecutor(len(engines)) as pool:  # and all at once
    together = list(pool.map(cast, engines))
for name, a, b in zip(sys.argv[1:], alone, together):
    assert np.array_equal(a, b), f"{name} answers otherwise beside the others"
    assert (a != alone[0]).mean() < 1e-3, f"{name} is far from {sys.argv[1]}"
print(", ".join(sys.argv[1:]), "in one process: fine,", int((alone[0] >= 0).sum()), "hits")
