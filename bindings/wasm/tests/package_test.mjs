// SPDX-License-Identifier: Apache-2.0
//
// The npm package in node: fractions, the textbook's methods step by step against the C++ ones and
// against exact fractions, and what is refused.
//
// usage: node package_test.mjs PACKAGE_DIST
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";

const dist = pathToFileURL(resolve(process.argv[2])).href;
const { Pierce, PierceError, Rational, METHODS, NONE, exact, float32, float64, trace } = await import(
  `${dist}/index.js`
);
const pierce = await Pierce.load(readFileSync(new URL(`${dist}/pierce.wasm`)));

let seed = 1;
function random() {
  seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0;
  return seed / 2 ** 32;
}
const whole = (most) => Math.floor(random() * (2 * most + 1)) - most;

function fractions() {
  assert.equal(Rational.from(0.1).toString(), "3602879701896397/36028797018963968");
  assert.equal(Rational.from(-5e-324).toString(), `-1/${2n ** 1074n}`);
  assert.equal(Rational.from(2 ** 1023).above, 2n ** 1023n);
  assert.equal(Rational.parse(" -1.5e1/4").toString(), "-15/4");
  for (const bad of ["", "1/0", "a", "1/2/3", ".", "1e"]) assert.equal(Rational.parse(bad), null);
  for (const x of [1, -0.1, 1e300, 5e-324, 2 ** -1030, 1 / 3]) {
    assert.equal(Rational.from(x).toNumber(), x);
  }
  assert.throws(() => Rational.from(NaN), RangeError);
}

// Rays at hard places of small triangles: vertices, edges, in the plane, and beside them.
function pairs(count, round) {
  const rays = [], triangles = [];
  for (let i = 0; i < count; ++i) {
    const corners = Array.from({ length: 9 }, () => whole(4));
    const weights = [whole(1), whole(1), 1 + whole(1)].map(Math.abs);
    const sum = weights[0] + weights[1] + weights[2] || 1;
    const origin = [whole(5), whole(5), whole(5)];
    const target = [0, 1, 2].map((k) =>
      round((weights[0] * corners[k] + weights[1] * corners[3 + k] + weights[2] * corners[6 + k]) / sum));
    const direction = target.map((x, k) => round(x - origin[k]));
    if (direction.every((x) => x === 0)) direction[0] = 1;
    rays.push(...origin, ...direction, 0, Infinity);
    triangles.push(...corners);
  }
  return { rays, triangles };
}

const NAMES = { moller_trumbore: "moller_trumbore, epsilon 0" };
const three = (numbers, at) => [numbers[at], numbers[at + 1], numbers[at + 2]];

function textbook(Type, numbers) {
  const { rays, triangles } = pairs(3000, numbers.of);
  const givenRays = Type.from(rays), givenTriangles = Type.from(triangles);
  const truth = pierce.ask("exact", givenRays, givenTriangles);
  let hits = 0, wrong = 0;
  for (const method of Object.keys(METHODS)) {
    const answers = pierce.ask(NAMES[method] ?? method, givenRays, givenTriangles);
    for (let i = 0; i < truth.hit.length; ++i) {
      const ray = { origin: three(givenRays, 8 * i), direction: three(givenRays, 8 * i + 3) };
      const corners = [0, 3, 6].map((k) => three(givenTriangles, 9 * i + k));
      const wide = method === "watertight" && numbers === float64;  // long double is not here
      const got = trace(method, numbers, ray, corners);
      if (!wide) {
        assert.equal(got.hit !== null, answers.hit[i] === 1, `${method}, pair ${i}`);
        for (const name of got.hit ? ["t", "u", "v"] : [])
          assert.ok(Object.is(Type.of(got.hit[name])[0], answers[name][i]), `${method} ${name} ${i}`);
      }
      if (got.hit === null) assert.notEqual(got.rejected, "");
      if (i < 400) {
        // Over fractions every method is right, and its numbers round to the exact ones.
        const right = trace(method, exact, ray, corners);
        assert.equal(right.hit !== null, truth.hit[i] === 1, `${method} over fractions, pair ${i}`);
        if (right.hit && method === "determinants" && numbers === float64)
          assert.ok(Math.abs(right.hit.t.toNumber() - truth.t[i]) <= 1e-15 * Math.abs(truth.t[i]));
      }
      hits += answers.hit[i];
      wrong += answers.hit[i] !== truth.hit[i];
    }
  }
  assert.ok(hits > 1000 && wrong > 100, `too easy: ${hits} hits, ${wrong} wrong`);
}

function refused() {
  const square = new Float32Array([0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0]);
  const scene = pierce.scene(square, new Uint32Array([0, 1, 2, 0, 2, 3]), { quality: "high" });
  const ray = [0.25, 0.25, 1, 0, 0, -3, 0, Infinity];
  const rays = new Float32Array([...ray, ...ray]);
  assert.deepEqual([...scene.allHits(rays).triangle], [0, 1, 0, 1]);
  assert.deepEqual([...scene.allHits(rays, { maxHits: 1 }).offsets], [0, 1, 2]);
  rays[13] = 0;
  assert.throws(() => scene.closestHits(rays), (e) =>
    e instanceof PierceError && e.code === "InvalidRay" && e.index === 1 && e.count === 1);
  assert.equal(scene.closestHits(rays, { invalidMiss: true }).triangle[1], NONE);
  assert.throws(() => scene.locate(new Float32Array(3)), { code: "NotClosed" });
  assert.throws(() => scene.closestHits(new Float64Array(8)), TypeError);
  assert.throws(() => scene.closestHits(new Float32Array(7)), RangeError);
  assert.throws(() => scene.anyHits(rays, { sides: "left" }), RangeError);
  assert.throws(() => pierce.scene(square, new Uint32Array([0, 1, 4])), { code: "IndexOutOfRange" });
  assert.equal(scene.info.triangles, 2);
  scene.free();
  assert.throws(() => scene.info, /freed/);
  assert.equal(pierce.scene(new Float64Array(0), new Uint32Array(0)).closestHits(
    new Float64Array(ray)).t[0], Infinity);
  // Memory comes back: a thousand scenes take no more than one.
  for (let i = 0; i < 1000; ++i) pierce.scene(square, new Uint32Array([0, 1, 2])).free();
}

fractions();
textbook(Float32Array, float32);
textbook(Float64Array, float64);
refused();
assert.equal(pierce.version, "0.1.0");
console.log("the package: all as it should be");
