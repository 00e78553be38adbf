// SPDX-License-Identifier: Apache-2.0
// Chapter 5: determinants by any row or column; shared sub-terms; early outs.
import { type Numbers, exact } from "pierce-wasm";
import { type Chapter, exercises, figure, h, math, paragraph, shown } from "../chapter.js";
import { TRIANGLE, asked, drawTriangleAndRay, minus } from "../space.js";
import type { Points } from "../stage.js";

type Matrix = number[][];

/** The columns A - B, A - C, D. */
function matrix(p: Points): Matrix {
  const columns = [minus(p.A, p.B), minus(p.A, p.C), minus(p.T, p.O)];
  return [0, 1, 2].map((i) => columns.map((c) => c[i] + 0));
}

function minor(m: Matrix, i: number, j: number): number {
  const [r, s] = [0, 1, 2].filter((k) => k !== i), [c, d] = [0, 1, 2].filter((k) => k !== j);
  return m[r][c] * m[s][d] - m[r][d] * m[s][c];
}

const bracketed = (x: number) => (x < 0 ? `(${shown(x)})` : shown(x));

/** Along a row (0 to 2) or a column (3 to 5). */
export function expansion(m: Matrix, line: number): { tex: string; value: number } {
  const terms = [0, 1, 2].map((k) => {
    const [i, j] = line < 3 ? [line, k] : [k, line - 3];
    const sign = (i + j) % 2 === 0 ? 1 : -1;
    const [r, s] = [0, 1, 2].filter((x) => x !== i), [c, d] = [0, 1, 2].filter((x) => x !== j);
    const two = `\\begin{vmatrix}${shown(m[r][c])}&${shown(m[r][d])}\\\\${shown(m[s][c])}&` +
      `${shown(m[s][d])}\\end{vmatrix}`;
    return { tex: `${sign > 0 ? (k ? "+" : "") : "-"}${bracketed(m[i][j])}${two}`,
             value: sign * m[i][j] * minor(m, i, j) };
  });
  const value = terms.reduce((sum, t) => sum + t.value, 0);
  return { tex: `${terms.map((t) => t.tex).join(" ")} = ${shown(value + 0)}`, value };
}

function named<T>(n: Numbers<T>, p: Points, name: string): T {
  const step = asked("cramer", n, p).steps.find((s) => s.name === name);
  if (!step) throw new RangeError("left before");
  return step.value as T;
}

export const determinants: Chapter = {
  id: "determinants",
  title: "Determinants",
  body(place) {
    let line = 0, points: Points = TRIANGLE;
    const shownExpansion = h("div", { class: "live" });
    const show = () => shownExpansion.replaceChildren(math(`M = ${expansion(matrix(points), line).tex}`));
    const names = ["row 1", "row 2", "row 3", "column 1", "column 2", "column 3"];
    const select = h("select", { id: "expansion-line", change: () => {
      line = Number(select.value);
      show();
    } }, ...names.map((name, i) => h("option", { value: i }, name)));
    place.append(
      paragraph("A determinant of three columns may be expanded along **any row or any column**: each entry times the " +
        "determinant of what is left when its row and its column are struck out, with the signs of a chessboard. All " +
        "six expansions are the same number. Swapping two columns turns the sign; two equal columns make it 0."),
      math("\\begin{vmatrix} a & d & g\\\\ b & e & h\\\\ c & f & i\\end{vmatrix} = " +
        "a(ei - hf) + b(gf - di) + c(dh - eg),\\qquad\\begin{pmatrix}+&-&+\\\\-&+&-\\\\+&-&+\\end{pmatrix}"),
      paragraph("With $a, b, c$ the components of $A - B$, $d, e, f$ those of $A - C$, $g, h, i$ those of the direction " +
        "and $j, k, l$ those of $A - O$, Cramer's rule needs four such determinants. Six sub-terms do for all of them:"),
      math("\\beta = \\frac{j(ei - hf) + k(gf - di) + l(dh - eg)}{M}"),
      math("\\gamma = \\frac{i(ak - jb) + h(jc - al) + g(bl - kc)}{M}"),
      math("t = -\\frac{f(ak - jb) + e(jc - al) + d(bl - kc)}{M}"),
      paragraph("Most rays miss most triangles, so what matters is how soon a miss is seen. In the order $t$, $\\gamma$, " +
        "$\\beta$ one leaves as soon as $t$ is out of its range, as $\\gamma$ is not in $[0, 1]$, as $\\beta$ is " +
        "not in $[0, 1 - \\gamma]$; what comes after is never computed. The table says \"divided by 0\" only where " +
        "there is nothing to divide by, and leaves out what an early exit made unnecessary."),
      h("p", {}, h("label", { for: "expansion-line" }, "Expand M along "), select),
      shownExpansion,
      figure("determinants", {
        label: "A triangle ABC and a ray from O towards T",
        points: TRIANGLE,
        draw(canvas, p) {
          points = { ...p };
          show();
          drawTriangleAndRay(canvas, p);
        },
        formula(p) {
          const m = matrix(p);
          return `M = \\begin{vmatrix}${m.map((row) => row.map(shown).join("&")).join("\\\\")}\\end{vmatrix}` +
            ` = ${shown(expansion(m, 0).value + 0)}`;
        },
        rows: (p) => asked("cramer", exact, p).steps.filter((s) => !Array.isArray(s.value)).map((s) => ({
          name: s.name, value: (n) => named(n, p, s.name),
        })),
        verdict(p) {
          const { hit, rejected } = asked("cramer", exact, p);
          return hit ? "All three tests are passed: a hit." : `Left early: ${rejected}.`;
        },
      }),
      exercises("determinants", [
        { question: "The determinant with rows (1,2,0), (0,3,0), (5,7,2)?", answer: "6",
          help: "Expand along the last column: only one entry is not 0." },
        { question: "The same with the first two rows swapped?", answer: "-6", help: "One swap, one sign." },
        { question: "How many products does Cramer's rule take with shared sub-terms?", answer: "24",
          help: "Six sub-terms of 2, four sums of 3." },
      ]),
    );
  },
};
