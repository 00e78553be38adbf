// SPDX-License-Identifier: Apache-2.0
// Chapter 4: three equations, a matrix, its inverse; Gauss beside Cramer.
import { type Numbers, Rational, type Vec, exact, float32, vectors } from "pierce-wasm";
import { type Chapter, column, exercises, figure, h, math, misprint, paragraph } from "../chapter.js";
import { TRIANGLE, drawTriangleAndRay, minus, solve, verdictOf } from "../space.js";

/** Gaussian elimination on the columns x, y, z and the right side, the largest pivot first. */
export function gauss<T>(n: Numbers<T>, columns: Vec<T>[], right: Vec<T>): Vec<T> | null {
  const rows = [0, 1, 2].map((i) => [columns[0][i], columns[1][i], columns[2][i], right[i]]);
  const zero = n.of(0);
  const size = (x: T) => (n.compare(x, zero) < 0 ? n.sub(zero, x) : x);
  for (let k = 0; k < 3; ++k) {
    let pivot = k;
    for (let i = k + 1; i < 3; ++i)
      if (n.compare(size(rows[i][k]), size(rows[pivot][k])) > 0) pivot = i;
    [rows[k], rows[pivot]] = [rows[pivot], rows[k]];
    if (n.compare(rows[k][k], zero) === 0) return null;
    for (let i = k + 1; i < 3; ++i) {
      const f = n.div(rows[i][k], rows[k][k]);
      for (let j = k; j < 4; ++j) rows[i][j] = n.sub(rows[i][j], n.mul(f, rows[k][j]));
    }
  }
  const x: T[] = [zero, zero, zero];
  for (let k = 2; k >= 0; --k) {
    let sum = rows[k][3];
    for (let j = k + 1; j < 3; ++j) sum = n.sub(sum, n.mul(rows[k][j], x[j]));
    x[k] = n.div(sum, rows[k][k]);
  }
  return x as unknown as Vec<T>;
}

function system<T>(n: Numbers<T>, p: Record<string, Vec<T>>) {
  const { minus: less, negated } = vectors(n);
  return { columns: [negated(less(p.T, p.O)), less(p.B, p.A), less(p.C, p.A)], right: less(p.O, p.A) };
}

function eliminated<T>(n: Numbers<T>, p: Record<string, Vec<T>>, k: number): T {
  const { columns, right } = system(n, p);
  const x = gauss(n, columns, right);
  if (!x) throw new RangeError("no pivot");
  return x[k];
}

/** Both over floats against fractions: the median error of t, and how many decisions are wrong. */
export function measure(count: number, flatness: number): { name: string; wrong: number; error: number }[] {
  let seed = 7;
  const random = () => {
    seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0;
    return Math.fround(seed / 2 ** 31 - 1);
  };
  const tallies = ["Gauss", "Cramer"].map((name) => ({ name, wrong: 0, errors: [] as number[] }));
  for (let i = 0; i < count; ++i) {
    const point = (): Vec<number> => [random(), random(), random()];
    const p: Record<string, Vec<number>> = { A: point(), B: point(), C: point(), O: point() };
    // A target near the edge BC, seen at a small angle.
    const s = Math.abs(random());
    const near = [0, 1, 2].map((k) => p.B[k] * s + p.C[k] * (1 - s));
    const origin = [0, 1, 2].map((k) => near[k] + (p.B[k] - p.A[k]) + flatness * p.O[k]);
    p.O = origin.map(Math.fround) as unknown as Vec<number>;
    p.T = near.map(Math.fround) as unknown as Vec<number>;
    const over = <T>(n: Numbers<T>) => Object.fromEntries(
      Object.entries(p).map(([name, x]) => [name, x.map(n.of) as unknown as Vec<T>]));
    const q = over(exact), truth = solve(exact, q);
    if (truth.D0.sign === 0) continue;
    const inside = (t: number, u: number, v: number) => t >= 0 && u >= 0 && v >= 0 && u + v <= 1;
    const [t, u, v] = [truth.t(), truth.u(), truth.v()];
    const right = t.sign >= 0 && u.sign >= 0 && v.sign >= 0 && u.plus(v).compare(Rational.of(1n)) <= 0;
    const f = over(float32), { columns, right: side } = system(float32, f), c = solve(float32, f);
    const answers = [gauss(float32, columns, side), [c.t(), c.u(), c.v()] as const];
    answers.forEach((x, k) => {
      if (!x || inside(x[0], x[1], x[2]) !== right) ++tallies[k].wrong;
      const exactly = t.toNumber();
      if (x && exactly !== 0) tallies[k].errors.push(Math.abs((x[0] - exactly) / exactly) * 2 ** 24);
    });
  }
  return tallies.map(({ name, wrong, errors }) => {
    errors.sort((x, y) => x - y);
    return { name, wrong, error: errors[errors.length >> 1] };
  });
}

function laboratory(): HTMLElement {
  const body = h("tbody");
  const button = h("button", { type: "button", click: () => {
    body.replaceChildren(...[1, 0.01, 0.0001].flatMap((flatness) => measure(400, flatness).map((m) =>
      h("tr", {}, h("th", { scope: "row" }, m.name), h("td", {}, String(flatness)),
        h("td", { "data-wrong": m.name }, `${m.wrong} of 400`),
        h("td", {}, m.error.toPrecision(3))))));
  } }, "Measure both, here and now");
  const head = ["method", "flatness", "wrong decisions", "median error of t, in 2^-24"];
  return h("div", { class: "laboratory" }, button,
    h("div", { class: "wide", tabindex: 0, role: "group", "aria-label": "measurement" }, h("table", {},
      h("caption", {}, "Rays aimed at an edge, in float, against exact fractions"),
      h("thead", {}, h("tr", {}, ...head.map((words) => h("th", { scope: "col" }, words)))), body)));
}

export const equations: Chapter = {
  id: "equations",
  title: "Three equations",
  body(place) {
    place.append(
      paragraph("Put the ray and the barycentric form together. A point that is on both gives one equation for each " +
        "of x, y and z, with three unknowns:"),
      math("O + t\\,D = A + u\\,(B - A) + v\\,(C - A)"),
      paragraph("Bring the unknowns to one side, and it is a matrix times a vector:"),
      math("\\begin{pmatrix} -D & B - A & C - A\\end{pmatrix}\\begin{pmatrix}t\\\\u\\\\v\\end{pmatrix} = O - A"),
      paragraph("If the matrix has an **inverse**, the answer is the inverse times $O - A$. It has one unless the ray is " +
        "parallel to the plane, or the triangle has no area. Nobody computes the inverse, though: **Gaussian " +
        "elimination** gets there with 17 products and quotients to eliminate and to substitute back, and it " +
        "can choose its pivots; **Cramer's rule** takes 24 products once sub-terms are shared, needs no " +
        "branches, and lets you stop early. For three unknowns the second has won."),
      figure("equations", {
        label: "A triangle ABC and a ray from O towards T",
        points: TRIANGLE,
        draw: drawTriangleAndRay,
        formula({ O, T, A, B, C }) {
          const [d, b, c] = [minus(O, T), minus(B, A), minus(C, A)].map((x) => x.map((y) => y + 0));
          const rows = [0, 1, 2].map((i) => `${d[i]} & ${b[i]} & ${c[i]}`).join("\\\\");
          return `\\begin{pmatrix}${rows}\\end{pmatrix}\\begin{pmatrix}t\\\\u\\\\v\\end{pmatrix} = ` +
            column(minus(O, A));
        },
        rows: [
          { name: "$t$ by Gauss", value: (n, p) => eliminated(n, p, 0) },
          { name: "$u$ by Gauss", value: (n, p) => eliminated(n, p, 1) },
          { name: "$v$ by Gauss", value: (n, p) => eliminated(n, p, 2) },
          { name: "$t$ by Cramer", value: (n, p) => solve(n, p).t() },
          { name: "$u$ by Cramer", value: (n, p) => solve(n, p).u() },
          { name: "$v$ by Cramer", value: (n, p) => solve(n, p).v() },
        ],
        verdict: (p) => verdictOf(p, "cramer"),
      }),
      paragraph("Which of the two is more **stable**? Elimination with pivots is famous for it, Cramer is not. On this " +
        "question it makes little difference: both round, and near an edge both decide wrongly."),
      laboratory(),
      misprint("Written with the columns $A - B$, $A - C$, $D$, the right side is $A - O$. Written with $-D$, $B - A$, " +
        "$C - A$, it is $O - A$. Both are right; one's columns with the other's right side turn all three signs " +
        "at once, and a triangle in front of you is reported behind."),
      exercises("equations", [
        { question: "2x + y = 5 and x - y = 1. What is x?", answer: "2", help: "Add the two equations." },
        { question: "D = (0,0,1), O = (1,1,0), A = (0,0,4), B = (4,0,4), C = (0,4,4). What is u?", answer: "1/4",
          help: "x: u times 4 is 1." },
      ]),
    );
  },
};
