// SPDX-License-Identifier: Apache-2.0
// Chapter 8: the normal, kept with the triangle.
import { type Numbers, type Vec, vectors } from "pierce-wasm";
import { type Chapter, column, exercises, figure, math, paragraph } from "../chapter.js";
import { TRIANGLE, drawTriangleAndRay, minus, verdictOf } from "../space.js";

function parts<T>(n: Numbers<T>, { O, T, A, B, C }: Record<string, Vec<T>>) {
  const v = vectors(n);
  const d = v.minus(T, O), e1 = v.minus(B, A), e2 = v.minus(C, A), s = v.minus(O, A);
  const normal = v.cross(e1, e2), m = v.cross(s, d), zero = n.of(0);
  const below = n.sub(zero, v.dot(normal, d));
  return { below, t: () => n.div(v.dot(normal, s), below), u: () => n.div(v.dot(m, e2), below),
           v: () => n.div(n.sub(zero, v.dot(m, e1)), below) };
}

export const normal: Chapter = {
  id: "normal",
  title: "The normal, kept",
  body(place) {
    place.append(
      paragraph("A triangle is asked about by millions of rays. What does not depend on the ray can be computed once and kept: " +
        "the edges, and their cross product, the normal. The triple products may be turned round so that it shows, " +
        "since $x\\cdot(y\\times z) = y\\cdot(z\\times x) = z\\cdot(x\\times y)$:"),
      math("n = e_1\\times e_2\\;(\\text{kept}),\\qquad s = O - A,\\qquad m = s\\times D"),
      math("t = \\frac{n\\cdot s}{-n\\cdot D},\\quad u = \\frac{m\\cdot e_2}{-n\\cdot D},\\quad " +
        "v = \\frac{-m\\cdot e_1}{-n\\cdot D}"),
      paragraph("Now $t$ comes **first and costs 6 products**: a triangle beyond the nearest hit so far is left after one " +
        "quotient. A hit costs 18 products and 3 quotients where Moller and Trumbore need 27 and 1. The price is memory: twelve numbers a triangle " +
        "($A, e_1, e_2, n$) where three indices would do; and on today's machines fetching them may cost more than the nine " +
        "products saved."),
      paragraph("The sign of $-n\\cdot D$ says which side is hit: positive if the corners run counter-clockwise as seen from " +
        "$O$, the **front**."),
      figure("normal", {
        label: "A triangle ABC and a ray from O towards T",
        points: TRIANGLE,
        draw: drawTriangleAndRay,
        formula: ({ O, T, A, B, C }) =>
          `n = ${column(minus(B, A))}\\times${column(minus(C, A))},\\quad s = ${column(minus(O, A))},\\quad ` +
          `m = s\\times${column(minus(T, O))}`,
        rows: [
          { name: "$-n\\cdot D$", value: (n, p) => parts(n, p).below },
          { name: "$t$", value: (n, p) => parts(n, p).t() },
          { name: "$u$", value: (n, p) => parts(n, p).u() },
          { name: "$v$", value: (n, p) => parts(n, p).v() },
        ],
        verdict: (p) => verdictOf(p, "precomputed_normal"),
      }),
      exercises("normal", [
        { question: "How many numbers are kept with a triangle?", answer: "12", help: "Four vectors of three." },
        { question: "e1 = (2,0,0), e2 = (0,3,0). What is the z of n?", answer: "6",
          help: "$x_1 y_2 - y_1 x_2$." },
        { question: "n = (0,0,6) and D = (1,0,-2). What is -n.D, whose sign says front or back?", answer: "12",
          help: "6 times -2, and the sign turned. Positive: the front." },
      ]),
    );
  },
};
