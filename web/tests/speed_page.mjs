// SPDX-License-Identifier: Apache-2.0
//
// The page of figures.mjs in which pierce.wasm and three-mesh-bvh cast the same rays at the same mesh,
// in batches, on one thread.
import * as three from "three";
import { MeshBVH } from "three-mesh-bvh";
import { Pierce } from "/package/index.js";

const pierce = await Pierce.load(await (await fetch("/package/pierce.wasm")).arrayBuffer());
const vertices = [], triangles = [];
for (const line of (await (await fetch("/bunny.obj")).text()).split("\n")) {
  const [kind, ...rest] = line.trim().split(/\s+/);
  if (kind === "v") vertices.push(...rest.slice(0, 3).map(Number));
  if (kind === "f") triangles.push(...rest.map((word) => parseInt(word, 10) - 1));
}
const v = Float32Array.from(vertices), f = Uint32Array.from(triangles);
const scene = pierce.scene(v, f);
const geometry = new three.BufferGeometry();
geometry.setAttribute("position", new three.BufferAttribute(v, 3));
geometry.setIndex(new three.BufferAttribute(f, 1));
const bvh = new MeshBVH(geometry, { indirect: true });

let seed = 1, rays, hits, found;
const random = () => (seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0) / 2 ** 32;

/** To vertices and points of edges (hard), or anywhere in the box; how many. */
globalThis.makeRays = (hard) => {
  const count = 50000;
  rays = new Float32Array(8 * count);
  for (let i = 0; i < count; ++i) {
    const origin = [0, 1, 2].map(() => 4 * random() - 2);
    let target = [0, 1, 2].map(() => 1.6 * random() - 0.8);
    if (hard) {
      const t = 3 * Math.floor((random() * f.length) / 3), s = random() < 0.5 ? 0 : random();
      target = [0, 1, 2].map((k) => v[3 * f[t] + k] * (1 - s) + v[3 * f[t + 1] + k] * s);
    }
    rays.set([...origin, ...target.map((x, k) => x - Math.fround(origin[k])), 0, Infinity], 8 * i);
  }
  return count;
};
globalThis.closest = () => (hits = scene.closestHits(rays));
globalThis.any = () => scene.anyHits(rays);
globalThis.theirs = () => {
  const count = rays.length / 8, ray = new three.Ray();
  found = new Uint32Array(count).fill(0xffffffff);
  for (let i = 0; i < count; ++i) {
    ray.origin.fromArray(rays, 8 * i);
    ray.direction.fromArray(rays, 8 * i + 3);
    const hit = bvh.raycastFirst(ray, three.DoubleSide);
    if (hit) found[i] = hit.faceIndex;
  }
};
/** three-mesh-bvh's answers that are not pierce's, which are exact. */
globalThis.wrong = () => {
  const counts = { missed: 0, invented: 0, another: 0 };
  found.forEach((triangle, i) => {
    const right = hits.triangle[i];
    if (triangle === right) return;
    ++counts[triangle === 0xffffffff ? "missed" : right === 0xffffffff ? "invented" : "another"];
  });
  return counts;
};
globalThis.speedReady = true;
