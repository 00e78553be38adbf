// SPDX-License-Identifier: Apache-2.0
//
// What a chapter is made of: text, a figure to drag, the formula with the live numbers in it, a
// table of floats beside exact fractions, exercises that the page checks, misprints.
import { type Numbers, Rational, type Vec, exact, float32 } from "pierce-wasm";
import { h, math, paragraph, text } from "./dom.js";
import { type Points, Stage, type StageOptions } from "./stage.js";

export interface Exercise {
  question: string;
  /** As written by hand: "3", "1/3". */
  answer: string;
  /** Said when it is wrong. */
  help: string;
}

export interface Chapter {
  id: string;
  title: string;
  body: (place: HTMLElement) => void;
}

/** A row of the table: one computation, over floats and over fractions. */
export interface Row {
  name: string;
  value: <T>(n: Numbers<T>, p: Record<string, Vec<T>>) => T;
}

export interface FigureOptions extends Omit<StageOptions, "changed"> {
  /** The formula with the numbers of now, in TeX. */
  formula: (points: Points) => string;
  rows: Row[] | ((points: Points) => Row[]);
  /** The figure in one sentence, for everybody and for screen readers. */
  verdict: (points: Points) => string;
  /** Is given the stage, for a control beside it that changes what is drawn. */
  made?: (stage: Stage) => void;
}

/** A number for TeX and for tables: a whole one, a short decimal, or a fraction. */
export function shown(x: number): string {
  return String(Number(x.toPrecision(7)));
}

const SHOWN_DIGITS = 40;

export function fraction(q: Rational): string {
  const whole = q.toString();
  if (whole.length <= SHOWN_DIGITS) return whole;
  return `${whole.slice(0, 16)}... (${whole.length - 1} digits)`;
}

export function column(p: readonly number[]): string {
  return `\\begin{pmatrix}${p.map(shown).join("\\\\")}\\end{pmatrix}`;
}

export const vec = (p: readonly number[]) => p as unknown as Vec<number>;

export function figure(id: string, options: FigureOptions): HTMLElement {
  const formula = h("div", { class: "live" });
  const body = h("tbody");
  const verdict = h("p", { class: "verdict", role: "status", "data-verdict": id });
  const stage = new Stage({ ...options, changed: update });

  function update(points: Points): void {
    formula.replaceChildren(math(options.formula(points)));
    const rows = typeof options.rows === "function" ? options.rows(points) : options.rows;
    const over = <T>(n: Numbers<T>) => Object.fromEntries(
      Object.entries(points).map(([name, p]) => [name, p.map(n.of) as unknown as Vec<T>]));
    const floats = over(float32), fractions = over(exact);
    body.replaceChildren(...rows.map((row) => {
      const rounded = row.value(float32, floats);
      const q = tried(() => row.value(exact, fractions));
      return h("tr", {}, h("th", { scope: "row" },
        h("span", { class: "spoken" }, spoken(row.name)),
        h("span", { "aria-hidden": "true" }, ...text(row.name))),
        h("td", { "data-float": row.name }, float32.show(rounded)),
        h("td", { "data-exact": row.name, "data-fraction": q ? q.toString() : "" },
          q ? fraction(q) : "divided by 0"));
    }));
    verdict.replaceChildren(...text(options.verdict(points)));
  }

  const table = h("table", {},
    h("caption", {}, "Computed while you drag"),
    h("thead", {}, h("tr", {}, h("th", { scope: "col" }, "value"),
      h("th", { scope: "col" }, "in float"), h("th", { scope: "col" }, "exactly"))), body);
  const element = h("figure", { id: `figure-${id}`, class: "figure" }, stage.element, verdict, formula,
    h("div", { class: "wide", tabindex: 0, role: "group", "aria-label": "values" }, table));
  options.made?.(stage);
  stage.update();
  return element;
}

/** A row's name without the marks of TeX. */
function spoken(name: string): string {
  return name.replace(/\\cdot/g, " dot ").replace(/[$\\{}]/g, "");
}

function tried<T>(f: () => T): T | null {
  try {
    return f();
  } catch (e) {
    if (e instanceof RangeError) return null;
    throw e;
  }
}

export function exercises(id: string, list: Exercise[]): HTMLElement {
  const items = list.map(({ question, answer, help }, i) => {
    const name = `${id}-exercise-${i + 1}`;
    const input = h("input", { id: name, autocomplete: "off", inputmode: "text", size: 12 });
    const said = h("span", { role: "status", class: "said" });
    const check = (event: Event) => {
      event.preventDefault();
      const given = Rational.parse(input.value);
      const right = given !== null && given.compare(Rational.parse(answer)!) === 0;
      said.className = `said ${right ? "right" : "wrong"}`;
      const say = given === null ? "That is no number: write it as 3, -0.5 or 1/3." : right ? "Right." : help;
      said.replaceChildren(...text(say));
    };
    return h("li", {}, h("form", { submit: check as EventListener },
      h("label", { for: name }, ...text(question)), " ", input, " ",
      h("button", { type: "submit" }, "Check"), " ", said));
  });
  return h("div", { class: "exercises" },
    h("h3", {}, "Exercises"), h("ol", {}, ...items));
}

export function misprint(...lines: string[]): HTMLElement {
  return h("div", { class: "misprint", role: "note" },
    h("h3", {}, "A misprint that circulates"), ...lines.map(paragraph));
}

export { h, math, paragraph, text };
