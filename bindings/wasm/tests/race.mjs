// SPDX-License-Identifier: Apache-2.0
//
// pierce.wasm and three-mesh-bvh on the same mesh and rays: what speed.mjs runs in node and
// speed_chromium.mjs in a browser. Nothing here asks for either.

export const KINDS = ["camera", "scattered", "hard"];
export const QUERIES = ["closest", "any"];
export const NONE = 0xffffffff;

/** Vertices and corners of an OBJ file of triangles. */
export function meshOf(text) {
  const vertices = [], corners = [];
  for (const line of text.split("\n")) {
    const [kind, ...rest] = line.trim().split(/\s+/);
    if (kind === "v") vertices.push(...rest.slice(0, 3).map(Number));
    if (kind === "f") corners.push(...rest.map((word) => parseInt(word, 10) - 1));
  }
  return { v: Float32Array.from(vertices), f: Uint32Array.from(corners) };
}

/**
 * Rows of eight numbers. camera: a picture of the mesh, row by row (coherent); scattered: from
 * anywhere around it to anywhere in it; hard: the same, to vertices and to points of edges.
 */
export function raysOf(kind, count, { v, f }) {
  let seed = 1;
  const random = () => (seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0) / 2 ** 32;
  const rays = new Float32Array(8 * count), width = Math.ceil(Math.sqrt(count));
  for (let i = 0; i < count; ++i) {
    let origin = [0.3, 0.4, 4], target = [0, 0, 0];
    if (kind === "camera") {
      target = [(2.2 * ((i % width) + 0.5)) / width - 1.1, 1.1 - (2.2 * (Math.floor(i / width) + 0.5)) / width, 0];
    } else {
      origin = [0, 1, 2].map(() => 4 * random() - 2);
      target = [0, 1, 2].map(() => 1.6 * random() - 0.8);
    }
    if (kind === "hard") {
      const t = 3 * Math.floor((random() * f.length) / 3), s = random() < 0.5 ? 0 : random();
      target = [0, 1, 2].map((k) => v[3 * f[t] + k] * (1 - s) + v[3 * f[t + 1] + k] * s);
    }
    rays.set([...origin, ...target.map((x, k) => x - Math.fround(origin[k])), 0, Infinity], 8 * i);
  }
  return rays;
}

/** three-mesh-bvh, built by its surface area heuristic: the tree that it is fastest with. */
function meshBvh(three, { MeshBVH, SAH }, { v, f }) {
  const name = (i, corners) => `${corners[i]},${corners[i + 1]},${corners[i + 2]}`;
  const numbers = new Map();
  for (let i = 0; i < f.length; i += 3) numbers.set(name(i, f), i / 3);
  const geometry = new three.BufferGeometry();
  geometry.setAttribute("position", new three.BufferAttribute(v, 3));
  geometry.setIndex(new three.BufferAttribute(f.slice(), 1));
  const bvh = new MeshBVH(geometry, { strategy: SAH });
  // It puts the triangles into another order.
  const sorted = geometry.index.array, original = new Uint32Array(f.length / 3);
  for (let i = 0; i < f.length; i += 3) original[i / 3] = numbers.get(name(i, sorted));

  const ray = new three.Ray();
  function closest(rays) {
    const found = new Uint32Array(rays.length / 8).fill(NONE);
    for (let i = 0; i < found.length; ++i) {
      ray.origin.fromArray(rays, 8 * i);
      ray.direction.fromArray(rays, 8 * i + 3);
      const hit = bvh.raycastFirst(ray, three.DoubleSide);
      if (hit) found[i] = original[hit.faceIndex];
    }
    return found;
  }
  // It has no query for any hit: the first triangle that its walk over the tree comes to.
  const place = new three.Vector3();
  const callbacks = {
    intersectsBounds: (box) => ray.intersectsBox(box),
    intersectsTriangle: ({ a, b, c }) => ray.intersectTriangle(a, b, c, false, place) !== null,
  };
  function any(rays) {
    const found = new Uint8Array(rays.length / 8);
    for (let i = 0; i < found.length; ++i) {
      ray.origin.fromArray(rays, 8 * i);
      ray.direction.fromArray(rays, 8 * i + 3);
      found[i] = bvh.shapecast(callbacks) ? 1 : 0;
    }
    return found;
  }
  // The same by its query for the closest hit.
  const any_by_closest = (rays) => closest(rays).map((triangle) => triangle === NONE ? 0 : 1);
  return { closest, any, any_by_closest };
}

export class Race {
  /** libraries: pierce (loaded), three, meshBvh (the module). */
  constructor({ pierce, three, meshBvh: module }, text, count) {
    const mesh = meshOf(text);
    this.rays = Object.fromEntries(KINDS.map((kind) => [kind, raysOf(kind, count, mesh)]));
    this.scene = pierce.scene(mesh.v, mesh.f);
    const { closest, any, any_by_closest } = meshBvh(three, module, mesh);
    const scene = this.scene;
    this.runs = {
      pierce: { closest: (rays) => scene.closestHits(rays), any: (rays) => scene.anyHits(rays) },
      three: { closest, any, any_by_closest },
    };
  }

  run(who, query, kind) {
    this.answer = this.runs[who][query](this.rays[kind]);
  }

  /**
   * What three-mesh-bvh answers wrongly. Not counted: another triangle that the ray meets at the same
   * t (rounded) as the first.
   */
  wrong(kind) {
    const rays = this.rays[kind], all = this.scene.allHits(rays);
    const found = this.runs.three.closest(rays), any = this.runs.three.any(rays);
    const told = { missed: 0, invented: 0, another: 0, any: 0 };
    found.forEach((triangle, i) => {
      const [from, to] = [all.offsets[i], all.offsets[i + 1]];
      if (any[i] !== Number(to > from)) ++told.any;
      if (triangle === NONE) told.missed += Number(to > from);
      else if (from === to) ++told.invented;
      else {
        let k = from;
        while (k < to && all.triangle[k] !== triangle) ++k;
        if (k === to || all.t[k] !== all.t[from]) ++told.another;
      }
    });
    return told;
  }
}

export const median = (numbers) => [...numbers].sort((a, b) => a - b)[numbers.length >> 1];

/**
 * Runs everything in turns, so that what else the machine does falls on both, and prints a table:
 * medians, and those of the ratios within a turn. timed(who, query, kind): milliseconds.
 * native(query, kind), if there: seconds by the clock on the wall, as `pierce cast` counts them; of
 * these the least.
 */
export async function race({ timed, wrong, native, count, turns = 9 }) {
  console.log("| rays | query | pierce.wasm, ns a ray | three-mesh-bvh, ns | times as long |" +
    `${native ? " native, ns | wasm to native |" : ""} three-mesh-bvh's wrong answers of ${count} |`);
  console.log(`|---|---|---|---|---|${native ? "---|---|" : ""}---|`);
  for (const kind of KINDS) {
    const told = await wrong(kind);
    for (const query of QUERIES) {
      const theirs = query === "any" ? ["any", "any_by_closest"] : ["closest"];
      const times = { ours: [], native: [] }, other = theirs.map(() => []);
      for (let turn = -2; turn < turns; ++turn) {  // the first two warm up
        const ours = await timed("pierce", query, kind), machine = await native?.(query, kind);
        const took = [];
        for (const name of theirs) took.push(await timed("three", name, kind));
        if (turn < 0) continue;
        times.ours.push(ours);
        times.native.push(machine * 1000);
        took.forEach((ms, i) => other[i].push(ms));
      }
      // Of its two ways to any hit the faster one.
      const best = other.reduce((a, b) => median(a) <= median(b) ? a : b);
      const ns = (ms) => ((ms * 1e6) / count).toFixed(0);
      const ratio = median(best.map((ms, i) => ms / times.ours[i]));
      const least = Math.min(...times.native);
      const beside = native ? ` ${ns(least)} | ${(median(times.ours) / least).toFixed(1)} |` : "";
      console.log(`| ${kind} | ${query} | ${ns(median(times.ours))} | ${ns(median(best))} | ${ratio.toFixed(1)} |` +
        `${beside} ${query === "any" ? `${told.any}`
          : `${told.missed} missed, ${told.invented} invented, ${told.another} another triangle`} |`);
    }
  }
}
