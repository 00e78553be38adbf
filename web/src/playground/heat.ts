// SPDX-License-Identifier: Apache-2.0
//
// Where a textbook method errs: rays at each triangle's own edges, vertices and middle, asked of that
// triangle alone, by the method and exactly.
import type { Pierce } from "pierce-wasm";
import type { Mesh } from "../library.js";

/** Where on a triangle the rays go: weights of a, b and c. */
const PLACES = [[1, 0, 0], [0, 1, 0], [0, 0, 1], [0.5, 0.5, 0], [0, 0.5, 0.5], [0.5, 0, 0.5],
  [0.3, 0.7, 0], [0, 0.3, 0.7], [0.7, 0, 0.3], [0.2, 0.3, 0.5]];

export interface Heat {
  /** Wrong answers of each triangle. */
  wrong: Uint8Array;
  rays: number;
  total: number;
}

export function heatOf(pierce: Pierce, { vertices, triangles }: Mesh, method: string,
                       eye: readonly [number, number, number]): Heat {
  const count = triangles.length / 3, wrong = new Uint8Array(count);
  const block = 2048, n = PLACES.length;
  let total = 0;
  for (let first = 0; first < count; first += block) {
    const here = Math.min(block, count - first);
    const rays = new Float32Array(8 * n * here), corners = new Float32Array(9 * n * here);
    for (let i = 0; i < here; ++i)
      for (let j = 0; j < n; ++j) {
        const row = i * n + j;
        for (let k = 0; k < 3; ++k) {
          const at = [0, 1, 2].map((c) => vertices[3 * triangles[3 * (first + i) + c] + k]);
          const target = Math.fround(PLACES[j][0] * at[0] + PLACES[j][1] * at[1] + PLACES[j][2] * at[2]);
          rays[8 * row + k] = eye[k];
          rays[8 * row + 3 + k] = target - Math.fround(eye[k]);
          for (let c = 0; c < 3; ++c) corners[9 * row + 3 * c + k] = at[c];
        }
        rays[8 * row + 7] = Infinity;
      }
    const truth = pierce.ask("exact", rays, corners).hit, said = pierce.ask(method, rays, corners).hit;
    for (let row = 0; row < n * here; ++row)
      if (truth[row] !== said[row]) {
        ++wrong[first + Math.floor(row / n)];
        ++total;
      }
  }
  return { wrong, rays: n * count, total };
}
