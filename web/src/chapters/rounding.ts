// SPDX-License-Identifier: Apache-2.0
// Chapter 10: why it goes wrong, and what exact means.
import { type Pierce, type Vec, exact, trace } from "pierce-wasm";
import { type Chapter, exercises, h, math, paragraph, text } from "../chapter.js";
import { library } from "../library.js";
import { Stage } from "../stage.js";

const RAYS = 2000;
const METHODS = ["cramer", "determinants", "plane_then_edges", "plane_then_barycentric",
  "moller_trumbore, epsilon 0", "precomputed_normal", "watertight", "baldwin_weber"];

interface Tally {
  method: string;
  lost: number;
  wrong: number;
}

/** Two triangles that share the edge AB, in general position; rays through points of that edge. */
export function cast(pierce: Pierce, edge: readonly [number, number, number], from: Vec<number>): Tally[] {
  const A = [0.1, 0.2, 0.3].map((x) => x + edge[0] / 7), B = [1.3, 0.9, 0.7].map((x) => x + edge[1] / 7);
  const C = [0.2, 1.4, -0.3], D = [1.5, -0.6, 0.2];
  const first = [A, B, C].flat(), second = [A, D, B].flat();  // the edge AB, and BA
  const rays = new Float32Array(16 * RAYS), triangles = new Float32Array(18 * RAYS);
  const f = Math.fround;
  for (let i = 0; i < RAYS; ++i) {
    const s = (i + 0.5) / RAYS;
    const target = [0, 1, 2].map((k) => f(f(A[k]) * (1 - s) + f(B[k]) * s));
    const ray = [...from, ...target.map((x, k) => x - f(from[k])), 0, Infinity];
    rays.set([...ray, ...ray], 16 * i);
    triangles.set([...first, ...second], 18 * i);
  }
  const truth = pierce.ask("exact", rays, triangles);
  return [...METHODS, "exact"].map((method) => {
    const { hit } = pierce.ask(method, rays, triangles);
    let lost = 0, wrong = 0;
    for (let i = 0; i < RAYS; ++i) {
      const pair = [2 * i, 2 * i + 1];
      if (pair.some((k) => truth.hit[k]) && !pair.some((k) => hit[k])) ++lost;
      wrong += pair.filter((k) => hit[k] !== truth.hit[k]).length;
    }
    return { method: method === "exact" ? "pierce" : method, lost, wrong };
  });
}

export const rounding: Chapter = {
  id: "rounding",
  title: "Why it goes wrong",
  body(place) {
    const body = h("tbody");
    const verdict = h("p", { class: "verdict", role: "status", "data-verdict": "rounding" }, "Loading pierce.");
    let pierce: Pierce | undefined;
    const stage = new Stage({
      label: "Two triangles that share an edge, and the origin of 2000 rays that go through it",
      flat: true,
      step: 0.125,
      points: { A: [-1.5, -1, 0], B: [2, 1, 0], O: [0.5, 2.25, 0] },
      draw(canvas, { A, B }) {
        canvas.area([A, B, [-1.25, 2, 0]], "part-b");
        canvas.area([A, [2.5, -1.75, 0], B], "part-c");
        canvas.line(A, B, "direction");
        canvas.label([(A[0] + B[0]) / 2, (A[1] + B[1]) / 2, 0], "2000 rays");
      },
      changed({ A, B, O }) {
        if (!pierce) return;
        const tallies = cast(pierce, [A[0], B[0], 0], [O[0], O[1], 3]);
        body.replaceChildren(...tallies.map(({ method, lost, wrong }) => h("tr", {},
          h("th", { scope: "row" }, h("code", {}, method)), h("td", { "data-lost": method }, String(lost)),
          h("td", { "data-wrong": method }, String(wrong)))));
        const worst = tallies.reduce((x, y) => (y.lost > x.lost ? y : x));
        verdict.replaceChildren(...text(worst.lost
          ? `\`${worst.method}\` loses ${worst.lost} of ${RAYS} rays: both triangles say no, and the ray slips through.`
          : "From here no method loses a ray, but look at the wrong decisions."));
      },
    });
    stage.update();
    library.then((loaded) => {
      pierce = loaded;
      stage.update();
    }, () => verdict.replaceChildren("WebAssembly with SIMD is not to be had in this browser."));
    place.append(
      paragraph("Every operation on floats **rounds**. Far from every edge that changes the last digits of $t$, $u$ and $v$. Near an " +
        "edge it changes the answer, for there the answer hangs on the **sign** of a number that is nearly 0, and the rounding " +
        "error is larger than the number."),
      paragraph("So take one ray through the edge that two triangles share. Each computes its own $u$, from its own corners, in " +
        "its own order, and rounds it its own way. Both may say \"outside\", and the ray slips between them: a hole " +
        "in a wall, a leak of light, a point called outside that is within."),
      h("figure", { id: "figure-rounding", class: "figure" }, stage.element, verdict,
        h("div", { class: "wide", tabindex: 0, role: "group", "aria-label": "values" }, h("table", {},
          h("caption", {}, `${RAYS} rays at the common edge, in float, asked of both triangles`),
          h("thead", {}, h("tr", {}, ...["method", "rays lost", "wrong decisions"].map((words) =>
            h("th", { scope: "col" }, words)))), body))),
      paragraph("**What exact means.** A float is a fraction whose denominator is a power of two; sums and products of such " +
        "fractions are such fractions. So the determinants can be computed without any rounding, and their signs are then " +
        "the truth. One ray, in fractions:"),
      math(oneExample()),
      paragraph("It is not slow, since it is hardly ever needed: pierce computes in double first, with a bound on the error. Where " +
        "the bound is smaller than the number the sign is **proved**; only where it is not are whole numbers of " +
        "many bits brought out. And $t, u, v$ are rounded once, from the exact fraction, at the very end."),
      paragraph("**Watertight is something else.** The method of Woop, Benthin and Wald makes both neighbours compute the same " +
        "number for their common edge, so that no ray is ever lost between them. That is much; but vertices " +
        "are sheared and rounded first, so it is right about a mesh that has been moved a little. It gives rays to the wrong " +
        "neighbour, and calls rays hits that pass beside the rim. The last column counts them."),
      exercises("rounding", [
        { question: "Float has 24 bits. What is 16777216 + 1 in float?", answer: "16777216",
          help: "$2^{24} + 1$ needs 25 bits; the tie goes to the even number." },
        { question: "The exact value of a determinant is 1/50802385. What is its sign: 1, 0 or -1?", answer: "1",
          help: "However small: it is positive, and the ray is inside." },
        { question: "In the table, how many rays does pierce lose?", answer: "0", help: "Look at its row." },
      ]),
    );
  },
};

function oneExample(): string {
  const ray = { origin: [0, -3, 8] as Vec<number>,
                direction: [0x10264f / 2 ** 24, 0x1634aca / 2 ** 26, -0x1df1b28 / 2 ** 25] as Vec<number> };
  const corners = [[2, -4, 3], [-1, 2, -4], [1, 1, -3]] as unknown as
    [Vec<number>, Vec<number>, Vec<number>];
  const { hit } = trace("determinants", exact, ray, corners);
  if (!hit) return "\\text{no hit}";
  const w = exact.sub(exact.sub(exact.of(1), hit.u), hit.v);
  const tex = (name: string, q: typeof w) => `${name} = \\frac{${q.above}}{${q.below}}`;
  return [tex("u", hit.u), tex("v", hit.v), tex("w", w)].join(",\\quad ");
}
