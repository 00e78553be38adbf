// SPDX-License-Identifier: Apache-2.0
//
// pierce.wasm beside three-mesh-bvh in node, one thread each, on the Stanford bunny: the processor's
// time for a ray (which other programs hardly change) of batches of closest and any hits, and three-mesh-bvh's wrong answers. With a third argument the rays
// are written to files of floats, eight a ray, for `pierce cast` to be timed with.
//
// usage: node --no-liftoff speed.mjs PACKAGE_DIST FOLDER_WITH_NODE_MODULES [RAYS]
// (--no-liftoff: compiled with all optimisation from the start.)
import { readFileSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";

const [dist, modules, out] = process.argv.slice(2);
const { Pierce } = await import(pathToFileURL(resolve(dist, "index.js")).href);
const require = createRequire(pathToFileURL(resolve(modules, "package.json")));
const three = await import(pathToFileURL(resolve(modules, "node_modules/three/build/three.module.js")).href);
const { MeshBVH } = await import(pathToFileURL(require.resolve("three-mesh-bvh")).href);
const pierce = await Pierce.load(readFileSync(resolve(dist, "pierce.wasm")));

const vertices = [], triangles = [];
for (const line of readFileSync("/usr/share/glmark2/models/bunny.obj", "utf8").split("\n")) {
  const [kind, ...rest] = line.trim().split(/\s+/);
  if (kind === "v") vertices.push(...rest.slice(0, 3).map(Number));
  if (kind === "f") triangles.push(...rest.map((word) => parseInt(word, 10) - 1));
}
const v = Float32Array.from(vertices), f = Uint32Array.from(triangles);
const scene = pierce.scene(v, f);

let seed = 1;
const random = () => (seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0) / 2 ** 32;

/** To vertices and points of edges (hard), or anywhere in the box (easy). */
function raysOf(count, hard) {
  const rays = new Float32Array(8 * count);
  for (let i = 0; i < count; ++i) {
    const origin = [0, 1, 2].map(() => 4 * random() - 2);
    let target = [0, 1, 2].map(() => 1.6 * random() - 0.8);
    if (hard) {
      const t = 3 * Math.floor((random() * f.length) / 3), s = random() < 0.5 ? 0 : random();
      target = [0, 1, 2].map((k) => v[3 * f[t] + k] * (1 - s) + v[3 * f[t + 1] + k] * s);
    }
    rays.set([...origin, ...target.map((x, k) => x - Math.fround(origin[k])), 0, Infinity], 8 * i);
  }
  return rays;
}

const geometry = new three.BufferGeometry();
geometry.setAttribute("position", new three.BufferAttribute(v, 3));
geometry.setIndex(new three.BufferAttribute(f, 1));
const bvh = new MeshBVH(geometry, { indirect: true });

function theirs(rays, count) {
  const found = new Uint32Array(count).fill(0xffffffff), ray = new three.Ray();
  for (let i = 0; i < count; ++i) {
    ray.origin.fromArray(rays, 8 * i);
    ray.direction.fromArray(rays, 8 * i + 3);
    const hit = bvh.raycastFirst(ray, three.DoubleSide);
    if (hit) found[i] = hit.faceIndex;
  }
  return found;
}

function best(what) {
  let least = Infinity, answer;
  for (let i = 0; i < 9; ++i) {
    const start = process.cpuUsage();
    answer = what();
    const { user, system } = process.cpuUsage(start);
    least = Math.min(least, (user + system) / 1000);
  }
  return [least, answer];
}

for (const hard of [false, true]) {
  const count = 50000, rays = raysOf(count, hard);
  if (out) writeFileSync(`${out}.${hard ? "hard" : "easy"}.f32`, rays);
  const [ours, hits] = best(() => scene.closestHits(rays));
  const [any] = best(() => scene.anyHits(rays));
  const [other, found] = best(() => theirs(rays, count));
  let missed = 0, invented = 0, wrong = 0;
  found.forEach((triangle, i) => {
    const right = hits.triangle[i];
    if (triangle === right) return;
    if (triangle === 0xffffffff) ++missed;
    else if (right === 0xffffffff) ++invented;
    else ++wrong;
  });
  const ns = (ms) => ((ms * 1e6) / count).toFixed(0);
  console.log(`${hard ? "hard" : "easy"} rays: pierce.wasm closest ${ns(ours)} ns, any ${ns(any)} ns; three-mesh-bvh ` +
    `closest ${ns(other)} ns (${(other / ours).toFixed(1)} times as long); its answers: ${missed} hits missed, ` +
    `${invented} invented, ${wrong} another triangle, of ${count}`);
}
