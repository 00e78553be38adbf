// SPDX-License-Identifier: Apache-2.0
// Chapter 1: a ray and its t.
import { vectors } from "pierce-wasm";
import { type Chapter, column, exercises, figure, math, misprint, paragraph } from "../chapter.js";
import { along, minus } from "../space.js";

export const ray: Chapter = {
  id: "ray",
  title: "A ray and its t",
  body(place) {
    place.append(
      paragraph("A ray starts somewhere and goes somewhere: an origin $O$ and a direction $D$. Every one of " +
        "its points is reached from the origin by some multiple $t$ of the direction."),
      math("P(t) = O + t\\,D, \\qquad t \\ge 0"),
      paragraph("$t$ is **not a distance**. It counts how many times the direction fits: $t = 0$ is the origin, " +
        "$t = 1$ is $O + D$, and negative $t$ lies behind. Only if $D$ has length 1 are $t$ and the distance the " +
        "same number; otherwise the distance is $t\\,|D|$. Nothing forces you to make $D$ a unit vector, and " +
        "there is a reason not to: the square root rounds."),
      paragraph("In the figure the point $X$ is dropped onto the line of the ray. Where does it land?"),
      math("t = \\frac{(X - O)\\cdot D}{D\\cdot D}"),
      figure("ray", {
        label: "An origin O, the end T of the direction D = T - O, and a point X",
        flat: true,
        step: 0.5,
        points: { O: [-3, -1.5, 0], T: [-1, -0.5, 0], X: [1, 2, 0] },
        draw(canvas, { O, T, X }) {
          const d = minus(T, O);
          const length = d[0] * d[0] + d[1] * d[1];
          canvas.line(O, along(O, 12, d), "ray");
          canvas.line(O, T, "direction");
          if (length === 0) return;
          const x = minus(X, O);
          const t = (x[0] * d[0] + x[1] * d[1]) / length;
          if (t < 0) canvas.line(O, along(O, t, d), "faint");
          canvas.line(X, along(O, t, d), "faint");
          canvas.dot(along(O, t, d), t < 0 ? "miss" : "hit");
        },
        formula: ({ O, T, X }) =>
          `t = \\frac{${column(minus(X, O).slice(0, 2))}\\cdot${column(minus(T, O).slice(0, 2))}}` +
          `{${column(minus(T, O).slice(0, 2))}\\cdot${column(minus(T, O).slice(0, 2))}}`,
        rows: [
          { name: "$(X - O)\\cdot D$", value: (n, { O, T, X }) => {
            const v = vectors(n);
            return v.dot(v.minus(X, O), v.minus(T, O));
          } },
          { name: "$D\\cdot D$", value: (n, { O, T }) => {
            const v = vectors(n), d = v.minus(T, O);
            return v.dot(d, d);
          } },
          { name: "$t$", value: (n, { O, T, X }) => {
            const v = vectors(n), d = v.minus(T, O);
            return n.div(v.dot(v.minus(X, O), d), v.dot(d, d));
          } },
        ],
        verdict({ O, T, X }) {
          const d = minus(T, O), x = minus(X, O);
          const along = x[0] * d[0] + x[1] * d[1];
          if (d.every((c) => c === 0)) return "The direction is zero: this is no ray.";
          if (along < 0) return "X lands behind the origin: its t is negative, and the ray never gets there.";
          return along === 0 ? "X lands on the origin: t = 0, and the origin belongs to the ray."
                             : "X lands in front of the origin: t is positive.";
        },
      }),
      misprint("The vector from the ray's origin to the corner $A$ is $A - O$; the one back is $O - A$. Notes " +
        "that change from one to the other between two lines turn the sign of $t$. Test it: with $O = (0,0,0)$, " +
        "$D = (0,0,1)$ and a triangle in the plane $z = 5$, the answer must be $t = 5$, not $-5$."),
      exercises("ray", [
        { question: "A ray starts at (1, 2) in direction (3, -1). For which t does it reach (10, -1)?",
          answer: "3", help: "Both coordinates must agree: 1 + 3t = 10." },
        { question: "The direction is (3, 4) and t = 2. How far from the origin is the point?", answer: "10",
          help: "The distance is $t\\,|D|$, and $|D| = \\sqrt{3^2 + 4^2}$." },
        { question: "The same line, but with direction (6, 8). Which t is that point at now?", answer: "1",
          help: "Twice the direction, half the t." },
      ]),
    );
  },
};
