// SPDX-License-Identifier: Apache-2.0
// Chapter 2: barycentric coordinates.
import { type Numbers, Rational, type Vec, exact } from "pierce-wasm";
import { type Chapter, exercises, figure, math, paragraph, shown } from "../chapter.js";

type Three = "u" | "v" | "w";

/** Areas over the whole area: u belongs to B, v to C, w to A. */
function weights<T>(n: Numbers<T>, p: Record<string, Vec<T>>): Record<Three | "area", T> {
  const flat = (a: Vec<T>, b: Vec<T>, c: Vec<T>) =>
    n.sub(n.mul(n.sub(b[0], a[0]), n.sub(c[1], a[1])), n.mul(n.sub(b[1], a[1]), n.sub(c[0], a[0])));
  const area = flat(p.A, p.B, p.C);
  return { area, w: n.div(flat(p.P, p.B, p.C), area), u: n.div(flat(p.A, p.P, p.C), area),
           v: n.div(flat(p.A, p.B, p.P), area) };
}

function region(signs: Record<Three, number>): string {
  const zeros = (Object.keys(signs) as Three[]).filter((name) => signs[name] === 0);
  const beyond = (Object.keys(signs) as Three[]).filter((name) => signs[name] < 0);
  const corner = { w: "A", u: "B", v: "C" }, edge = { w: "BC", u: "CA", v: "AB" };
  if (zeros.length === 2) {
    const last = (Object.keys(signs) as Three[]).find((name) => signs[name] !== 0)!;
    return `P is the corner ${corner[last]}: two coordinates are 0, the third is 1.`;
  }
  const on = zeros.length ? ` It lies on the line ${edge[zeros[0]]}, where ${zeros[0]} is 0.` : "";
  if (beyond.length === 0)
    return (zeros.length ? "P is on the edge, and the edge belongs to the triangle." : "P is inside.") + on;
  if (beyond.length === 1) return `P is beyond the edge ${edge[beyond[0]]}: ${beyond[0]} is negative.${on}`;
  return `P is beyond the corner where ${edge[beyond[0]]} and ${edge[beyond[1]]} meet: ` +
    `${beyond.join(" and ")} are negative.${on}`;
}

export const barycentric: Chapter = {
  id: "barycentric",
  title: "Barycentric coordinates",
  body(place) {
    place.append(
      paragraph("Hang weights on the three corners and ask where the triangle balances. Each point of the plane " +
        "is such a balance, of exactly one triple of weights that add up to 1:"),
      math("P = w\\,A + u\\,B + v\\,C, \\qquad w + u + v = 1"),
      paragraph("Each weight belongs to a corner. It is 1 there, **0 on the whole line through the other two**, " +
        "and negative beyond that line. So the three signs cut the plane into **seven regions**: the inside, one " +
        "beyond each edge, one beyond each corner. (Three negative numbers cannot add up to 1: there is no eighth.)"),
      paragraph("Each weight is also a ratio of areas: the triangle that $P$ makes with the edge opposite, over the " +
        "whole triangle. Areas have signs: corners that run clockwise count negative. The centre, where the medians " +
        "meet, has all three weights equal."),
      math("w = \\frac{[PBC]}{[ABC]},\\quad u = \\frac{[APC]}{[ABC]},\\quad v = \\frac{[ABP]}{[ABC]}"),
      figure("barycentric", {
        label: "A triangle ABC and a point P in its plane",
        flat: true,
        step: 0.5,
        points: { A: [-2.5, -2, 0], B: [2.5, -1.5, 0], C: [-0.5, 2, 0], P: [0, -0.5, 0] },
        draw(canvas, { A, B, C, P }) {
          for (const [p, q] of [[A, B], [B, C], [C, A]] as const) {
            const d = [q[0] - p[0], q[1] - p[1]];
            canvas.line([p[0] - 9 * d[0], p[1] - 9 * d[1], 0], [q[0] + 9 * d[0], q[1] + 9 * d[1], 0], "faint");
          }
          canvas.area([P, B, C], "part-a");
          canvas.area([A, P, C], "part-b");
          canvas.area([A, B, P], "part-c");
          canvas.area([A, B, C]);
        },
        formula({ A, B, C, P }) {
          const { u, v, w } = weights(exact, Object.fromEntries(Object.entries({ A, B, C, P }).map(
            ([k, p]) => [k, p.map(exact.of) as unknown as Vec<Rational>])));
          const at = (p: readonly number[]) => `\\begin{pmatrix}${shown(p[0])}\\\\${shown(p[1])}\\end{pmatrix}`;
          const tex = (q: typeof u) => (q.below === 1n ? `${q.above}` : `\\tfrac{${q.above}}{${q.below}}`);
          return `${at(P)} = ${tex(w)}\\,${at(A)} + ${tex(u)}\\,${at(B)} + ${tex(v)}\\,${at(C)}`;
        },
        rows: [
          { name: "$w$ (A)", value: (n, p) => weights(n, p).w },
          { name: "$u$ (B)", value: (n, p) => weights(n, p).u },
          { name: "$v$ (C)", value: (n, p) => weights(n, p).v },
          { name: "$w + u + v$", value: (n, p) => {
            const { u, v, w } = weights(n, p);
            return n.add(n.add(w, u), v);
          } },
        ],
        verdict(points) {
          const p = Object.fromEntries(Object.entries(points).map(([k, x]) => [k, x.map(exact.of)]));
          try {
            const { u, v, w } = weights(exact, p as never);
            return region({ w: w.sign, u: u.sign, v: v.sign });
          } catch {
            return "The corners lie on one line: the triangle has no area, and the weights have no meaning.";
          }
        },
      }),
      exercises("barycentric", [
        { question: "What is each weight of the centre (of the medians)?", answer: "1/3",
          help: "All three are equal and add up to 1." },
        { question: "P is the midpoint of AB. What is v, the weight of C?", answer: "0",
          help: "The whole line AB is where C has no weight." },
        { question: "u = -1/4 and v = 1/2. What is w?", answer: "3/4", help: "The three add up to 1." },
      ]),
    );
  },
};
