// SPDX-License-Identifier: Apache-2.0
// Chapter 9: interpolation on triangles, tetrahedra and simplices.
import { type Numbers, type Vec, vectors } from "pierce-wasm";
import { type Chapter, exercises, figure, h, math, paragraph, shown } from "../chapter.js";
import type { Point, Points } from "../stage.js";

const COLOURS = { A: [230, 70, 60], B: [40, 160, 90], C: [50, 100, 230] } as const;
const NORMALS = { A: [-0.6, 0, 0.8], B: [0.6, 0, 0.8], C: [0, 0.6, 0.8] } as const;
const TEXTURE = { A: [0, 0], B: [1, 0], C: [0, 1] } as const;

function weights<T>(n: Numbers<T>, p: Record<string, Vec<T>>): { w: T; u: T; v: T } {
  const flat = (a: Vec<T>, b: Vec<T>, c: Vec<T>) =>
    n.sub(n.mul(n.sub(b[0], a[0]), n.sub(c[1], a[1])), n.mul(n.sub(b[1], a[1]), n.sub(c[0], a[0])));
  const area = flat(p.A, p.B, p.C);
  return { w: n.div(flat(p.P, p.B, p.C), area), u: n.div(flat(p.A, p.P, p.C), area),
           v: n.div(flat(p.A, p.B, p.P), area) };
}

const doubles = { of: (x: number) => x, add: (x: number, y: number) => x + y,
  sub: (x: number, y: number) => x - y, mul: (x: number, y: number) => x * y,
  div: (x: number, y: number) => x / y } as unknown as Numbers<number>;

export function mixed(p: Points, at: Record<"A" | "B" | "C", readonly number[]>): number[] {
  const { w, u, v } = weights(doubles, p as never);
  return at.A.map((x, k) => w * x + u * at.B[k] + v * at.C[k]);
}

function tetrahedron<T>(n: Numbers<T>, name: number): T {
  const of = (p: number[]) => p.map(n.of) as unknown as Vec<T>;
  const corners = [[0, 0, 0], [4, 0, 0], [0, 4, 0], [0, 0, 4]].map(of), p = of([1, 1, 1]);
  const { determinant, minus } = vectors(n);
  const volume = (c: Vec<T>[]) => determinant(minus(c[1], c[0]), minus(c[2], c[0]), minus(c[3], c[0]));
  return n.div(volume(corners.map((c, i) => (i === name ? p : c))), volume(corners));
}

export const interpolation: Chapter = {
  id: "interpolation",
  title: "Interpolation",
  body(place) {
    const swatch = h("span", { class: "swatch", role: "img", "aria-label": "the colour at P" });
    const told = h("p", { class: "told" });
    place.append(
      paragraph("What is known at the corners can be carried to every point between them, with the same weights: "),
      math("f(P) = w\\,f_A + u\\,f_B + v\\,f_C"),
      paragraph("It is the one function without bends that has the right values at the corners. On an edge the third corner " +
        "has no say, so the neighbour agrees there, and nothing tears. Colours may be mixed so, texture coordinates (which then " +
        "say where in a picture to look), and **normals**, which make a faceted thing look round; but the mix of unit vectors is " +
        "shorter than 1, and has to be given its length again."),
      figure("interpolation", {
        label: "A triangle with a colour at each corner, and a point P",
        flat: true,
        step: 0.25,
        points: { A: [-3, -2, 0], B: [3, -2, 0], C: [0, 2, 0], P: [-0.5, -0.5, 0] },
        draw(canvas, p) {
          const steps = 12;
          const at = (i: number, j: number): Point => {
            const [u, v] = [i / steps, j / steps];
            return [0, 1, 2].map((k) => (1 - u - v) * p.A[k] + u * p.B[k] + v * p.C[k]) as unknown as Point;
          };
          for (let i = 0; i < steps; ++i)
            for (let j = 0; i + j < steps; ++j)
              for (const cell of [[at(i, j), at(i + 1, j), at(i, j + 1)],
                                  ...(i + j < steps - 1 ? [[at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]] : [])]) {
                canvas.area(cell, "cell");
                const [x, y] = [0, 1].map((k) => (cell[0][k] + cell[1][k] + cell[2][k]) / 3);
                const colour = mixed({ ...p, P: [x, y, 0] }, COLOURS);
                canvas.last().setAttribute("style", `color: rgb(${colour.map(Math.round).join(" ")})`);
              }
          const colour = mixed(p, COLOURS).map((c) => Math.min(255, Math.max(0, Math.round(c))));
          swatch.style.background = `rgb(${colour.join(" ")})`;
          const normal = mixed(p, NORMALS), texture = mixed(p, TEXTURE);
          const size = Math.hypot(...normal);
          told.replaceChildren("Colour at P ", swatch, ` rgb(${colour.join(", ")}). Normal (` +
            `${normal.map((x) => shown(Number(x.toFixed(3)))).join(", ")}), length ${size.toFixed(3)}. ` +
            `Texture coordinates (${texture.map((x) => shown(Number(x.toFixed(3)))).join(", ")}).`);
        },
        formula(p) {
          const { w, u, v } = weights(doubles, p as never);
          const f = [w, u, v].map((x) => (Number.isFinite(x) ? x.toFixed(3) : "?"));
          return `f(P) = ${f[0]}\\,f_A + ${f[1]}\\,f_B + ${f[2]}\\,f_C`;
        },
        rows: [
          { name: "$w$", value: (n, p) => weights(n, p).w },
          { name: "$u$", value: (n, p) => weights(n, p).u },
          { name: "$v$", value: (n, p) => weights(n, p).v },
        ],
        verdict(p) {
          const { w, u, v } = weights(doubles, p as never);
          return Math.min(w, u, v) >= 0 ? "P is in the triangle: every value lies between those at the corners."
            : "P is outside: this is extrapolation, and values may lie beyond those at the corners.";
        },
      }),
      told,
      paragraph("**One dimension up**, a point in a tetrahedron has four weights, each the volume that the point makes with the " +
        "face opposite, over the whole volume. **Any number up**: a $k$-simplex has $k + 1$ corners and as many weights, each " +
        "the ratio of two determinants of $k$ columns. $k = 1$ is a segment, and its weights are $1 - t$ and $t$: the ray " +
        "with which we began."),
      math("\\lambda_i = \\frac{|p_1 - p_0,\\; \\ldots,\\; P - p_0,\\; \\ldots,\\; p_k - p_0|}" +
        "{|p_1 - p_0,\\; \\ldots,\\; p_i - p_0,\\; \\ldots,\\; p_k - p_0|},\\qquad \\lambda_0 = 1 - \\sum_{i=1}^k\\lambda_i"),
      exercises("interpolation", [
        { question: "Heights 3, 6 and 9 at A, B and C. What is the height at the centre?", answer: "6",
          help: "A third of each." },
        { question: "How many weights has a point in a 4-simplex?", answer: "5", help: "As many as corners." },
        { question: "Corners (0,0,0), (4,0,0), (0,4,0), (0,0,4). What is the weight of the first at (1,1,1)?",
          answer: String(tetrahedron(doubles, 0)), help: "1 minus the three others, each 1/4." },
      ]),
    );
  },
};
