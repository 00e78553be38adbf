// SPDX-License-Identifier: Apache-2.0
//
// pierce itself and the bunny, which lie in the page, packed.
import { Pierce } from "pierce-wasm";
import { bunny as packedBunny, wasm } from "./assets.js";
import { unpacked } from "./unpack.js";

function inPage({ size, base64 }: { size: number; base64: string }): ArrayBuffer {
  return unpacked(Uint8Array.from(atob(base64), (c) => c.charCodeAt(0)), size).buffer;
}

export interface Mesh {
  name: string;
  vertices: Float32Array;
  triangles: Uint32Array;
}

export const library: Promise<Pierce> = Promise.resolve().then(() => Pierce.load(inPage(wasm)));

/** As scripts/assets.mjs packs it: a walk over the surface, in whole numbers of seven bits a byte. */
export async function bunny(): Promise<Mesh> {
  const bytes = new Uint8Array(inPage(packedBunny));
  let at = 0;
  const next = () => {
    let n = 0;
    for (let shift = 0; ; shift += 7) {
      const byte = bytes[at++];
      n |= (byte & 127) << shift;
      if (byte < 128) break;
    }
    return n & 1 ? -((n + 1) >>> 1) : n >>> 1;
  };
  const count = next(), vertices = new Float32Array(3 * count), triangles = new Uint32Array(3 * next());
  const edge = (a: number, b: number) => a * count + b;
  // Of each vertex: both ends of the edge that it was met at, and the corner behind that edge.
  const parents = new Uint32Array(3 * count), walk = [1, 0, 2, 2, 1, 0, 0, 2, 1];
  const open = new Set([edge(1, 0), edge(2, 1), edge(0, 2)]);
  triangles.set([0, 1, 2]);
  for (let to = 3, met = 3; walk.length; ) {
    const behind = walk.pop()!, b = walk.pop()!, a = walk.pop()!;
    if (!open.delete(edge(a, b))) continue;
    const d = next(), c = d ? Math.min(a, b) + d : met++;
    if (!d) parents.set([a, b, behind], 3 * c);
    triangles.set([a, b, c], to);
    to += 3;
    for (const [from, into, other] of [[c, b, a], [a, c, b]]) {
      if (open.delete(edge(into, from))) continue;
      open.add(edge(from, into));
      walk.push(from, into, other);
    }
  }
  for (let k = 0; k < 3; ++k)
    for (let i = 0; i < count; ++i) {
      const [a, b, behind] = parents.subarray(3 * i, 3 * i + 3);
      const expected = i < 3 ? 0 : vertices[3 * a + k] + vertices[3 * b + k] - vertices[3 * behind + k];
      vertices[3 * i + k] = expected + next() / 2 ** 16;
    }
  return { name: "bunny", vertices, triangles };
}
