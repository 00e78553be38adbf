// SPDX-License-Identifier: Apache-2.0
//
// Makes src/assets.ts: pierce.wasm and the Stanford bunny, packed by xz for src/unpack.ts, in base64.
// The bunny is that of
// Debian's glmark2-data, its coordinates (of six digits) rounded to multiples of 2^-16.
import { readFileSync, writeFileSync } from "node:fs";
import { execFileSync } from "node:child_process";

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

// Differences to the number before, smallest first, in bytes of seven bits.
const bytes = [];
function put(n) {
  let rest = n < 0 ? -2 * n - 1 : 2 * n;
  for (; rest > 127; rest >>>= 7) bytes.push((rest & 127) | 128);
  bytes.push(rest);
}
put(vertices.length);
put(corners.length);
for (let k = 0; k < 3; ++k) wholes.forEach((v, i) => put(v[k] - (i ? wholes[i - 1][k] : 0)));
for (let k = 0; k < 3; ++k)
  corners.forEach((c, i) => put(c[k] - (k ? c[0] : i ? corners[i - 1][0] : 0)));

const xz = ["--format=raw", "--lzma1=lc=3,lp=0,pb=0,dict=4MiB,nice=273", "--stdout"];
const packed = (data) => `{ size: ${data.length}, base64: "${
  execFileSync("xz", xz, { input: data, maxBuffer: 1 << 26 }).toString("base64")}" }`;
writeFileSync(new URL("../src/assets.ts", import.meta.url),
  `// Made by scripts/assets.mjs.\nexport const wasm = ${packed(wasm)};\n` +
  `export const bunny = ${packed(Buffer.from(bytes))};\n`);
