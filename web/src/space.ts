// SPDX-License-Identifier: Apache-2.0
//
// The figure that several chapters share: a triangle ABC in space, and the ray from O towards T.
import { type Numbers, Rational, type Trace, type Vec, exact, float32, trace, vectors } from "pierce-wasm";
import type { MethodName } from "pierce-wasm";
import { fraction } from "./chapter.js";
import type { Canvas, Point, Points } from "./stage.js";

export const TRIANGLE: Points = {
  O: [-2, -2, -1.5], T: [-0.5, 0, 0], A: [-2, 0, -1.5], B: [2, 0.5, -1.5], C: [-0.5, 1, 2],
};

export const minus = (p: Point, q: Point): Point => [p[0] - q[0], p[1] - q[1], p[2] - q[2]];
export const along = (p: Point, t: number, d: Point): Point =>
  [p[0] + t * d[0], p[1] + t * d[1], p[2] + t * d[2]];

export function asked<T>(method: MethodName, n: Numbers<T>, p: Points, epsilon = 0): Trace<T> {
  const direction = minus(p.T, p.O) as Vec<number>;
  return trace(method, n, { origin: p.O as Vec<number>, direction },
    [p.A, p.B, p.C] as unknown as [Vec<number>, Vec<number>, Vec<number>], epsilon);
}

export function drawTriangleAndRay(canvas: Canvas, p: Points): void {
  const direction = minus(p.T, p.O);
  const { steps, hit } = asked("determinants", exact, p);
  const t = steps.find((step) => step.name === "t")?.value as Rational | undefined;
  canvas.area([p.A, p.B, p.C], hit ? "hit" : "");
  const end = Math.max(1.6, Math.min(6, t ? t.toNumber() + 0.6 : 3));
  canvas.line(p.O, along(p.O, end, direction), "ray");
  if (t) {
    const at = along(p.O, t.toNumber(), direction);
    canvas.dot(at, hit ? "hit" : "miss");
    canvas.label(at, "P");
  }
}

export function verdictOf(p: Points, method: MethodName = "determinants"): string {
  const right = asked(method, exact, p), rounded = asked(method, float32, p);
  const words = right.hit
    ? `The ray pierces the triangle: t = ${fraction(right.hit.t)}, u = ${fraction(right.hit.u)}, ` +
      `v = ${fraction(right.hit.v)}.`
    : `No hit: ${right.rejected}.`;
  const agree = (right.hit === null) === (rounded.hit === null);
  return agree ? words : `${words} In float the same formulas say the opposite.`;
}

/** t, u and v where the plane is met, over any numbers: one row each. */
export function solve<T>(n: Numbers<T>, p: Record<string, Vec<T>>) {
  const { minus: less, determinant, negated } = vectors(n);
  const a = negated(less(p.T, p.O)), b = less(p.B, p.A), c = less(p.C, p.A), d = less(p.O, p.A);
  const D0 = determinant(a, b, c), Dt = determinant(d, b, c);
  const Du = determinant(a, d, c), Dv = determinant(a, b, d);
  return { D0, Dt, Du, Dv, t: () => n.div(Dt, D0), u: () => n.div(Du, D0), v: () => n.div(Dv, D0) };
}
