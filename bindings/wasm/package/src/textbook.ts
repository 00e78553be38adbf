// SPDX-License-Identifier: Apache-2.0
//
// The textbook's methods, step by step, over floats, doubles or exact fractions: what the headers in
// include/pierce/textbook compute, in the same order, with every value on the way.
import { Numbers, Vec, vectors } from "./numbers.js";

export type MethodName =
  | "cramer"
  | "determinants"
  | "plane_then_edges"
  | "plane_then_barycentric"
  | "moller_trumbore"
  | "precomputed_normal"
  | "watertight"
  | "baldwin_weber";

/** A value on the way: a number or a vector. */
export interface Step<T> {
  name: string;
  value: T | Vec<T>;
}

export interface Trace<T> {
  hit: { t: T; u: T; v: T } | null;
  /** The test that said no; "" for a hit. */
  rejected: string;
  steps: Step<T>[];
}

export interface TraceRay {
  origin: Vec<number>;
  direction: Vec<number>;
}

/** The ends of the range are 0 and infinity; epsilon is moller_trumbore's. */
export function trace<T>(
  method: MethodName,
  numbers: Numbers<T>,
  ray: TraceRay,
  corners: readonly [Vec<number>, Vec<number>, Vec<number>],
  epsilon = 0,
): Trace<T> {
  const of = (p: Vec<number>) => p.map(numbers.of) as unknown as Vec<T>;
  const recorder = new Recorder(numbers, of(ray.origin), of(ray.direction), epsilon);
  const [a, b, c] = corners.map(of);
  try {
    const hit = METHODS[method](recorder as Recorder<unknown>, a, b, c) as Trace<T>["hit"];
    return { hit, rejected: "", steps: recorder.steps };
  } catch (e) {
    if (!(e instanceof Rejected)) throw e;
    return { hit: null, rejected: e.message, steps: recorder.steps };
  }
}

class Rejected extends Error {}

class Recorder<T> {
  readonly steps: Step<T>[] = [];
  readonly zero: T;
  readonly one: T;
  readonly v;
  constructor(
    readonly n: Numbers<T>,
    readonly o: Vec<T>,
    readonly d: Vec<T>,
    readonly epsilon: number,
  ) {
    this.zero = n.of(0);
    this.one = n.of(1);
    this.v = vectors(n);
  }
  keep<V extends T | Vec<T>>(name: string, value: V): V {
    this.steps.push({ name, value });
    return value;
  }
  reject(when: boolean, why: string): void {
    if (when) throw new Rejected(why);
  }
  less(x: T, y: T): boolean {
    return this.n.compare(x, y) < 0;
  }
  negative(x: T): boolean {
    return this.less(x, this.zero);
  }
  parallel(x: T, name: string): T {
    this.reject(this.n.compare(x, this.zero) === 0, `${name} = 0`);
    return x;
  }
  inRange(t: T): T {
    this.keep("t", t);
    this.reject(!(this.n.compare(this.zero, t) <= 0), "t < 0");
    return t;
  }
  /** u in [0, 1], then v >= 0 and u + v <= 1. */
  insideU(u: T): T {
    this.keep("u", u);
    this.reject(this.negative(u), "u < 0");
    this.reject(this.less(this.one, u), "u > 1");
    return u;
  }
  insideV(u: T, v: T): T {
    this.keep("v", v);
    this.reject(this.negative(v), "v < 0");
    this.reject(this.less(this.one, this.n.add(u, v)), "u + v > 1");
    return v;
  }
}

type Method = <T>(r: Recorder<T>, a: Vec<T>, b: Vec<T>, c: Vec<T>) => { t: T; u: T; v: T };

const cramer: Method = (r, pa, pb, pc) => {
  const { add, sub, mul, div } = r.n;
  const [a, b, c] = r.keep("A - B", r.v.minus(pa, pb));
  const [d, e, f] = r.keep("A - C", r.v.minus(pa, pc));
  const [g, h, i] = r.d;
  const [j, k, l] = r.keep("A - O", r.v.minus(pa, r.o));
  const eihf = r.keep("ei - hf", sub(mul(e, i), mul(h, f)));
  const gfdi = r.keep("gf - di", sub(mul(g, f), mul(d, i)));
  const dheg = r.keep("dh - eg", sub(mul(d, h), mul(e, g)));
  const m = r.keep("M", add(add(mul(a, eihf), mul(b, gfdi)), mul(c, dheg)));
  r.parallel(m, "M");
  const akjb = r.keep("ak - jb", sub(mul(a, k), mul(j, b)));
  const jcal = r.keep("jc - al", sub(mul(j, c), mul(a, l)));
  const blkc = r.keep("bl - kc", sub(mul(b, l), mul(k, c)));
  const above = add(add(mul(f, akjb), mul(e, jcal)), mul(d, blkc));
  const t = r.inRange(div(mul(r.n.of(-1), above), m));
  const gamma = r.keep("gamma", div(add(add(mul(i, akjb), mul(h, jcal)), mul(g, blkc)), m));
  r.reject(r.negative(gamma), "gamma < 0");
  r.reject(r.less(r.one, gamma), "gamma > 1");
  const beta = r.keep("beta", div(add(add(mul(j, eihf), mul(k, gfdi)), mul(l, dheg)), m));
  r.reject(r.negative(beta), "beta < 0");
  r.reject(r.less(sub(r.one, gamma), beta), "beta > 1 - gamma");
  return { t, u: beta, v: gamma };
};

const determinants: Method = (r, p0, p1, p2) => {
  const a = r.keep("A = -Q", r.v.negated(r.d));
  const b = r.keep("B = P1 - P0", r.v.minus(p1, p0));
  const c = r.keep("C = P2 - P0", r.v.minus(p2, p0));
  const d = r.keep("D = S - P0", r.v.minus(r.o, p0));
  const d0 = r.parallel(r.keep("D0", r.v.determinant(a, b, c)), "D0");
  const t = r.inRange(r.n.div(r.keep("Dt", r.v.determinant(d, b, c)), d0));
  const u = r.insideU(r.n.div(r.keep("Du", r.v.determinant(a, d, c)), d0));
  const v = r.insideV(u, r.n.div(r.keep("Dv", r.v.determinant(a, b, d)), d0));
  return { t, u, v };
};

const planeThenEdges: Method = (r, a, b, c) => {
  const { div } = r.n;
  const { minus, dot, cross, plus, scaled } = r.v;
  const normal = r.keep("N", cross(minus(b, a), minus(c, a)));
  const nd = r.parallel(r.keep("N.D", dot(normal, r.d)), "N.D");
  const t = r.inRange(div(r.keep("N.(A - O)", dot(normal, minus(a, r.o))), nd));
  const p = r.keep("P", plus(r.o, scaled(t, r.d)));
  const side = (name: string, from: Vec<unknown>, to: Vec<unknown>) => {
    const value = dot(normal, cross(minus(to as never, from as never), minus(p, from as never)));
    r.keep(name, value);
    r.reject(r.negative(value), `${name} < 0`);
    return value;
  };
  const ab = side("side of AB", a, b);
  side("side of BC", b, c);
  const ca = side("side of CA", c, a);
  const nn = r.keep("N.N", dot(normal, normal));
  return { t, u: r.keep("u", div(ca, nn)), v: r.keep("v", div(ab, nn)) };
};

const planeThenBarycentric: Method = (r, a, b, c) => {
  const { div, sub, mul } = r.n;
  const { minus, dot, cross, plus, scaled } = r.v;
  const e1 = r.keep("E1", minus(b, a)), e2 = r.keep("E2", minus(c, a));
  const normal = r.keep("N", cross(e1, e2));
  const nd = r.parallel(r.keep("N.D", dot(normal, r.d)), "N.D");
  const t = r.inRange(div(r.keep("N.(A - O)", dot(normal, minus(a, r.o))), nd));
  const p = r.keep("P - A", minus(plus(r.o, scaled(t, r.d)), a));
  const dropped = r.v.longestAxis(normal), x = (dropped + 1) % 3, y = (dropped + 2) % 3;
  const flat = (q: typeof p, s: typeof p) => sub(mul(q[x], s[y]), mul(q[y], s[x]));
  const area = normal[dropped];
  const u = div(flat(p, e2), area);
  r.keep("u", u);
  r.reject(r.negative(u), "u < 0");
  const v = r.insideV(u, div(flat(e1, p), area));
  return { t, u, v };
};

const mollerTrumbore: Method = (r, a, b, c) => {
  const { div, mul } = r.n;
  const { minus, dot, cross } = r.v;
  const e1 = r.keep("e1 = B - A", minus(b, a)), e2 = r.keep("e2 = C - A", minus(c, a));
  const q = r.keep("q = d x e2", cross(r.d, e2));
  const det = r.parallel(r.keep("e1.q", dot(e1, q)), "e1.q");
  const limit = r.n.of(r.epsilon);
  const small = r.less(r.n.sub(r.zero, limit), det) && r.less(det, limit);
  r.reject(small, "|e1.q| < epsilon");
  const f = r.keep("f = 1 / e1.q", div(r.one, det));
  const s = r.keep("s = O - A", minus(r.o, a));
  const u = r.insideU(mul(f, dot(s, q)));
  const w = r.keep("r = s x e1", cross(s, e1));
  const v = r.insideV(u, mul(f, dot(w, r.d)));
  const t = r.inRange(mul(f, dot(w, e2)));
  return { t, u, v };
};

const precomputedNormal: Method = (r, a, b, c) => {
  const { div, mul } = r.n;
  const { minus, dot, cross } = r.v;
  const e1 = r.keep("e1", minus(b, a)), e2 = r.keep("e2", minus(c, a));
  const normal = r.keep("n = e1 x e2", cross(e1, e2));
  const minusOne = r.n.of(-1);
  const nd = r.parallel(r.keep("-n.d", mul(minusOne, dot(normal, r.d))), "-n.d");
  const s = r.keep("s = O - A", minus(r.o, a));
  const t = r.inRange(div(dot(normal, s), nd));
  const m = r.keep("m = s x d", cross(s, r.d));
  const u = r.insideU(div(dot(m, e2), nd));
  const v = r.insideV(u, div(mul(minusOne, dot(m, e1)), nd));
  return { t, u, v };
};

// (Where a product of the sheared corners comes out 0 over floats, the headers compute it again in
// the next wider type. Here a double is that type for floats; doubles stay doubles.)
const watertight: Method = (r, pa, pb, pc) => {
  const { add, sub, mul, div } = r.n;
  const kz = r.v.longestAxis(r.d);
  let kx = (kz + 1) % 3, ky = (kz + 2) % 3;
  if (r.negative(r.d[kz])) [kx, ky] = [ky, kx];
  const sx = r.keep("Sx", div(r.d[kx], r.d[kz])), sy = r.keep("Sy", div(r.d[ky], r.d[kz]));
  const sz = r.keep("Sz", div(r.one, r.d[kz]));
  const shear = (name: string, p: typeof pa) => {
    const q = r.v.minus(p, r.o);
    const x = r.keep(`${name}x`, sub(q[kx], mul(sx, q[kz])));
    const y = r.keep(`${name}y`, sub(q[ky], mul(sy, q[kz])));
    return { x, y, z: q[kz] };
  };
  const a = shear("A", pa), b = shear("B", pb), c = shear("C", pc);
  type Sheared = typeof a;
  const edge = (p: Sheared, q: Sheared) => sub(mul(p.x, q.y), mul(p.y, q.x));
  let u = edge(c, b), v = edge(a, c), w = edge(b, a);
  const isZero = (x: typeof u) => r.n.compare(x, r.zero) === 0;
  if ((isZero(u) || isZero(v) || isZero(w)) && typeof u === "number") {
    const wide = (p: Sheared, q: Sheared) =>
      r.n.of((p.x as number) * (q.y as number) - (p.y as number) * (q.x as number));
    [u, v, w] = [wide(c, b), wide(a, c), wide(b, a)];
  }
  r.keep("U", u), r.keep("V", v), r.keep("W", w);
  const all = [u, v, w];
  r.reject(all.some((x) => r.negative(x)) && all.some((x) => r.less(r.zero, x)), "signs differ");
  const det = r.parallel(r.keep("det", add(add(u, v), w)), "det");
  const f = div(r.one, det);
  const [az, bz, cz] = [a, b, c].map((p) => mul(sz, p.z));
  const t = r.inRange(mul(add(add(mul(u, az), mul(v, bz)), mul(w, cz)), f));
  return { t, u: r.keep("u", mul(v, f)), v: r.keep("v", mul(w, f)) };
};

const baldwinWeber: Method = (r, a, b, c) => {
  const { add, mul, div } = r.n;
  const minusOne = r.n.of(-1);
  const negated = (x: typeof r.zero) => mul(minusOne, x);
  const e1 = r.v.minus(b, a), e2 = r.v.minus(c, a);
  const normal = r.keep("N", r.v.cross(e1, e2));
  const k = r.v.longestAxis(normal), i = (k + 1) % 3, j = (k + 2) % 3;
  const nk = r.parallel(normal[k], "N");
  const u0 = div(e2[j], nk), u1 = div(negated(e2[i]), nk);
  const v0 = div(negated(e1[j]), nk), v1 = div(e1[i], nk);
  const z0 = div(normal[i], nk), z1 = div(normal[j], nk);
  const u2 = negated(add(mul(u0, a[i]), mul(u1, a[j])));
  const v2 = negated(add(mul(v0, a[i]), mul(v1, a[j])));
  const z2 = negated(add(add(a[k], mul(z0, a[i])), mul(z1, a[j])));
  r.keep("map to u", [u0, u1, u2]), r.keep("map to v", [v0, v1, v2]);
  r.keep("map to z", [z0, z1, z2]);
  const zd = r.keep("z(d)", add(add(r.d[k], mul(z0, r.d[i])), mul(z1, r.d[j])));
  r.parallel(zd, "z(d)");
  const zo = r.keep("z(o)", add(add(add(r.o[k], mul(z0, r.o[i])), mul(z1, r.o[j])), z2));
  const t = r.inRange(div(negated(zo), zd));
  const pi = add(r.o[i], mul(t, r.d[i])), pj = add(r.o[j], mul(t, r.d[j]));
  const u = r.insideU(add(add(mul(u0, pi), mul(u1, pj)), u2));
  const v = r.insideV(u, add(add(mul(v0, pi), mul(v1, pj)), v2));
  return { t, u, v };
};

export const METHODS: Record<MethodName, Method> = {
  cramer,
  determinants,
  plane_then_edges: planeThenEdges,
  plane_then_barycentric: planeThenBarycentric,
  moller_trumbore: mollerTrumbore,
  precomputed_normal: precomputedNormal,
  watertight,
  baldwin_weber: baldwinWeber,
};
