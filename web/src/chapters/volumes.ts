// SPDX-License-Identifier: Apache-2.0
// Chapter 6: D0, Dt, Du, Dv as volumes.
import { type Chapter, column, exercises, figure, h, math, misprint, paragraph } from "../chapter.js";
import { TRIANGLE, along, drawTriangleAndRay, minus, solve, verdictOf } from "../space.js";
import type { Canvas, Point, Points, Stage } from "../stage.js";

type Which = "D0" | "Dt" | "Du" | "Dv";

function edges(p: Points, which: Which): [Point, Point, Point] {
  const a = minus(p.O, p.T), b = minus(p.B, p.A), c = minus(p.C, p.A), d = minus(p.O, p.A);
  return { D0: [a, b, c], Dt: [d, b, c], Du: [a, d, c], Dv: [a, b, d] }[which] as [Point, Point, Point];
}

function drawBox(canvas: Canvas, at: Point, [x, y, z]: [Point, Point, Point]): void {
  const corner = (i: number): Point =>
    [x, y, z].reduce<Point>((p, e, k) => (i & (1 << k) ? along(p, 1, e) : p), at);
  for (let i = 0; i < 8; ++i)
    for (let k = 0; k < 3; ++k)
      if (!(i & (1 << k))) canvas.line(corner(i), corner(i | (1 << k)), "box");
}

export const volumes: Chapter = {
  id: "volumes",
  title: "Four volumes",
  body(place) {
    let which: Which = "D0";
    const select = h("select", { id: "volume", change: () => {
      which = select.value as Which;
      stage?.update();
    } }, ...["D0", "Dt", "Du", "Dv"].map((name) => h("option", {}, name)));
    let stage: Stage | undefined;
    place.append(
      paragraph("A determinant of three vectors is the **volume** of the box that they span, with a sign: positive if they " +
        "lie like thumb, forefinger and middle finger of the right hand. Write the ray as $S + t\\,Q$ and the triangle " +
        "as $P_0, P_1, P_2$, and call"),
      math("A = -Q,\\quad B = P_1 - P_0,\\quad C = P_2 - P_0,\\quad D = S - P_0"),
      paragraph("so that $t A + u B + v C = D$. Then Cramer's rule needs no memory: **each unknown replaces its own " +
        "column by $D$**."),
      math("t = \\frac{|D\\,B\\,C|}{|A\\,B\\,C|} = \\frac{D_t}{D_0},\\quad " +
        "u = \\frac{|A\\,D\\,C|}{D_0},\\quad v = \\frac{|A\\,B\\,D|}{D_0}"),
      paragraph("Why it works: put $D = tA + uB + vC$ into $|D\\,B\\,C|$. The parts along $B$ and $C$ are flat boxes, of " +
        "volume 0; what is left is $t$ times $|A\\,B\\,C|$. $D_t$ does not contain the direction, so it is the same for " +
        "all rays from one origin."),
      h("p", {}, h("label", { for: "volume" }, "Draw the box of "), select),
      figure("volumes", {
        label: "A triangle ABC, a ray from O towards T, and the box of one determinant",
        points: TRIANGLE,
        reach: 5,
        draw(canvas, p) {
          drawBox(canvas, p.A, edges(p, which));
          drawTriangleAndRay(canvas, p);
        },
        formula: (p) => {
          const a = minus(p.O, p.T).map((x) => x + 0);
          return `t = \\frac{\\left|${column(minus(p.O, p.A))}${column(minus(p.B, p.A))}${column(minus(p.C, p.A))}` +
            `\\right|}{\\left|${column(a)}${column(minus(p.B, p.A))}${column(minus(p.C, p.A))}\\right|}`;
        },
        rows: [
          { name: "$D_0$", value: (n, p) => solve(n, p).D0 },
          { name: "$D_t$", value: (n, p) => solve(n, p).Dt },
          { name: "$D_u$", value: (n, p) => solve(n, p).Du },
          { name: "$D_v$", value: (n, p) => solve(n, p).Dv },
          { name: "$t$", value: (n, p) => solve(n, p).t() },
          { name: "$u$", value: (n, p) => solve(n, p).u() },
          { name: "$v$", value: (n, p) => solve(n, p).v() },
        ],
        verdict: (p) => verdictOf(p),
        made: (s) => (stage = s),
      }),
      misprint("In printed notes the indices slip: $D_u$ with $D$ in the third column, $D_v$ with it in the second. " +
        "That computes $v$ for $u$ and $u$ for $v$, and no test fails: a hit stays a hit, but every texture is " +
        "mirrored. The rule that cannot be misremembered is the order $t, u, v$ of the " +
        "columns $A, B, C$: first unknown, first column."),
      exercises("volumes", [
        { question: "A = (0,0,-1), B = (2,0,0), C = (0,2,0). What is D0 = |A B C|?", answer: "-4",
          help: "A . (B x C) with B x C = (0,0,4)." },
        { question: "With D = (1,1,-3) as well: what is t?", answer: "3", help: "$D_t$ = D . (B x C) = -12." },
        { question: "And u?", answer: "1/2", help: "$D_u = |A\\,D\\,C|$ = A . (D x C), D x C = (6, 0, 2)." },
      ]),
    );
  },
};
