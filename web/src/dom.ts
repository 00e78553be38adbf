// SPDX-License-Identifier: Apache-2.0
//
// Elements, in few words.
import katex from "katex";

type Child = Node | string;
type Attributes = Record<string, string | number | boolean | EventListener>;

function filled<E extends Element>(element: E, attributes: Attributes, children: Child[]): E {
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === "function") element.addEventListener(name, value);
    else if (value === true) element.setAttribute(name, "");
    else if (value !== false) element.setAttribute(name, String(value));
  }
  element.append(...children);
  return element;
}

export function h<K extends keyof HTMLElementTagNameMap>(
  tag: K, attributes: Attributes = {}, ...children: Child[]): HTMLElementTagNameMap[K] {
  return filled(document.createElement(tag), attributes, children);
}

export function svg<K extends keyof SVGElementTagNameMap>(
  tag: K, attributes: Attributes = {}, ...children: Child[]): SVGElementTagNameMap[K] {
  return filled(document.createElementNS("http://www.w3.org/2000/svg", tag), attributes, children);
}

/** A formula in a line of its own, or within text. */
export function math(tex: string, display = true): HTMLElement {
  const element = h(display ? "div" : "span", { class: display ? "formula" : "math" });
  if (display) element.tabIndex = 0;  // wide ones are scrolled by keyboard
  if (display) element.setAttribute("role", "group");
  if (display) element.setAttribute("aria-label", "formula");
  katex.render(tex, element, { displayMode: display, throwOnError: true });
  return element;
}

/** Text with formulas between dollars, **bold** and `code`. */
export function text(source: string): Node[] {
  return source.split(/(\$[^$]+\$|\*\*[^*]+\*\*|`[^`]+`)/).map((part) => {
    if (part.startsWith("$")) return math(part.slice(1, -1), false);
    if (part.startsWith("**")) return h("strong", {}, ...text(part.slice(2, -2)));
    if (part.startsWith("`")) return h("code", {}, part.slice(1, -1));
    return document.createTextNode(part);
  });
}

export function paragraph(source: string): HTMLElement {
  return h("p", {}, ...text(source));
}
