// SPDX-License-Identifier: Apache-2.0
//
// pierce.wasm beside three-mesh-bvh in node, one thread each, on the Stanford bunny: the processor's
// time for a ray (which other programs hardly change), and three-mesh-bvh's wrong answers; with TOOL
// (build/release/tool/pierce) also the native library, on one thread, on the same rays.
//
// usage: node --no-liftoff speed.mjs PACKAGE_DIST FOLDER_WITH_NODE_MODULES [TOOL]
// (--no-liftoff: compiled with all optimisation from the start. The folder: web/ after npm ci.)
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { Race, race } from "./race.mjs";

const [dist, folder, tool] = process.argv.slice(2);
const from = (path) => import(pathToFileURL(resolve(path)).href);
const { Pierce } = await from(join(dist, "index.js"));
const pierce = await Pierce.load(readFileSync(resolve(dist, "pierce.wasm")));
const three = await from(join(folder, "node_modules/three/build/three.module.js"));
const meshBvh = await from(join(folder, "node_modules/three-mesh-bvh/src/index.js"));

const mesh = "/usr/share/glmark2/models/bunny.obj", count = 50000;
const contest = new Race({ pierce, three, meshBvh }, readFileSync(mesh, "utf8"), count);

function timed(...what) {
  const start = process.cpuUsage();
  contest.run(...what);
  const { user, system } = process.cpuUsage(start);
  return (user + system) / 1000;
}

/** A file of floats, rows of eight, as NumPy writes them. */
function npy(rays) {
  const head = `{'descr': '<f4', 'fortran_order': False, 'shape': (${rays.length / 8}, 8), }`;
  const text = head.padEnd(117) + "\n";
  return Buffer.concat([Buffer.from("\x93NUMPY\x01\x00\x76\x00", "latin1"), Buffer.from(text), Buffer.from(rays.buffer)]);
}

const files = mkdtempSync(join(tmpdir(), "pierce-"));
for (const [kind, rays] of Object.entries(contest.rays)) writeFileSync(join(files, `${kind}.npy`), npy(rays));
const native = tool && ((query, kind) => JSON.parse(execFileSync(tool, ["cast", mesh, "--rays", join(files, `${kind}.npy`),
  "--query", query, "--threads", "1", "--precision", "float", "--out", join(files, "out.npy"), "--json"],
  { stdio: ["ignore", "pipe", "ignore"] })).seconds);
await race({ timed, wrong: (kind) => contest.wrong(kind), native, count });
rmSync(files, { recursive: true });
