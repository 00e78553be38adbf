// SPDX-License-Identifier: Apache-2.0
//
// What the page unpacks, in node: pierce.wasm runs, and the bunny is that of the file, triangle by
// triangle, every coordinate within half of 2^-16.
//
// usage: node tests/assets_test.mjs
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { createServer } from "vite";

const server = await createServer({ server: { middlewareMode: true }, appType: "custom",
  root: new URL("..", import.meta.url).pathname, logLevel: "error" });
const { bunny, library } = await server.ssrLoadModule("/src/library.ts");
const pierce = await library, mesh = await bunny();
await server.close();

const given = [], corners = [];
for (const line of readFileSync("/usr/share/glmark2/models/bunny.obj", "utf8").split("\n")) {
  const [kind, ...rest] = line.trim().split(/\s+/);
  if (kind === "v") given.push(rest.slice(0, 3).map(Number));
  if (kind === "f") corners.push(rest.map((word) => parseInt(word, 10) - 1));
}

// Triangles as text that does not depend on which corner is named first.
const grid = (x) => Math.round(x * 2 ** 16);
function told(places) {
  const least = [...places].sort()[0], i = places.indexOf(least);
  return [...places.slice(i), ...places.slice(0, i)].join(" ");
}
const count = new Map();
for (const triangle of corners) {
  const key = told(triangle.map((c) => given[c].map(grid).join()));
  count.set(key, (count.get(key) ?? 0) + 1);
}
assert.equal(mesh.vertices.length, 3 * given.length);
assert.equal(mesh.triangles.length, 3 * corners.length);
for (let i = 0; i < mesh.triangles.length; i += 3) {
  const key = told([...mesh.triangles.subarray(i, i + 3)].map((c) =>
    [...mesh.vertices.subarray(3 * c, 3 * c + 3)].map((x) => x * 2 ** 16).join()));
  const left = count.get(key);
  assert.ok(left, `triangle ${i / 3}, ${key}, is none of the file's`);
  count.set(key, left - 1);
}
const scene = pierce.scene(mesh.vertices, mesh.triangles);
assert.equal(scene.locate(Float32Array.of(0, 0, 0))[0], 1);
console.log(`the bunny: ${corners.length} triangles are those of the file`);
