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

/** As scripts/assets.mjs packs it: differences, in bytes of seven bits. */
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
  const vertices = new Float32Array(3 * next()), triangles = new Uint32Array(3 * next());
  for (let k = 0; k < 3; ++k)
    for (let i = k, x = 0; i < vertices.length; i += 3) vertices[i] = (x += next()) / 2 ** 16;
  for (let k = 0; k < 3; ++k)
    for (let i = k; i < triangles.length; i += 3)
      triangles[i] = next() + (k ? triangles[i - k] : i ? triangles[i - 3] : 0);
  return { name: "bunny", vertices, triangles };
}
