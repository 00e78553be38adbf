// SPDX-License-Identifier: Apache-2.0
//
// Makes src/assets.ts: pierce.wasm and the Stanford bunny, packed by gzip, in base64.
// The bunny is that of Debian's glmark2-data, its coordinates (of six digits) rounded to multiples of
// 2^-16, its vertices and triangles in another order.
import { readFileSync, writeFileSync } from "node:fs";
import { gzipSync } from "node:zlib";

const root = new URL("../../", import.meta.url);
const wasm = readFileSync(new URL("build/wasm/pierce.wasm", root));
const text = readFileSync("/usr/share/glmark2/models/bunny.obj", "utf8");

const vertices = [], corners = [];
for (const line of text.split("\n")) {
  const [kind, ...rest] = line.trim().split(/\s+/);
  if (kind === "v") vertices.push(rest.slice(0, 3).map(Number));
  if (kind === "f") corners.push(rest.map((word) => parseInt(word, 10) - 1));
}
const wholes = vertices.map((v) => v.map((x) => Math.round(x * 2 ** 16)));

// Whole numbers in bytes of seven bits, the least first.
const bytes = [];
function put(n) {
  let rest = n < 0 ? -2 * n - 1 : 2 * n;
  for (; rest > 127; rest >>>= 7) bytes.push((rest & 127) | 128);
  bytes.push(rest);
}

// The surface is walked from triangle to triangle, depth first, and numbered as it is met: a triangle
// at an edge (a, b) is told by its third corner alone, 0 for a new one, and that is expected where
// the parallelogram of the triangle behind the edge has it. src/library.ts walks the same way.
const third = new Map(), edge = (a, b) => a * vertices.length + b;
for (const [a, b, c] of corners)
  for (const [p, q, r] of [[a, b, c], [b, c, a], [c, a, b]]) third.set(edge(p, q), r);
const number = new Map(), left = [[], [], []];
function meet(corner, expected) {
  number.set(corner, number.size);
  left.forEach((axis, k) => axis.push(wholes[corner][k] - expected[k]));
}
for (const corner of corners[0]) meet(corner, [0, 0, 0]);
put(vertices.length);
put(corners.length);
const [p, q, r] = corners[0], walk = [[q, p, r], [r, q, p], [p, r, q]];
const open = new Set(walk.map(([a, b]) => edge(a, b)));
let met = 1;
while (walk.length) {
  const [a, b, behind] = walk.pop();
  if (!open.delete(edge(a, b))) continue;
  const c = third.get(edge(a, b));
  if (c === undefined) throw new Error("bunny.obj: its surface is not closed");
  ++met;
  if (number.has(c)) {
    put(number.get(c) - Math.min(number.get(a), number.get(b)));  // not 0: c is neither
  } else {
    put(0);
    meet(c, wholes[a].map((x, k) => x + wholes[b][k] - wholes[behind][k]));
  }
  for (const [from, to, other] of [[c, b, a], [a, c, b]]) {
    if (open.delete(edge(to, from))) continue;
    open.add(edge(from, to));
    walk.push([from, to, other]);
  }
}
if (met !== corners.length || number.size !== vertices.length)
  throw new Error("bunny.obj: it is not one surface");
left.flat().forEach(put);

const packed = (data) => `"${gzipSync(data, { level: 9 }).toString("base64")}"`;
writeFileSync(new URL("../src/assets.ts", import.meta.url),
  `// Made by scripts/assets.mjs.\nexport const wasm = ${packed(wasm)};\n` +
  `export const bunny = ${packed(Buffer.from(bytes))};\n`);
