// SPDX-License-Identifier: Apache-2.0
//
// Answers the cases that same_bytes.py has put into a folder: each column into a file.
import { readFileSync, writeFileSync } from "node:fs";
import { pathToFileURL } from "node:url";

const [dist, folder] = process.argv.slice(2);
const { Pierce } = await import(pathToFileURL(`${dist}/index.js`).href);
const pierce = await Pierce.load(readFileSync(`${dist}/pierce.wasm`));

function numbers(stem, part, Type) {
  const bytes = readFileSync(`${folder}/${stem}.${part}`);
  return new Type(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length));
}

const scenes = new Map();
function sceneOf(stem) {
  if (!scenes.has(stem)) {
    const Type = stem.endsWith("f8") ? Float64Array : Float32Array;
    const scene = pierce.scene(numbers(stem, "vertices", Type), numbers(stem, "triangles", Uint32Array));
    scenes.set(stem, { scene, rays: numbers(stem, "rays", Type), points: numbers(stem, "points", Type) });
  }
  return scenes.get(stem);
}

function answer({ stem, words }) {
  const { scene, rays, points } = sceneOf(stem);
  const openMesh = words.includes("--open-mesh");
  if (words[0] === "locate") return { "": scene.locate(points, { openMesh }) };
  if (words.includes("--signed")) return { "": scene.signedDistances(points, { openMesh }) };
  if (words[0] === "nearest") return scene.nearestPoints(points);
  switch (words[2]) {
    case "closest":
      return scene.closestHits(rays, { sides: words.includes("front") ? "front" : "both" });
    case "all":
      return scene.allHits(rays);
    case "crossings":
      return scene.crossings(rays);
    case "count":
      return { "": scene.countHits(rays) };
    default:
      return { "": scene.anyHits(rays) };
  }
}

for (const one of JSON.parse(readFileSync(`${folder}/cases.json`, "utf8"))) {
  for (const [name, column] of Object.entries(answer(one)))
    writeFileSync(`${folder}/${one.out}.${name}`, column);
}
