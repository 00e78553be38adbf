// SPDX-License-Identifier: Apache-2.0
// Chapter 3: the plane, then the edges.
import { type Numbers, type Vec, vectors } from "pierce-wasm";
import { type Chapter, column, exercises, figure, math, paragraph } from "../chapter.js";
import { TRIANGLE, drawTriangleAndRay, minus, verdictOf } from "../space.js";

function parts<T>(n: Numbers<T>, { O, T, A, B, C }: Record<string, Vec<T>>) {
  const v = vectors(n);
  const normal = v.cross(v.minus(B, A), v.minus(C, A)), d = v.minus(T, O);
  const above = v.dot(normal, v.minus(A, O)), below = v.dot(normal, d);
  const point = () => v.plus(O, v.scaled(n.div(above, below), d));
  const side = (p: Vec<T>, q: Vec<T>) => v.dot(normal, v.cross(v.minus(q, p), v.minus(point(), p)));
  return { above, below, t: () => n.div(above, below), ab: () => side(A, B), bc: () => side(B, C),
           ca: () => side(C, A) };
}

export const plane: Chapter = {
  id: "plane",
  title: "The plane, then the edges",
  body(place) {
    place.append(
      paragraph("The oldest way takes two steps: first find where the ray meets the **plane** of the triangle, then " +
        "ask whether that point is **inside the edges**. The plane needs a normal, a vector at right angles to both " +
        "edges at $A$:"),
      math("N = (B - A)\\times(C - A)"),
      paragraph("A point $P$ is on the plane if $N\\cdot(P - A) = 0$. Put $P = O + tD$ in, and one equation for $t$ " +
        "is left. If $N\\cdot D = 0$ the ray runs along the plane and there is no such point, or all are."),
      math("t = \\frac{N\\cdot(A - O)}{N\\cdot D}"),
      paragraph("Now walk around the triangle. At each edge, $(B - A)\\times(P - A)$ points the same way as $N$ if " +
        "$P$ lies to the left of that edge, and the other way if it lies to the right. Inside is left of all three:"),
      math("N\\cdot\\bigl((B - A)\\times(P - A)\\bigr)\\ge 0,\\quad\\text{and so for } BC \\text{ and } CA"),
      figure("plane", {
        label: "A triangle ABC and a ray from O towards T",
        points: TRIANGLE,
        draw: drawTriangleAndRay,
        formula: ({ O, T, A, B, C }) =>
          `N = ${column(minus(B, A))}\\times${column(minus(C, A))},\\quad ` +
          `t = \\frac{N\\cdot${column(minus(A, O))}}{N\\cdot${column(minus(T, O))}}`,
        rows: [
          { name: "$N\\cdot(A - O)$", value: (n, p) => parts(n, p).above },
          { name: "$N\\cdot D$", value: (n, p) => parts(n, p).below },
          { name: "$t$", value: (n, p) => parts(n, p).t() },
          { name: "side of $AB$", value: (n, p) => parts(n, p).ab() },
          { name: "side of $BC$", value: (n, p) => parts(n, p).bc() },
          { name: "side of $CA$", value: (n, p) => parts(n, p).ca() },
        ],
        verdict: (p) => verdictOf(p, "plane_then_edges"),
      }),
      paragraph("The three side values are $N\\cdot N$ times $v$, $w$ and $u$: the barycentric coordinates have come " +
        "back, as areas. And nothing here needs three corners. **Any convex polygon** in a plane works, with one such " +
        "test for each edge; of its normal it is best to take the sum of $(P_{i-1} - P_0)\\times(P_i - P_0)$ over " +
        "all its corners, so that no three of them are special."),
      exercises("plane", [
        { question: "A = (0,0,6), N = (0,0,1), O = (1,2,0), D = (0,0,3). What is t?", answer: "2",
          help: "$N\\cdot(A - O) = 6$ and $N\\cdot D = 3$." },
        { question: "How many edge tests does a convex pentagon take, at most?", answer: "5",
          help: "One for each edge." },
        { question: "N = (1,2,2) and D = (2,-2,1). What is N.D?", answer: "0",
          help: "2 - 4 + 2. Such a ray never meets the plane, or lies in it." },
      ]),
    );
  },
};
