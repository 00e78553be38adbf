// SPDX-License-Identifier: Apache-2.0
//
// An empty page of Debian's Chromium that can import the package and what web/ has of npm's.
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";

const SITE = "http://pierce.test", TYPES = { wasm: "application/wasm", obj: "text/plain" };
const HTML = `<!doctype html><script type="importmap">{ "imports": {
  "three": "/modules/three/build/three.module.js", "three-mesh-bvh": "/modules/three-mesh-bvh/src/index.js",
  "pierce-wasm": "/pierce/index.js" } }</script>`;

/**
 * dist: the package's; folder: one with node_modules, such as web/ after npm ci; places: more folders
 * that the page may fetch from, by their names in the address. No server: what it asks for is read here.
 */
export async function opened(dist, folder, places = {}) {
  const { chromium } = createRequire(pathToFileURL(resolve(folder, "package.json")))("playwright-core");
  const all = { pierce: resolve(dist), modules: resolve(folder, "node_modules"),
                tests: new URL(".", import.meta.url).pathname, ...places };
  const browser = await chromium.launch({ executablePath: "/usr/bin/chromium", args: ["--no-sandbox", "--disable-gpu"] });
  const page = await browser.newPage();
  page.on("pageerror", (error) => { throw error; });
  await page.route(`${SITE}/**`, (route) => {
    const [, place, ...rest] = new URL(route.request().url()).pathname.split("/");
    if (place === "") return route.fulfill({ contentType: "text/html", body: HTML });
    const path = join(all[place] ?? "", ...rest);
    return route.fulfill({ contentType: TYPES[path.split(".").pop()] ?? "text/javascript", body: readFileSync(path) });
  });
  await page.goto(`${SITE}/`);
  return { browser, page };
}
