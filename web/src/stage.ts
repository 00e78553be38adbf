// SPDX-License-Identifier: Apache-2.0
//
// A figure whose points can be dragged, with a mouse, a finger or the keyboard. Space is drawn
// obliquely: x to the right, z upwards, y away from the reader. A flat figure has x and y only.
import { h, svg } from "./dom.js";

export type Point = readonly [number, number, number];
export type Points = Record<string, Point>;

export interface StageOptions {
  label: string;
  points: Points;
  flat?: boolean;
  /** Coordinates are multiples of this. */
  step?: number;
  /** Half the width of what is shown, in units. */
  reach?: number;
  draw(canvas: Canvas, points: Points): void;
  changed(points: Points): void;
}

export interface Canvas {
  line(from: Point, to: Point, kind?: string): void;
  area(corners: Point[], kind?: string): void;
  dot(at: Point, kind?: string): void;
  label(at: Point, text: string): void;
  /** What was drawn last. */
  last(): Element;
}

// What one unit of depth is in the picture.
const RIGHT = 0.42, UP = 0.3;
const WIDTH = 560, HEIGHT = 380, MARGIN = 16;

/** Where the words beside a place go, so that they are not cut off. */
function beside([x, y]: readonly [number, number]): { x: number; y: number; "text-anchor": string } {
  const left = x > WIDTH - 50;
  return { x: left ? -12 : 12, y: y < 40 ? 28 : -10, "text-anchor": left ? "end" : "start" };
}

export class Stage {
  readonly element: HTMLElement;
  readonly points: Points;
  private readonly picture: SVGSVGElement;
  private readonly drawing = svg("g", { "aria-hidden": "true" });
  private readonly handles = new Map<string, SVGGElement>();
  private readonly scale: number;
  private readonly step: number;

  constructor(private readonly options: StageOptions) {
    this.points = { ...options.points };
    this.step = options.step ?? 0.25;
    this.scale = WIDTH / 2 / (options.reach ?? 4);
    this.picture = svg("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: "group",
                                "aria-label": options.label });
    this.picture.append(this.drawing);
    for (const name of Object.keys(this.points)) this.addHandle(name);
    const hint = options.flat
      ? "Drag the points, or give one the focus and use the arrow keys."
      : "Drag the points (with Shift: away from you). Keys: arrows, Page Up and Page Down for depth.";
    this.element = h("div", { class: "stage" }, this.picture as unknown as Node,
                     h("p", { class: "hint" }, hint));
  }

  set(name: string, to: Point): void {
    const snap = (x: number) => Math.round(x / this.step) * this.step + 0;
    const [x, y, z] = this.within(to);
    this.points[name] = [snap(x), snap(y), snap(z)];
    this.update();
  }

  /** The place in the picture that is nearest, as deep: a point is not to be lost. */
  private within([x, y, z]: Point): Point {
    const across = (WIDTH / 2 - MARGIN) / this.scale, above = (HEIGHT / 2 - MARGIN) / this.scale;
    const held = (value: number, most: number) => Math.min(most, Math.max(-most, value));
    if (this.options.flat) return [held(x, across), held(y, above), z];
    return [held(x + RIGHT * y, across) - RIGHT * y, y, held(z + UP * y, above) - UP * y];
  }

  update(): void {
    const canvas = this.canvas();
    this.drawing.replaceChildren();
    this.options.draw(canvas, this.points);
    for (const [name, handle] of this.handles) {
      const [x, y] = this.project(this.points[name]);
      handle.setAttribute("transform", `translate(${x} ${y})`);
      for (const [key, value] of Object.entries(beside([x, y])))
        handle.lastElementChild!.setAttribute(key, String(value));
      const at = this.options.flat ? this.points[name].slice(0, 2) : this.points[name];
      handle.setAttribute("aria-label", `point ${name} at ${at.join(", ")}; arrow keys move it`);
    }
    this.options.changed(this.points);
  }

  private project([x, y, z]: Point): [number, number] {
    const [right, up] = this.options.flat ? [x, y] : [x + RIGHT * y, z + UP * y];
    return [WIDTH / 2 + right * this.scale, HEIGHT / 2 - up * this.scale];
  }

  private canvas(): Canvas {
    const at = (points: Point[]) => points.map((p) => this.project(p).join(",")).join(" ");
    const add = (element: SVGElement) => this.drawing.append(element);
    return {
      last: () => this.drawing.lastElementChild!,
      line: (from, to, kind = "") =>
        add(svg("polyline", { points: at([from, to]), class: `line ${kind}` })),
      area: (corners, kind = "") => add(svg("polygon", { points: at(corners), class: `area ${kind}` })),
      dot: (p, kind = "") => {
        const [cx, cy] = this.project(p);
        add(svg("circle", { cx, cy, r: 5, class: `dot ${kind}` }));
      },
      label: (p, words) => {
        const [x, y] = this.project(p), at = beside([x, y]);
        add(svg("text", { ...at, x: x + at.x, y: y + at.y }, words));
      },
    };
  }

  private addHandle(name: string): void {
    const handle = svg("g", { class: "handle", tabindex: 0, role: "button",
                              "aria-roledescription": "movable point", "data-point": name },
      svg("circle", { r: 16, class: "halo" }), svg("circle", { r: 7 }),
      svg("text", { "aria-hidden": "true" }, name));
    this.handles.set(name, handle);
    this.picture.append(handle);
    handle.addEventListener("pointerdown", (event) => {
      handle.setPointerCapture(event.pointerId);
      const start = this.points[name], from = this.position(event);
      const move = (e: PointerEvent) => {
        const now = this.position(e);
        const right = (now[0] - from[0]) / this.scale, up = (from[1] - now[1]) / this.scale;
        if (this.options.flat) this.set(name, [start[0] + right, start[1] + up, 0]);
        else if (e.shiftKey) this.set(name, [start[0], start[1] + up / UP, start[2]]);
        else this.set(name, [start[0] + right, start[1], start[2] + up]);
      };
      const stop = () => {
        handle.removeEventListener("pointermove", move);
        handle.removeEventListener("pointerup", stop);
        handle.removeEventListener("pointercancel", stop);
      };
      handle.addEventListener("pointermove", move);
      handle.addEventListener("pointerup", stop);
      handle.addEventListener("pointercancel", stop);
      event.preventDefault();
      handle.focus();
    });
    handle.addEventListener("keydown", (event) => {
      const up = this.options.flat ? 1 : 2;
      const moves: Record<string, [number, number]> = {
        ArrowLeft: [0, -1], ArrowRight: [0, 1], ArrowUp: [up, 1], ArrowDown: [up, -1],
        PageUp: [1, 1], PageDown: [1, -1],
      };
      const move = moves[event.key];
      if (!move || (this.options.flat && event.key.startsWith("Page"))) return;
      const to = [...this.points[name]] as [number, number, number];
      to[move[0]] += move[1] * this.step;
      this.set(name, to);
      event.preventDefault();
    });
  }

  private position(event: PointerEvent): [number, number] {
    const box = this.picture.getBoundingClientRect();
    return [((event.clientX - box.left) / box.width) * WIDTH,
            ((event.clientY - box.top) / box.height) * HEIGHT];
  }
}
