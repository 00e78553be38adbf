// SPDX-License-Identifier: Apache-2.0
//
// The playground: a mesh, a ray and a point to move, and everything that pierce says of them.
import type { Pierce, Scene } from "pierce-wasm";
import { PierceError } from "pierce-wasm";
import { h } from "../dom.js";
import { type Mesh, bunny, library } from "../library.js";
import { type Heat, heatOf } from "./heat.js";
import { readMesh } from "./mesh_files.js";
import { type Named, type Place, View } from "./view.js";

interface State extends Record<Named, Place> {
  eye: Place;
  at: Place;
  method: string;
}

const START: State = { O: [-2.1, 0.35, 0.6], T: [-1.1, 0.2, 0.35], X: [0.3, 0.2, 1.1],
  eye: [-2.2, 1.2, 4.4], at: [0, 0, 0], method: "" };
const AXES = ["x", "y", "z"];

/** The link holds the state: three numbers for each place, and the method. */
export function stateOf(hash: string): Partial<State> {
  const given = new URLSearchParams(hash.replace(/^#/, ""));
  const state: Partial<State> = {};
  for (const name of ["O", "T", "X", "eye", "at"] as const) {
    const numbers = (given.get(name) ?? "").split(",").map(Number);
    if (numbers.length === 3 && numbers.every(Number.isFinite)) state[name] = numbers as Place;
  }
  if (given.has("method")) state.method = given.get("method")!;
  return state;
}

export class Playground {
  readonly element: HTMLElement;
  private readonly state: State;
  private readonly inputs = new Map<string, HTMLInputElement>();
  private readonly stagePlace = h("div", { class: "view" });
  private readonly hits = h("tbody");
  private readonly told = h("p", { class: "verdict", role: "status", "data-verdict": "playground" },
                            "Loading pierce and the bunny.");
  private readonly heatTold = h("p", { role: "status", class: "heat-told" });
  private readonly method = h("select", { id: "heat-method" }, h("option", { value: "" }, "none"));
  private view?: View;
  private pierce?: Pierce;
  private scene?: Scene<Float32Array>;
  private mesh?: Mesh;
  private heat: Heat | null = null;
  private saving = 0;

  constructor() {
    this.state = { ...START, ...stateOf(location.hash) };
    const file = h("input", { type: "file", id: "mesh-file", accept: ".obj,.stl,.ply", change: () => {
      if (file.files?.[0]) void this.take(file.files[0]);
    } });
    this.method.addEventListener("change", () => this.warm());
    const points = (["O", "T", "X"] as const).map((name) => this.fields(name));
    const table = h("table", {}, h("caption", {}, "Every hit, in its exact order"),
      h("thead", {}, h("tr", {}, ...["", "triangle", "t", "u", "v", "side"].map((w) =>
        h("th", { scope: "col" }, w || "order")))), this.hits);
    this.element = h("section", { id: "playground", "aria-labelledby": "playground-title" },
      h("h2", { id: "playground-title" }, "Playground"),
      h("p", {}, "A ray from O towards T, and a point X. Drag them in the picture, or change their numbers; drag beside " +
        "them to turn the mesh. Drop a mesh of your own on the picture (OBJ, STL, PLY): it stays on your machine."),
      this.stagePlace, this.told,
      h("div", { class: "controls" }, ...points,
        h("p", {}, h("label", { for: "mesh-file" }, "Mesh "), file),
        h("p", {}, h("label", { for: "heat-method" }, "Heat map: where does this method err? "), this.method)),
      this.heatTold,
      h("div", { class: "wide", tabindex: 0, role: "group", "aria-label": "hits" }, table));
    this.stagePlace.addEventListener("dragover", (e) => e.preventDefault());
    this.stagePlace.addEventListener("drop", (e) => {
      e.preventDefault();
      const dropped = e.dataTransfer?.files[0];
      if (dropped) void this.take(dropped);
    });
  }

  async start(): Promise<void> {
    try {
      this.view = new View(this.stagePlace, (name, to) => this.move(name, to), () => this.save());
    } catch {
      this.stagePlace.classList.add("bare");
      this.stagePlace.append(h("p", {}, "There is no WebGL here: no picture, but all numbers below."));
    }
    this.pierce = await library;
    this.method.append(...this.pierce.methods().map((name) => h("option", {}, name)));
    this.method.value = this.state.method;
    this.use(await bunny());
    this.view?.look(this.state.eye, this.state.at);
    this.answer();
    this.warm();
  }

  private fields(name: Named): HTMLElement {
    const words = { O: "Origin O", T: "Towards T", X: "Point X" }[name];
    return h("fieldset", {}, h("legend", {}, words), ...AXES.map((axis, k) => {
      const input = h("input", { type: "number", step: 0.01, id: `${name}-${axis}`,
                                 value: this.state[name][k], input: () => {
        const value = input.valueAsNumber;
        if (!Number.isFinite(value)) return;
        const to = [...this.state[name]] as Place;
        to[k] = value;
        this.move(name, to, false);
      } });
      this.inputs.set(`${name}-${axis}`, input);
      return h("label", {}, `${axis} `, input);
    }));
  }

  private move(name: Named, to: Place, write = true): void {
    this.state[name] = to.map(Math.fround) as Place;
    if (write)
      AXES.forEach((axis, k) => (this.inputs.get(`${name}-${axis}`)!.value = to[k].toFixed(4)));
    this.answer();
    this.save();
  }

  private async take(file: File): Promise<void> {
    try {
      const mesh = await readMesh(file);
      this.use(mesh);
      const [low, high] = [Infinity, -Infinity].map((start, i) => [0, 1, 2].map((k) => {
        let best = start;
        for (let j = k; j < mesh.vertices.length; j += 3)
          best = i ? Math.max(best, mesh.vertices[j]) : Math.min(best, mesh.vertices[j]);
        return best;
      }));
      const at = low.map((x, k) => (x + high[k]) / 2) as Place;
      const size = Math.hypot(...low.map((x, k) => high[k] - x)) || 1;
      this.view?.look([at[0] - size * 0.6, at[1] + size * 0.4, at[2] + size * 1.3], at);
      this.move("O", [at[0] - size, at[1] + 0.1 * size, at[2] + 0.2 * size]);
      this.move("T", at);
      this.move("X", [at[0] + 0.1 * size, at[1], at[2] + 0.6 * size]);
      this.warm();
    } catch (error) {
      this.told.textContent = error instanceof Error ? error.message : String(error);
    }
  }

  private use(mesh: Mesh): void {
    const scene = this.pierce!.scene(mesh.vertices, mesh.triangles);
    this.scene?.free();
    this.scene = scene;
    this.mesh = mesh;
    this.view?.show(mesh);
  }

  private answer(): void {
    if (!this.scene) return;
    const { O, T, X } = this.state;
    const d = T.map((x, k) => Math.fround(x - O[k]));
    const point = Float32Array.from(X);
    const nearest = this.scene.nearestPoints(point);
    const inside = this.located(point);
    const near = `X is ${inside}; the surface is ${nearest.distance[0].toPrecision(6)} away, nearest at triangle ` +
      `${nearest.triangle[0]}.`;
    if (d.every((x) => x === 0)) {
      this.told.textContent = `O and T are the same: this is no ray. ${near}`;
      return;
    }
    const ray = Float32Array.of(...O, ...d, 0, Infinity);
    const all = this.scene.allHits(ray), { count, originOnSurface } = this.scene.crossings(ray);
    const places = Array.from(all.t, (t) => O.map((x, k) => x + t * d[k]) as Place);
    this.hits.replaceChildren(...Array.from(all.t, (t, i) => h("tr", {},
      h("th", { scope: "row" }, String(i + 1)), h("td", {}, String(all.triangle[i])),
      ...[t, all.u[i], all.v[i]].map((x) => h("td", {}, String(Number(x.toPrecision(9))))),
      h("td", {}, all.facing[i] ? "back" : "front"))));
    this.told.textContent = `${all.t.length} hits, ${count[0]} passages through the surface` +
      `${originOnSurface[0] ? ", O lies on it" : ""}; O is ${this.located(Float32Array.from(O))}. ${near}`;
    this.view?.place({ O, T, X }, places, [...nearest.point] as Place);
  }

  private located(point: Float32Array): string {
    try {
      return ["outside", "exactly on the surface", "inside"][this.scene!.locate(point)[0] + 1];
    } catch (error) {
      if (!(error instanceof PierceError)) throw error;
      return "neither inside nor outside (the surface is not closed)";
    }
  }

  private warm(): void {
    const method = (this.state.method = this.method.value);
    this.save();
    this.heat = method ? heatOf(this.pierce!, this.mesh!, method, this.state.O) : null;
    this.view?.paint(this.heat);
    this.heatTold.textContent = this.heat
      ? `${method}, in float: ${this.heat.total} of ${this.heat.rays} answers are wrong, of rays from O to vertices, ` +
        "edges and the inside of each triangle. The redder a triangle, the more of its ten."
      : "";
  }

  private save(): void {
    clearTimeout(this.saving);
    this.saving = window.setTimeout(() => {
      if (this.view) {
        const { x, y, z } = this.view.camera.position, at = this.view.controls.target;
        this.state.eye = [x, y, z];
        this.state.at = [at.x, at.y, at.z];
      }
      const parts = (["O", "T", "X", "eye", "at"] as const).map((name) =>
        `${name}=${this.state[name].map((x) => Number(x.toPrecision(8))).join(",")}`);
      if (this.state.method) parts.push(`method=${encodeURIComponent(this.state.method)}`);
      history.replaceState(null, "", `#${parts.join("&")}`);
    }, 200);
  }
}
