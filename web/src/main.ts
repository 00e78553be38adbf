// SPDX-License-Identifier: Apache-2.0
//
// The page: ten chapters and the playground.
import "katex/dist/katex.min.css";
import "./style.css";
import type { Chapter } from "./chapter.js";
import { barycentric } from "./chapters/barycentric.js";
import { determinants } from "./chapters/determinants.js";
import { equations } from "./chapters/equations.js";
import { interpolation } from "./chapters/interpolation.js";
import { moller } from "./chapters/moller.js";
import { normal } from "./chapters/normal.js";
import { plane } from "./chapters/plane.js";
import { ray } from "./chapters/ray.js";
import { rounding } from "./chapters/rounding.js";
import { volumes } from "./chapters/volumes.js";
import { h } from "./dom.js";
import { Playground } from "./playground/playground.js";

const CHAPTERS: Chapter[] = [ray, barycentric, plane, equations, determinants, volumes, moller, normal,
  interpolation, rounding];

function themeButton(): HTMLElement {
  const root = document.documentElement;
  const dark = () => root.dataset.theme === "dark"
    || (!root.dataset.theme && matchMedia("(prefers-color-scheme: dark)").matches);
  const button = h("button", { type: "button", class: "theme", click: () => {
    root.dataset.theme = dark() ? "light" : "dark";
    name();
  } });
  const name = () => (button.textContent = dark() ? "Light" : "Dark");
  name();
  return button;
}

const playground = new Playground();
const contents = h("nav", { "aria-label": "Chapters" },
  h("ol", {}, ...CHAPTERS.map(({ id, title }) => h("li", {}, link(id, title)))),
  h("p", {}, link("playground", "Playground")));

/** Within the page, without touching the state in the address. */
function link(id: string, title: string): HTMLElement {
  return h("a", { href: `#${id}`, click: (event) => {
    event.preventDefault();
    const target = document.getElementById(id)!;
    target.scrollIntoView();
    target.querySelector<HTMLElement>("h2")?.focus();
  } }, title);
}

document.body.prepend(
  h("a", { href: "#lesson", class: "skip" }, "To the lesson"),
  h("header", {}, h("div", {}, h("h1", {}, "Which triangle does the ray pierce?"),
    h("p", {}, "A lesson in ten short chapters, with the exact answer beside the rounded one, and pierce itself running in the page.")),
    themeButton()),
  contents,
  h("main", { id: "lesson" }, ...CHAPTERS.map(({ id, title, body }, i) => {
    const section = h("section", { id, "aria-labelledby": `${id}-title` },
      h("h2", { id: `${id}-title`, tabindex: -1 }, `${i + 1}. ${title}`));
    body(section);
    return section;
  }), playground.element),
  h("footer", {}, h("p", {}, "pierce: every decision exact, every number correctly rounded. The page needs no network and sends nothing.")));
const wanted = location.hash.slice(1);
if (wanted && !wanted.includes("=")) document.getElementById(wanted)?.scrollIntoView();
playground.start().then(() => (document.documentElement.dataset.ready = "yes"), (error: unknown) => {
  document.documentElement.dataset.ready = "no";
  document.querySelector("[data-verdict=playground]")!.textContent =
    `pierce could not be loaded (${error instanceof Error ? error.message : error}): it needs a browser with WebAssembly SIMD.`;
});
