// SPDX-License-Identifier: Apache-2.0
//
// What the page costs in Debian's Chromium, from a local server: bytes, the time until it is
// interactive (median of seven loads, each in a fresh context, so that nothing is cached), and a frame
// while the ray is dragged over the bunny. WebGL is drawn by the processor there (SwiftShader), in a
// process of its own: the page's thread is what a graphics card would not take over.
//
// usage: node tests/cost.mjs          (after npm run build; on a quiet machine)
import { readFileSync } from "node:fs";
import { createServer } from "node:http";
import { chromium } from "playwright-core";

const body = readFileSync(new URL("../dist/index.html", import.meta.url));
const server = createServer((_, answer) =>
  answer.writeHead(200, { "content-type": "text/html; charset=utf-8" }).end(body));
await new Promise((listening) => server.listen(0, "127.0.0.1", listening));
const address = `http://127.0.0.1:${server.address().port}/`;
const median = (numbers) => [...numbers].sort((a, b) => a - b)[numbers.length >> 1];

const GL = ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];
const NO_GL = ["--disable-gpu", "--disable-software-rasterizer"];

async function loaded(browser) {
  const context = await browser.newContext({ viewport: { width: 1100, height: 900 } });
  const page = await context.newPage();
  page.setDefaultTimeout(180000);
  await page.addInitScript(() => {
    new MutationObserver(() => (globalThis.readyAt ??= performance.now()))
      .observe(document, { subtree: true, attributeFilter: ["data-ready"] });
  });
  const client = await context.newCDPSession(page);
  await client.send("Performance.enable", { timeDomain: "threadTicks" });
  const thread = async () => (await client.send("Performance.getMetrics")).metrics
    .find(({ name }) => name === "ThreadTime").value * 1000;
  await page.goto(address, { waitUntil: "commit" });
  await page.waitForFunction(() => globalThis.readyAt, null, { polling: 100 });
  return { context, page, thread, ready: await page.evaluate(() => globalThis.readyAt), busy: await thread() };
}

console.log(`dist/index.html: ${body.length} bytes`);
for (const [name, args] of [["without WebGL", NO_GL], ["WebGL on the processor", GL]]) {
  const browser = await chromium.launch({ executablePath: "/usr/bin/chromium", args: ["--no-sandbox", ...args] });
  const ready = [], busy = [];
  for (let i = 0; i < 7; ++i) {
    const load = await loaded(browser);
    ready.push(load.ready);
    busy.push(load.busy);
    if (i < 6) {
      await load.context.close();
      continue;
    }
    // The last page's ray is dragged, a step a frame.
    await load.page.locator("#playground").scrollIntoViewIfNeeded();
    const before = await load.thread(), frames = 60;
    const apart = await load.page.evaluate(async (count) => {
      const input = document.getElementById("T-y"), times = [];
      for (let i = 0; i <= count; ++i) {
        times.push(await new Promise(requestAnimationFrame));
        input.value = String(0.2 + i / 400);
        input.dispatchEvent(new Event("input"));
      }
      return times.slice(1).map((t, i) => t - times[i]);
    }, frames);
    const each = (await load.thread() - before) / frames;
    console.log(`${name}: interactive after ${median(ready).toFixed(0)} ms (its thread was busy for ` +
      `${median(busy).toFixed(0)} ms); a frame while the ray moves: ${each.toFixed(1)} ms of its thread, ` +
      `${median(apart).toFixed(1)} ms apart`);
  }
  await browser.close();
}
server.close();
