// SPDX-License-Identifier: Apache-2.0
//
// Answers the cases that same_bytes.py has put into a folder, in Debian's Chromium.
//
// usage: node answer_chromium.mjs PACKAGE_DIST FOLDER FOLDER_WITH_NODE_MODULES   (the last: web/)
import { readFileSync, writeFileSync } from "node:fs";
import { opened } from "./chromium.mjs";

const [dist, folder, modules] = process.argv.slice(2);
const { browser, page } = await opened(dist, modules, { cases: folder });
await page.exposeFunction("kept", (name, base64) =>
  writeFileSync(`${folder}/${name}`, Buffer.from(base64, "base64")));
await page.evaluate(async (cases) => {
  const [{ Pierce }, { Answers }] = await Promise.all(
    ["pierce-wasm", "/tests/answers.mjs"].map((name) => import(name)));
  const bytes = async (path) => (await fetch(path)).arrayBuffer();
  const pierce = await Pierce.load(await bytes("/pierce/pierce.wasm"));
  const answers = new Answers(pierce, (name) => bytes(`/cases/${name}`));
  for (const one of cases) {
    for (const [name, column] of Object.entries(await answers.answer(one))) {
      const all = new Uint8Array(column.buffer, column.byteOffset, column.byteLength), parts = [];
      for (let i = 0; i < all.length; i += 8192) parts.push(String.fromCharCode(...all.subarray(i, i + 8192)));
      await globalThis.kept(`${one.out}.${name}`, btoa(parts.join("")));
    }
  }
}, JSON.parse(readFileSync(`${folder}/cases.json`, "utf8")));
await browser.close();
