// SPDX-License-Identifier: Apache-2.0
//
// The page in Debian's Chromium, opened from its folder: every chapter's figure is dragged and moved
// by keys, what it then says is held against fractions computed here; exercises are answered; axe-core
// looks for faults in light and dark; pictures are kept to be looked at.
//
// Without WebGL unless LESSON_GL is set: a processor takes seconds for a picture of the bunny, and the
// numbers must all be there without it.
//
// usage: node tests/lesson_test.mjs [FOLDER FOR PICTURES]
import assert from "node:assert/strict";
import { mkdirSync, readFileSync, statSync } from "node:fs";
import { chromium } from "playwright-core";

const file = new URL("../dist/index.html", import.meta.url);
const pictures = process.argv[2] ?? new URL("../../build/lesson", import.meta.url).pathname;
mkdirSync(pictures, { recursive: true });
assert.ok(statSync(file).size < 2_000_000, `${statSync(file).size} bytes: the page is to be below 2 MB`);

const browser = await chromium.launch({ executablePath: "/usr/bin/chromium",
  args: ["--no-sandbox", ...(process.env.LESSON_GL
    ? ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
    : ["--disable-gpu", "--disable-software-rasterizer"])] });
const page = await browser.newPage({ viewport: { width: 1100, height: 900 }, colorScheme: "light" });
page.setDefaultTimeout(180000);
const faults = [], asked = [];
page.on("pageerror", (error) => faults.push(String(error)));
page.on("console", (message) => message.type() === "error" && !/WebGL/.test(message.text()) && faults.push(message.text()));
page.on("request", (request) => asked.push(request.url()));

const started = Date.now();
await page.goto(file.href, { waitUntil: "commit" });
await page.waitForFunction(() => document.documentElement.dataset.ready, null, { polling: 300 });
const ready = Date.now() - started;
assert.equal(await page.evaluate(() => document.documentElement.dataset.ready), "yes");
assert.deepEqual(asked.filter((url) => /^https?:/.test(url)), [], "the page asks the network for something");

// Fractions of our own: [above, below].
const gcd = (a, b) => (b === 0n ? (a < 0n ? -a : a) : gcd(b, a % b));
const q = (a, b = 1n) => {
  const g = gcd(a, b) * (b < 0n ? -1n : 1n);
  return [a / g, b / g];
};
const of = (x) => q(BigInt(x * 1024), 1024n);
const add = ([a, b], [c, d]) => q(a * d + c * b, b * d);
const sub = ([a, b], [c, d]) => q(a * d - c * b, b * d);
const mul = ([a, b], [c, d]) => q(a * c, b * d);
const over = ([a, b], [c, d]) => q(a * d, b * c);
const shown = ([a, b]) => (b === 1n ? `${a}` : `${a}/${b}`);
const minus = (p, r) => p.map((x, i) => sub(x, r[i]));
const dot = (p, r) => p.map((x, i) => mul(x, r[i])).reduce(add);
const cross = (p, r) => [0, 1, 2].map((i) => [(i + 1) % 3, (i + 2) % 3]).map(
  ([j, k]) => sub(mul(p[j], r[k]), mul(p[k], r[j])));

async function points(id) {
  const labels = await page.$$eval(`#figure-${id} .handle`, (handles) =>
    handles.map((handle) => [handle.dataset.point, handle.getAttribute("aria-label")]));
  return Object.fromEntries(labels.map(([name, label]) => {
    const numbers = label.match(/at (.*); arrow/)[1].split(",").map(Number);
    return [name, [...numbers, 0].slice(0, 3).map(of)];
  }));
}

function pierced({ O, T, A, B, C }) {
  const d = minus(T, O), e1 = minus(B, A), e2 = minus(C, A), n = cross(e1, e2), s = minus(O, A);
  const below = sub(of(0), dot(n, d)), m = cross(s, d);
  return { t: over(dot(n, s), below), u: over(dot(m, e2), below),
           v: over(sub(of(0), dot(m, e1)), below) };
}
function weighed({ A, B, C, P }) {
  const flat = (a, b, c) => sub(mul(sub(b[0], a[0]), sub(c[1], a[1])), mul(sub(b[1], a[1]), sub(c[0], a[0])));
  const area = flat(A, B, C);
  return { w: over(flat(P, B, C), area), u: over(flat(A, P, C), area), v: over(flat(A, B, P), area) };
}
function dropped({ O, T, X }) {
  const d = minus(T, O);
  return { t: over(dot(minus(X, O), d), dot(d, d)) };
}

// chapter -> the truth, and how its table calls what
const space = { "$t$": "t", "$u$": "u", "$v$": "v" };
const chapters = {
  ray: [dropped, { "$t$": "t" }],
  barycentric: [weighed, { "$w$ (A)": "w", "$u$ (B)": "u", "$v$ (C)": "v" }],
  plane: [pierced, { "$t$": "t" }],
  equations: [pierced, { "$t$ by Gauss": "t", "$u$ by Gauss": "u", "$v$ by Gauss": "v",
                         "$t$ by Cramer": "t", "$u$ by Cramer": "u", "$v$ by Cramer": "v" }],
  determinants: [pierced, { t: "t", beta: "u", gamma: "v" }],
  volumes: [pierced, space],
  normal: [pierced, space],
  interpolation: [weighed, { "$w$": "w", "$u$": "u", "$v$": "v" }],
};

let numbers = 0;
async function held(id) {
  const [truth, names] = chapters[id];
  const expected = truth(await points(id));
  for (const [row, name] of Object.entries(names)) {
    const cell = await page.$(`#figure-${id} [data-exact="${row}"]`);
    if (!cell && id === "determinants") continue;  // it has left before
    assert.equal(await cell.getAttribute("data-fraction"), shown(expected[name]), `${id}: ${row}`);
    const rounded = Number(await page.textContent(`#figure-${id} [data-float="${row}"]`));
    const exact = Number(expected[name][0]) / Number(expected[name][1]);
    assert.ok(Math.abs(rounded - exact) <= 1e-5 * (1 + Math.abs(exact)), `${id}: ${row} in float`);
    ++numbers;
  }
}

async function dragged(selector, by) {
  const handle = await page.$(selector);
  await handle.scrollIntoViewIfNeeded();
  const box = await (await handle.$("circle:nth-child(2)")).boundingBox();
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  const before = await handle.getAttribute("aria-label");
  await page.mouse.move(x, y);
  await page.mouse.down();
  for (let i = 1; i <= 4; ++i) await page.mouse.move(x + (by[0] * i) / 4, y + (by[1] * i) / 4);
  await page.mouse.up();
  assert.notEqual(await handle.getAttribute("aria-label"), before, `${selector} does not move`);
}

for (const id of Object.keys(chapters)) {
  await held(id);
  const names = await page.$$eval(`#figure-${id} .handle`, (handles) => handles.map((x) => x.dataset.point));
  for (const [i, name] of names.entries()) {
    await dragged(`#figure-${id} [data-point="${name}"]`, [23 - 11 * i, i % 2 ? 31 : -27]);
    await held(id);
  }
  await page.focus(`#figure-${id} [data-point="${names[0]}"]`);
  const before = await points(id);
  await page.keyboard.press("ArrowRight");
  const after = await points(id);
  assert.ok(shown(sub(after[names[0]][0], before[names[0]][0])).startsWith("1"), `${id}: ArrowRight`);
  await held(id);
}

// Chapter 7: at epsilon 1e-8 nearly all are there, at 1 they are gone.
const gone = async () => Number((await page.textContent("[data-verdict=moller]")).match(/(\d+) of 24/)?.[1] ?? 0);
const epsilon = "#figure-moller [data-point=epsilon]";
const start = await gone();
await dragged(epsilon, [140, 0]);
assert.ok((await gone()) > start, "a larger epsilon loses no more triangles");
await page.focus(epsilon);
for (let i = 0; i < 40; ++i) await page.keyboard.press("ArrowLeft");
assert.equal(await gone(), 0, "epsilon 1e-8 loses triangles of area 1e-7");

// Chapter 10: some method loses rays, pierce never does, wherever the origin is.
let lost = 0;
for (const by of [[60, 20], [-80, 30], [45, -25]]) {
  await dragged("#figure-rounding [data-point=O]", by);
  assert.equal(await page.textContent("[data-lost=pierce]"), "0");
  assert.equal(await page.textContent("[data-wrong=pierce]"), "0");
  assert.equal(await page.textContent("[data-lost=watertight]"), "0");
  for (const cell of await page.$$eval("[data-lost]", (cells) => cells.map((c) => Number(c.textContent)))) lost += cell;
}
assert.ok(lost > 0, "no method loses a ray: the figure shows nothing");

// The laboratory of chapter 4.
await page.click(".laboratory button");
assert.equal(await page.locator("[data-wrong=Gauss]").count(), 3);

// Exercises: a wrong answer, and the right ones as the sources have them.
const sources = ["ray", "barycentric", "plane", "equations", "determinants", "volumes", "moller", "normal",
  "interpolation", "rounding"];
for (const id of sources) {
  const source = readFileSync(new URL(`../src/chapters/${id}.ts`, import.meta.url), "utf8");
  const answers = [...source.matchAll(/answer: (?:"([^"]+)"|String)/g)].map((m) => m[1] ?? "1/4");
  assert.equal(await page.locator(`#${id} form`).count(), answers.length);
  for (const [i, answer] of answers.entries()) {
    const form = page.locator(`#${id} form`).nth(i);
    await form.locator("input").fill("17/19");
    await form.locator("button").click();
    assert.ok(await form.locator(".said.wrong").count(), `${id} ${i}: 17/19 is taken for right`);
    await form.locator("input").fill(answer);
    await form.locator("button").click();
    assert.equal(await form.locator(".said").textContent(), "Right.", `${id} ${i}`);
  }
}

// The playground: numbers, a drag, the heat map, a dropped mesh, the link.
const told = () => page.textContent("[data-verdict=playground]");
assert.match(await told(), /^\d+ hits, \d+ passages/);
assert.match(await told(), /O is outside/);
await page.fill("#X-x", "0");
await page.fill("#X-y", "0");
await page.fill("#X-z", "0");
assert.match(await told(), /X is inside/);
await page.selectOption("#heat-method", "moller_trumbore");
const heat = await page.textContent(".heat-told");
assert.ok(Number(heat.match(/: (\d+) of/)[1]) > 1000, heat);
await page.waitForTimeout(400);
const link = page.url();
assert.match(link, /X=0,0,0/);
assert.match(link, /method=moller_trumbore/);
for (const [i, scheme] of ["light", "dark"].entries()) {
  await page.emulateMedia({ colorScheme: scheme });
  await page.evaluate(readFileSync(new URL("../node_modules/axe-core/axe.min.js", import.meta.url), "utf8"));
  const { violations } = await page.evaluate(() => globalThis.axe.run());
  const said = violations.map((v) => `${v.id}: ${v.help} (${v.nodes.length}) ${v.nodes[0].html.slice(0, 160)} ${v.nodes[0].failureSummary}`);
  assert.deepEqual(said, [], `axe-core, ${scheme}`);
  for (const id of [...sources, "playground"]) {
    await page.locator(`#${id}`).scrollIntoViewIfNeeded();
    if (i === 0 || ["barycentric", "playground", "volumes"].includes(id))
      await page.locator(`#${id}`).screenshot({ path: `${pictures}/${scheme}_${id}.png` });
  }
}
await page.emulateMedia({ colorScheme: "light" });

// On a telephone nothing sticks out, and every handle can be reached by a finger.
await page.setViewportSize({ width: 390, height: 800 });
assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), 390, "wider than 390 pixels");
for (const id of [...sources, "playground"]) {
  await page.locator(`#${id}`).screenshot({ path: `${pictures}/narrow_${id}.png` });
  for (const size of await page.$$eval(`#${id} .handle .halo`, (all) => all.map((x) => x.getBoundingClientRect().width)))
    assert.ok(size >= 30, `${id}: a handle is ${size} pixels wide`);
}
await page.setViewportSize({ width: 1100, height: 900 });

// Frames while the ray is moved, as fast as the page lets us.
const frame = await page.evaluate(async () => {
  const input = document.getElementById("T-x");
  const begin = performance.now();
  for (let i = 0; i < 60; ++i) {
    input.value = String(-1 + i / 100);
    input.dispatchEvent(new Event("input"));
  }
  return (performance.now() - begin) / 60;
});

const cube = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
// A file is read while the page goes on.
const tells = (pattern) => page.waitForFunction(
  (source) => new RegExp(source).test(document.querySelector("[data-verdict=playground]").textContent),
  pattern.source, { polling: 100, timeout: 20000 });
await page.setInputFiles("#mesh-file", { name: "corner.obj", mimeType: "text/plain", buffer: Buffer.from(cube) });
await tells(/nearest at triangle [0-3]\./);
await page.setInputFiles("#mesh-file", { name: "corner.xyz", mimeType: "text/plain", buffer: Buffer.from(cube) });
await tells(/give a file named/);

const again = await browser.newPage();
again.setDefaultTimeout(180000);
await again.goto(link, { waitUntil: "commit" });
await again.waitForFunction(() => document.documentElement.dataset.ready, null, { polling: 300 });
assert.equal(await again.inputValue("#X-y"), "0");
assert.equal(await again.inputValue("#heat-method"), "moller_trumbore");
assert.deepEqual(faults, []);
await browser.close();
console.log(`the lesson: ${numbers} numbers held against fractions, ready after ${ready} ms, ` +
  `${frame.toFixed(1)} ms for a ray that moves on the bunny, pictures in ${pictures}`);
