// SPDX-License-Identifier: Apache-2.0
//
// A page of `pierce view` in Debian's Chromium, opened from its folder: what it says of a triangle and
// of a hit are the numbers of the files; it turns, comes nearer and changes to dark; axe-core finds no
// fault; a mesh of a million triangles opens. Pictures are kept to be looked at. The picture is drawn
// by a processor (SwiftShader), which is slow; VIEW_TRIANGLES=100000 makes the large mesh smaller.
//
// usage: node tests/view_test.mjs [TOOL] [FOLDER FOR PICTURES]
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { chromium } from "playwright-core";

const root = new URL("../..", import.meta.url).pathname;
const tool = process.argv[2] ?? `${root}build/release/tool/pierce`;
const folder = process.argv[3] ?? `${root}build/view`;
mkdirSync(folder, { recursive: true });
const pierce = (...words) => execFileSync(tool, [...words, "--quiet"], { cwd: folder });

// A cube about the origin, and rays of which the first hits the middle of its front.
const corners = [0, 1, 2, 3, 4, 5, 6, 7].map((i) => [i & 1, (i >> 1) & 1, i >> 2].map((x) => x - 0.5));
const quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
const obj = (vertices, faces) => vertices.map((v) => `v ${v.join(" ")}\n`).join("") +
  faces.map((f) => `f ${f.map((i) => i + 1).join(" ")}\n`).join("");
writeFileSync(`${folder}/cube.obj`, obj(corners, quads.flatMap(([a, b, c, d]) => [[a, b, c], [a, c, d]])));
writeFileSync(`${folder}/rays.csv`, "ox,oy,oz,dx,dy,dz\n0.1,0.2,3,0,0,-1\n3,3,3,-1,-1,-1.01\n3,3,3,1,0,0\n");
pierce("view", "cube.obj", "--rays", "rays.csv", "--out", "cube.html");
const wanted = Number(process.env.VIEW_TRIANGLES ?? 1e6), n = Math.ceil(Math.sqrt(wanted / 2));
const points = [], faces = [];
for (let y = 0; y <= n; ++y)
  for (let x = 0; x <= n; ++x) points.push([x / n, (0.1 * Math.sin((9 * x) / n) * Math.cos((7 * y) / n)).toFixed(6), y / n]);
for (let y = 0, i = 0; y < n; ++y, ++i)
  for (let x = 0; x < n; ++x, ++i) faces.push([i, i + n + 1, i + 1], [i + 1, i + n + 1, i + n + 2]);
writeFileSync(`${folder}/large.obj`, obj(points, faces));
pierce("view", "large.obj", "--precision", "float", "--out", "large.html");

const browser = await chromium.launch({ executablePath: "/usr/bin/chromium",
  args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"] });
const faults = [];
async function open(name, colorScheme) {
  const page = await browser.newPage({ viewport: { width: 800, height: 600 }, colorScheme });
  page.setDefaultTimeout(300000);
  page.on("pageerror", (error) => faults.push(String(error)));
  page.on("request", (request) => /^https?:/.test(request.url()) && faults.push(request.url()));
  const started = Date.now();
  await page.goto(`file://${folder}/${name}`, { waitUntil: "commit" });
  await page.waitForFunction(() => document.documentElement.dataset.frames, null, { polling: 100 });
  console.log(`${name}: first picture after ${Date.now() - started} ms`);
  return page;
}
const told = (page) => page.textContent("#told");
const picture = (page, name) => page.screenshot({ path: `${folder}/${name}.png` });

const cube = await open("cube.html", "light");
assert.equal(await cube.textContent("#size"), "12 triangles, 3 rays, 2 hits");
await picture(cube, "cube-light");
await cube.fill("#number", "3");
await cube.click("text=show >> nth=-1");
assert.match(await told(cube), /^triangle 3\na  vertex 4  \(-0\.5, -0\.5, 0\.5\)\nb  vertex 7  \(0\.5, 0\.5, 0\.5\)\nc  vertex 6  /);
await cube.fill("#number", "12");
await cube.click("text=show >> nth=-1");
assert.match(await told(cube), /no triangle 12: they are 0 to 11/);

// The middle of the picture is the middle of the cube; with the hit's disc there it says the hit.
await cube.mouse.click(400, 300);
assert.match(await told(cube), /triangle \d+\na  vertex/);
await cube.keyboard.press("Home");
const before = await cube.locator("#picture").screenshot();
for (let i = 0; i < 4; ++i) await cube.keyboard.press("ArrowLeft");
await cube.waitForTimeout(500);
assert.notDeepEqual(await cube.locator("#picture").screenshot(), before, "arrow keys do not turn it");
await cube.mouse.move(400, 300);
await cube.mouse.down();
await cube.mouse.move(430, 320, { steps: 5 });
await cube.mouse.up();
await cube.mouse.wheel(0, -300);
await cube.waitForTimeout(500);
let found = "";
for (let y = 200; y < 420 && !found; y += 6)
  for (let x = 250; x < 560 && !found; x += 6) {
    await cube.mouse.click(x, y);
    const words = await told(cube);
    if (/^hit 0/.test(words)) found = words;
  }
assert.match(found, /^hit 0, of ray 0: t = 2\.5  u = [0-9.]+  v = [0-9.]+  w = [0-9.]+\ntriangle [23]\n/);
const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
for (const theme of ["light", "dark"]) {
  await cube.evaluate(axe);
  const { violations } = await cube.evaluate(() => globalThis.axe.run());
  assert.deepEqual(violations.map((v) => `${v.id}: ${v.nodes[0].html}`), [], theme);
  await picture(cube, `cube-picked-${theme}`);
  await cube.click("text=light or dark");
}

const large = await open("large.html", "dark");
await large.mouse.click(400, 320);
assert.match(await told(large), /^triangle \d+\na  vertex \d+/);
const frames = async () => Number(await large.evaluate(() => document.documentElement.dataset.frames));
const first = await frames(), from = Date.now();
await large.mouse.move(400, 300);
await large.mouse.down();
for (let i = 1; i <= 20; ++i) await large.mouse.move(400 + 5 * i, 300 + i);
await large.mouse.up();
const drawn = (await frames()) - first;
console.log(`large.html: ${drawn} pictures in ${Date.now() - from} ms of dragging, drawn by the processor`);
assert.ok(drawn > 0);
await picture(large, "large-dark");
await browser.close();
assert.deepEqual(faults, []);
console.log(`view: all as it should be; pictures in ${folder}`);
