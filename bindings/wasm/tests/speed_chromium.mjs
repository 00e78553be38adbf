// SPDX-License-Identifier: Apache-2.0
//
// pierce.wasm beside three-mesh-bvh in one page of Debian's Chromium, as speed.mjs has them beside one
// another in node. The time is that of the page's thread (Chromium's ThreadTime), which other programs
// hardly change.
//
// usage: node speed_chromium.mjs PACKAGE_DIST FOLDER_WITH_NODE_MODULES   (the folder: web/ after npm ci)
import { opened } from "./chromium.mjs";
import { race } from "./race.mjs";

const count = 50000;
const { browser, page } = await opened(...process.argv.slice(2), { models: "/usr/share/glmark2/models" });
await page.evaluate(async (rays) => {
  const [{ Pierce }, three, meshBvh, { Race }] = await Promise.all(
    ["pierce-wasm", "three", "three-mesh-bvh", "/tests/race.mjs"].map((name) => import(name)));
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
