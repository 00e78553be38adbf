// SPDX-License-Identifier: Apache-2.0
// Chapter 7: Moller and Trumbore, and the epsilon.
import { type Vec, exact, float32, trace } from "pierce-wasm";
import { type Chapter, exercises, h, math, paragraph, text } from "../chapter.js";
import { Stage } from "../stage.js";

const COUNT = 24;

/** Triangle i of the row: a right one whose legs are 2^(-i/2), and a ray through its middle. */
function lost(i: number, epsilon: number, tilt: number): boolean {
  const leg = Math.fround(2 ** (-i / 2));
  const ray = { origin: [leg / 4, leg / 4, 1], direction: [tilt, 0, -1] } as const;
  const corners = [[0, 0, 0], [leg, 0, 0], [0, leg, 0]] as const;
  const from = { origin: [ray.origin[0] - tilt, ray.origin[1], 1] as Vec<number>,
                 direction: ray.direction as unknown as Vec<number> };
  const triangle = corners as unknown as [Vec<number>, Vec<number>, Vec<number>];
  const right = trace("moller_trumbore", exact, from, triangle, 0).hit !== null;
  return right && trace("moller_trumbore", float32, from, triangle, epsilon).hit === null;
}

export const moller: Chapter = {
  id: "moller",
  title: "Moller and Trumbore",
  body(place) {
    const verdict = h("p", { class: "verdict", role: "status", "data-verdict": "moller" });
    const live = h("div", { class: "live" });
    const epsilonOf = (x: number) => 10 ** -(4 - x);
    const stage = new Stage({
      label: "A row of ever smaller triangles, and a handle that sets epsilon",
      flat: true,
      step: 0.25,
      reach: 4.4,
      points: { epsilon: [-1, -2, 0] },
      draw(canvas, { epsilon: [x] }) {
        canvas.line([-4, -2, 0], [4, -2, 0], "faint");
        for (let i = 0; i < COUNT; ++i) {
          const leg = Math.max(0.08, 1.5 * 2 ** (-i / 6));
          const left = -3.8 + 2 * (i % 4), up = 2 - 0.6 * Math.floor(i / 4);
          const at = (dx: number, dy: number) => [left + dx, up - 0.55 + dy, 0] as const;
          canvas.area([at(0, 0), at(leg, 0), at(0, leg / 3)], lost(i, epsilonOf(x), 0) ? "gone" : "hit");
        }
      },
      changed(points) {
        const [x, y] = points.epsilon;
        if (y !== -2 || x < -4 || x > 4) {
          points.epsilon = [Math.min(4, Math.max(-4, x)), -2, 0];
          queueMicrotask(() => stage.update());
          return;
        }
        const epsilon = epsilonOf(x);
        const gone = Array.from({ length: COUNT }, (_, i) => lost(i, epsilon, 0)).filter(Boolean).length;
        live.replaceChildren(math(`\\varepsilon = 10^{${x - 4}} = ${epsilon.toPrecision(3).replace(
          /e([+-]\d+)/, "\\cdot 10^{$1}").replace("+", "")},\\qquad |e_1\\cdot q| < \\varepsilon`
          + `\\text{ for ${gone} of ${COUNT}}`));
        verdict.replaceChildren(...text(gone === 0
          ? "No triangle is lost; each is hit through its middle, as it is in truth."
          : `**${gone} of ${COUNT} triangles have vanished**: the ray goes through the middle of each, and the ` +
            "method says that it is parallel."));
      },
    });
    stage.update();
    place.append(
      paragraph("Moller and Trumbore (1997) write the determinants as triple products, $|x\\,y\\,z| = x\\cdot(y\\times z)$, " +
        "and notice that two cross products are enough for all four:"),
      math("e_1 = B - A,\\quad e_2 = C - A,\\quad s = O - A"),
      math("q = D\\times e_2,\\qquad r = s\\times e_1"),
      math("u = \\frac{s\\cdot q}{e_1\\cdot q},\\quad v = \\frac{D\\cdot r}{e_1\\cdot q},\\quad " +
        "t = \\frac{e_2\\cdot r}{e_1\\cdot q}"),
      paragraph("27 products and one quotient, nothing to keep with the triangle, and $u$ is tested before $r$ is computed. It is " +
        "what most programs use. It also has a line that says: if the determinant is **near zero**, the ray is parallel, " +
        "so give up."),
      math("-\\varepsilon < e_1\\cdot q < \\varepsilon \\;\\Rightarrow\\; \\text{no hit},\\qquad " +
        "\\varepsilon = 10^{-5}"),
      paragraph("But $e_1\\cdot q = -N\\cdot D$ is a **volume**. Its size says as much about how small the triangle is, and how " +
        "short the direction, as about the angle. An epsilon has a unit, and nobody knows which. Drag it: the triangles below " +
        "have legs of $1, \\sqrt{1/2}, 1/2, \\ldots$ down to 0.0003, and a ray straight through the middle of each."),
      h("figure", { id: "figure-moller", class: "figure" }, stage.element, verdict, live),
      paragraph("With $\\varepsilon = 0$ none of them is lost. The line does not make the method safer, either: a ray that is " +
        "truly parallel has a rounded determinant of any sign and size, and what comes out is noise. Rounding cannot be cured by a " +
        "constant."),
      exercises("moller", [
        { question: "A triangle with legs of 3 mm, in metres, is hit straight on by a unit direction. " +
          "What is the determinant (in cubic metres)?", answer: "0.000009",
          help: "The product of the legs: 0.003 times 0.003." },
        { question: "Is that below the epsilon 1e-5? Write 1 for yes, 0 for no.", answer: "1",
          help: "9e-6 is less than 10e-6." },
        { question: "The direction is made ten times as long. By what is the determinant multiplied?", answer: "10",
          help: "q contains the direction once." },
      ]),
    );
  },
};
