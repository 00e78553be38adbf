// SPDX-License-Identifier: Apache-2.0
//
// What the page and pierce.wasm cost in Debian's Chromium: bytes and time until the page can be used,
// from a server on this machine; the processor's time for a frame while a point is dragged; and a ray's,
// beside three-mesh-bvh in the same page. Chromium runs without a screen and without a GPU, so the
// time that it takes to paint a picture is not in these: what scripts, style and layout take is.
// Processor time, of the page's main thread, hardly depends on what else the machine does.
//
// usage: node tests/figures.mjs [--write]      --write: into docs/lesson.md
import assert from "node:assert/strict";
import { createServer } from "node:http";
import { readFileSync, writeFileSync } from "node:fs";
import { cpus } from "node:os";
import { extname } from "node:path";
import { gzipSync } from "node:zlib";
import { chromium } from "playwright-core";

const root = new URL("../", import.meta.url);
const places = {
  "/": "dist/index.html",
  "/speed.html": null,
  "/three.js": "node_modules/three/build/three.module.js",
  "/three.core.js": "node_modules/three/build/three.core.js",
  "/bvh.js": "node_modules/three-mesh-bvh/build/index.module.js",
  "/speed.js": "tests/speed_page.mjs",
};
const types = { ".html": "text/html", ".js": "text/javascript", ".mjs": "text/javascript", ".wasm": "application/wasm" };
const SPEED = `<!doctype html><title>speed</title>
<script type="importmap">{ "imports": { "three": "/three.js", "three-mesh-bvh": "/bvh.js" } }</script>
<script type="module" src="/speed.js"></script>`;

const server = createServer((asked, answer) => {
  const path = asked.url.split("?")[0];
  const file = path in places ? places[path]
    : path.startsWith("/package/") ? `../build/wasm${path.replace("/package", "/package/dist")}`
    : path === "/bunny.obj" ? "file:///usr/share/glmark2/models/bunny.obj" : undefined;
  if (file === undefined) return void answer.writeHead(404).end();
  const bytes = file === null ? SPEED : readFileSync(new URL(file, root));
  const type = types[extname(file ?? ".html")] ?? "text/plain";
  answer.writeHead(200, { "content-type": type }).end(bytes);
});
await new Promise((done) => server.listen(0, "127.0.0.1", done));
const base = `http://127.0.0.1:${server.address().port}`;

const browser = await chromium.launch({ executablePath: "/usr/bin/chromium",
  args: ["--no-sandbox", "--disable-gpu", "--disable-software-rasterizer"] });

async function opened(url, ready) {
  const page = await browser.newPage({ viewport: { width: 1100, height: 900 } });
  page.setDefaultTimeout(300000);
  const faults = [];
  page.on("pageerror", (error) => faults.push(String(error)));
  const session = await page.context().newCDPSession(page);
  await session.send("Performance.enable", { timeDomain: "threadTicks" });
  const worked = async () => {
    const { metrics } = await session.send("Performance.getMetrics");
    return 1000 * metrics.find(({ name }) => name === "TaskDuration").value;
  };
  const start = performance.now();
  await page.goto(url, { waitUntil: "commit" });
  await page.waitForFunction(ready, null, { polling: 50 });
  assert.deepEqual(faults, []);
  return { page, worked, took: performance.now() - start };
}

// The page, three times: the least.
const bytes = readFileSync(new URL(places["/"], root));
const loads = [];
for (let i = 0; i < 3; ++i) {
  const { page, worked, took } = await opened(`${base}/`, () => document.documentElement.dataset.ready === "yes");
  loads.push([took, await worked()]);
  await page.close();
}
const least = (index) => Math.min(...loads.map((load) => load[index]));

// Points dragged by a script, a frame each: the least of five rounds of sixty.
const { page, worked } = await opened(`${base}/`, () => document.documentElement.dataset.ready === "yes");
async function frame(move) {
  let best = Infinity;
  for (let round = 0; round < 5; ++round) {
    const before = await worked();
    await page.evaluate(move);
    best = Math.min(best, (await worked() - before) / 60);
  }
  return best;
}
const figures = await page.$$eval(".stage", (stages) => stages.map((_, i) => i));
const frames = [];
for (const i of figures) {
  frames.push(await frame(`(async () => {
    const handle = document.querySelectorAll(".stage")[${i}].querySelector(".handle");
    const box = handle.getBoundingClientRect();
    const send = (type, k) => handle.dispatchEvent(new PointerEvent(type, { bubbles: true, pointerId: 1,
      clientX: box.x + 8 + k, clientY: box.y + 8 + k / 2 }));
    handle.setPointerCapture = () => {};
    send("pointerdown", 0);
    for (let k = 0; k < 60; ++k) { send("pointermove", k); handle.ownerSVGElement.getBoundingClientRect(); }
    send("pointerup", 60);
  })()`));
}
const playground = await frame(`(async () => {
  const input = document.getElementById("T-x");
  for (let i = 0; i < 60; ++i) {
    input.value = String(-1 + i / 100);
    input.dispatchEvent(new Event("input"));
    document.body.getBoundingClientRect();
  }
})()`);
await page.close();

// pierce.wasm beside three-mesh-bvh.
const speed = await opened(`${base}/speed.html`, () => globalThis.speedReady);
const rows = [];
for (const hard of [false, true]) {
  const count = await speed.page.evaluate((h) => globalThis.makeRays(h), hard);
  const cost = {};
  for (const what of ["closest", "any", "theirs"]) {
    let best = Infinity;
    for (let i = 0; i < 9; ++i) {
      const before = await speed.worked();
      await speed.page.evaluate((name) => void globalThis[name](), what);
      best = Math.min(best, await speed.worked() - before);
    }
    cost[what] = 1e6 * best / count;
  }
  rows.push({ hard, ...cost, count, wrong: await speed.page.evaluate(() => globalThis.wrong()) });
}
const version = browser.version();
await browser.close();
server.close();

const theirs = JSON.parse(readFileSync(new URL("node_modules/three-mesh-bvh/package.json", root), "utf8")).version;
const MB = (n) => (n / 1e6).toFixed(2);
const us = (ns) => (ns / 1000).toFixed(2);
const least_of = rows.map((row) => (row.theirs / row.closest).toFixed(1));
const text = `Chromium ${version.split(".")[0]} without a GPU, ${cpus()[0].model.replace(/ \d+-Core.*| Processor.*/, "")}, ${new Date().toISOString().slice(0, 10)};
processor time of the page's main thread, which other programs hardly change.

| | |
| --- | ---: |
| the page, one file; the same as a server packs it by gzip | ${MB(bytes.length)} MB; ${MB(gzipSync(bytes, { level: 9 }).length)} MB |
| until it can be used, from a local server: processor; wall clock | ${(least(1) / 1000).toFixed(2)} s; ${(least(0) / 1000).toFixed(2)} s |
| a frame while a chapter's point is dragged: scripts, style, layout | ${Math.min(...frames).toFixed(1)} to ${Math.max(...frames).toFixed(1)} ms |
| a frame while the playground's ray is dragged on the bunny, without painting | ${playground.toFixed(1)} ms |

| rays at the bunny | pierce.wasm, closest | any | three-mesh-bvh ${theirs}, closest | times as long | its wrong answers |
| --- | ---: | ---: | ---: | ---: | ---: |
${rows.map((row, i) => `| ${row.hard ? "at edges and vertices" : "anywhere"} | ${us(row.closest)} us | ${us(row.any)} us | ${us(row.theirs)} us | ${
  least_of[i]} | ${row.wrong.missed} missed, ${row.wrong.invented} invented, ${row.wrong.another} another triangle, of ${row.count} |`).join("\n")}
`;
console.log(text);
assert.ok(bytes.length < 2_000_000, "the page is to be below 2 MB");
assert.ok(rows.every((row) => row.theirs > 3 * row.closest), "pierce.wasm is to be three times as fast");
if (process.argv.includes("--write")) {
  const doc = new URL("../docs/lesson.md", root);
  const [begin, end] = ["<!-- figures: begin (web/tests/figures.mjs) -->", "<!-- figures: end -->"];
  const before = readFileSync(doc, "utf8"), from = before.indexOf(begin), to = before.indexOf(end);
  assert.ok(from >= 0 && to > from, "docs/lesson.md has lost its marks");
  writeFileSync(doc, `${before.slice(0, from)}${begin}\n\n${text}\n${before.slice(to)}`);
}
