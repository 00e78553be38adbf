// SPDX-License-Identifier: Apache-2.0
//
// pierce itself and the bunny, which lie in the page, packed.
import { Pierce } from "pierce-wasm";
import { bunny as packedBunny, wasm } from "./assets.js";

function inPage(base64: string): Promise<ArrayBuffer> {
  const text = atob(base64), bytes = new Uint8Array(text.length);
  for (let i = 0; i < bytes.length; ++i) bytes[i] = text.charCodeAt(i);
  const unpacked = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Response(unpacked).arrayBuffer();
}

export interface Mesh {
  name: string;
  vertices: Float32Array;
  triangles: Uint32Array;
}

export const library: Promise<Pierce> = inPage(wasm).then((bytes) => Pierce.load(bytes));

/** As scripts/assets.mjs packs it: a walk over the surface, in whole numbers of seven bits a byte. */
export async function bunny(): Promise<Mesh> {
  const bytes = new Uint8Array(await inPage(packedBunny));
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
  const beyond = (a: number, b: number, behind: number) => {
    if (open.delete(edge(b, a))) return;
    open.add(edge(a, b));
    walk.push(a, b, behind);
  };
  triangles.set([0, 1, 2]);
  for (let to = 3, met = 3; walk.length; ) {
    const behind = walk.pop()!, b = walk.pop()!, a = walk.pop()!;
    if (!open.delete(edge(a, b))) continue;
    const d = next(), c = d ? Math.min(a, b) + d : met++;
    if (!d) parents.set([a, b, behind], 3 * c);
    triangles.set([a, b, c], to);
    to += 3;
    beyond(c, b, a);
    beyond(a, c, b);
  }
  for (let k = 0; k < 3; ++k)
    for (let i = 0; i < count; ++i) {
      const parent = (j: number) => vertices[3 * parents[3 * i + j] + k];
      const expected = i < 3 ? 0 : parent(0) + parent(1) - parent(2);
      vertices[3 * i + k] = expected + next() / 2 ** 16;
    }
  return { name: "bunny", vertices, triangles };
}
