// SPDX-License-Identifier: Apache-2.0
//
// Answers the cases that same_bytes.py has put into a folder, in node: each column into a file.
//
// usage: node answer.mjs PACKAGE_DIST FOLDER
import { readFileSync, writeFileSync } from "node:fs";
import { pathToFileURL } from "node:url";
import { Answers } from "./answers.mjs";

const [dist, folder] = process.argv.slice(2);
const { Pierce } = await import(pathToFileURL(`${dist}/index.js`).href);
const pierce = await Pierce.load(readFileSync(`${dist}/pierce.wasm`));
const answers = new Answers(pierce, (name) => {
  const bytes = readFileSync(`${folder}/${name}`);
  return bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length);
});
for (const one of JSON.parse(readFileSync(`${folder}/cases.json`, "utf8"))) {
  for (const [name, column] of Object.entries(await answers.answer(one)))
    writeFileSync(`${folder}/${one.out}.${name}`, column);
}
