// SPDX-License-Identifier: Apache-2.0
//
// pierce.wasm beside three-mesh-bvh in one page of Debian's Chromium, as speed.mjs has them beside one
// another in node. The time is that of the page's thread (Chromium's ThreadTime), which other programs
// hardly change.
//
// usage: node speed_chromium.mjs PACKAGE_DIST FOLDER_WITH_NODE_MODULES   (the folder: web/ after npm ci)
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { race } from "./race.mjs";

const [dist, folder] = process.argv.slice(2).map((path) => resolve(path));
const { chromium } = createRequire(pathToFileURL(join(folder, "package.json")))("playwright-core");
const count = 50000, site = "http://pierce.test";
const places = { pierce: dist, modules: join(folder, "node_modules"), tests: import.meta.dirname,
  models: "/usr/share/glmark2/models" };
const html = `<!doctype html><script type="importmap">{ "imports": {
  "three": "/modules/three/build/three.module.js", "three-mesh-bvh": "/modules/three-mesh-bvh/src/index.js",
  "pierce-wasm": "/pierce/index.js", "race": "/tests/race.mjs" } }</script>`;

const browser = await chromium.launch({ executablePath: "/usr/bin/chromium", args: ["--no-sandbox", "--disable-gpu"] });
const page = await browser.newPage();
page.on("pageerror", (error) => { throw error; });
// No server: what the page asks for is read from here.
await page.route(`${site}/**`, (route) => {
  const [, place, ...rest] = new URL(route.request().url()).pathname.split("/");
  const types = { wasm: "application/wasm", obj: "text/plain" };
  if (place === "") return route.fulfill({ contentType: "text/html", body: html });
  const path = join(places[place] ?? "", ...rest);
  return route.fulfill({ contentType: types[path.split(".").pop()] ?? "text/javascript", body: readFileSync(path) });
});
await page.goto(`${site}/`);
await page.evaluate(async (rays) => {
  const [{ Pierce }, three, meshBvh, { Race }] = await Promise.all(
    ["pierce-wasm", "three", "three-mesh-bvh", "race"].map((name) => import(name)));
  const pierce = await Pierce.load(await (await fetch("/pierce/pierce.wasm")).arrayBuffer());
  const text = await (await fetch("/models/bunny.obj")).text();
  globalThis.contest = new Race({ pierce, three, meshBvh }, text, rays);
}, count);

const client = await page.context().newCDPSession(page);
await client.send("Performance.enable", { timeDomain: "threadTicks" });
async function clock() {
  const { metrics } = await client.send("Performance.getMetrics");
  return metrics.find(({ name }) => name === "ThreadTime").value * 1000;
}
async function timed(...what) {
  const start = await clock();
  await page.evaluate((words) => globalThis.contest.run(...words), what);
  return await clock() - start;
}
console.log(`Chromium ${browser.version()}`);
await race({ timed, wrong: (kind) => page.evaluate((name) => globalThis.contest.wrong(name), kind), count });
await browser.close();
