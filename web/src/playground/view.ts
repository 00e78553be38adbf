// SPDX-License-Identifier: Apache-2.0
//
// The picture: a mesh, a ray from O towards T, its hits, a point and its nearest point. Orbit with the
// mouse; O, T and the point X can be dragged across the view.
import * as three from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import type { Mesh } from "../library.js";
import type { Heat } from "./heat.js";

export type Place = [number, number, number];
export type Named = "O" | "T" | "X";

const COLOURS = { O: 0x1565c0, T: 0x1565c0, X: 0x8e24aa };
// Made once: a ray that is dragged has new marks in every frame.
const SPHERE = new three.SphereGeometry(1, 14, 10);
const lined = (color: number) => new three.LineBasicMaterial({ color, depthTest: false, transparent: true });
const LINES = { ray: lined(COLOURS.O), nearest: lined(COLOURS.X) };
const balled = (color: number) =>
  new three.MeshBasicMaterial({ color, depthTest: false, transparent: true, opacity: 0.9 });
const BALLS = { first: balled(0xd50000), hit: balled(0xef6c00), nearest: balled(COLOURS.X) };

export class View {
  private readonly renderer = new three.WebGLRenderer({ antialias: true, alpha: true });
  private readonly scene = new three.Scene();
  readonly camera = new three.PerspectiveCamera(40, 1, 0.01, 1000);
  readonly controls: OrbitControls;
  private mesh?: three.Mesh;
  private readonly handles = {} as Record<Named, three.Mesh>;
  private readonly marks = new three.Group();
  private size = 1;

  constructor(place: HTMLElement, moved: (name: Named, to: Place) => void, private readonly turned: () => void) {
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    const canvas = this.renderer.domElement;
    canvas.setAttribute("aria-hidden", "true");  // the form and the table say all of it
    place.append(canvas);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener("change", () => {
      this.draw();
      this.turned();
    });
    this.scene.add(new three.HemisphereLight(0xffffff, 0x8899aa, 2.2));
    const sun = new three.DirectionalLight(0xffffff, 1.6);
    this.camera.add(sun);
    this.scene.add(this.camera, this.marks);
    for (const name of ["O", "T", "X"] as const) {
      this.handles[name] = new three.Mesh(new three.SphereGeometry(1, 20, 14),
        new three.MeshStandardMaterial({ color: COLOURS[name] }));
      this.scene.add(this.handles[name]);
    }
    this.drag(canvas, moved);
    new ResizeObserver(() => this.resize(place)).observe(place);
    this.resize(place);
  }

  show(mesh: Mesh): void {
    if (this.mesh) {
      this.scene.remove(this.mesh);
      this.mesh.geometry.dispose();
    }
    const geometry = new three.BufferGeometry();  // corners apart: each triangle has a colour
    const positions = new Float32Array(3 * mesh.triangles.length);
    for (let i = 0; i < positions.length; ++i)
      positions[i] = mesh.vertices[3 * mesh.triangles[Math.floor(i / 3)] + (i % 3)];
    geometry.setAttribute("position", new three.BufferAttribute(positions, 3));
    geometry.setAttribute("color", new three.BufferAttribute(new Float32Array(positions.length).fill(1), 3));
    geometry.computeVertexNormals();
    geometry.computeBoundingSphere();
    this.size = geometry.boundingSphere!.radius;
    this.mesh = new three.Mesh(geometry, new three.MeshStandardMaterial({
      color: 0xc9b28f, vertexColors: true, side: three.DoubleSide, transparent: true, opacity: 0.82,
      roughness: 0.9 }));
    this.scene.add(this.mesh);
  }

  look(from: Place, at: Place): void {
    this.camera.position.set(...from);
    this.controls.target.set(...at);
    this.camera.near = this.size / 100;
    this.camera.far = this.size * 100;
    this.camera.updateProjectionMatrix();
    this.controls.update();
  }

  paint(heat: Heat | null): void {
    const colours = this.mesh!.geometry.getAttribute("color") as three.BufferAttribute;
    const array = colours.array as Float32Array;
    if (!heat) array.fill(1);
    else
      heat.wrong.forEach((n, i) => {
        const [r, g, b] = n === 0 ? [1, 1, 1] : [1, 0.45 - 0.045 * n, 0.1];
        for (let k = 0; k < 9; k += 3) array.set([r, g, b], 9 * i + k);
      });
    colours.needsUpdate = true;
    this.draw();
  }

  place(points: Record<Named, Place>, hits: Place[], nearest: Place | null): void {
    const radius = this.size / 60;
    for (const name of ["O", "T", "X"] as const) {
      this.handles[name].position.set(...points[name]);
      this.handles[name].scale.setScalar(radius);
    }
    for (const mark of this.marks.children) if (mark instanceof three.Line) mark.geometry.dispose();
    this.marks.clear();
    const o = new three.Vector3(...points.O), t = new three.Vector3(...points.T);
    const end = o.clone().add(t.clone().sub(o).normalize().multiplyScalar(6 * this.size));
    this.marks.add(line([o, end], LINES.ray));
    if (nearest) {
      this.marks.add(line([new three.Vector3(...points.X), new three.Vector3(...nearest)], LINES.nearest));
      this.marks.add(ball(nearest, BALLS.nearest, radius * 0.6));
    }
    hits.forEach((p, i) => this.marks.add(ball(p, i ? BALLS.hit : BALLS.first, radius * 0.7)));
    this.draw();
  }

  draw(): void {
    this.renderer.render(this.scene, this.camera);
  }

  private resize(place: HTMLElement): void {
    const { clientWidth: w, clientHeight: h } = place;
    if (w === 0 || h === 0) return;
    this.renderer.setSize(w, h);
    this.camera.aspect = w / h;
    this.camera.updateProjectionMatrix();
    this.draw();
  }

  private drag(canvas: HTMLCanvasElement, moved: (name: Named, to: Place) => void): void {
    const caster = new three.Raycaster(), plane = new three.Plane(), at = new three.Vector3();
    let held: Named | null = null;
    const aim = (event: PointerEvent) => {
      const box = canvas.getBoundingClientRect();
      caster.setFromCamera(new three.Vector2(((event.clientX - box.left) / box.width) * 2 - 1,
        1 - ((event.clientY - box.top) / box.height) * 2), this.camera);
    };
    canvas.addEventListener("pointerdown", (event) => {
      aim(event);
      const found = caster.intersectObjects(Object.values(this.handles))[0];
      if (!found) return;
      held = (Object.keys(this.handles) as Named[]).find((n) => this.handles[n] === found.object)!;
      plane.setFromNormalAndCoplanarPoint(this.camera.getWorldDirection(at).clone(),
        this.handles[held].position);
      this.controls.enabled = false;
      canvas.setPointerCapture(event.pointerId);
    }, { capture: true });
    canvas.addEventListener("pointermove", (event) => {
      if (!held) return;
      aim(event);
      if (caster.ray.intersectPlane(plane, at)) moved(held, [at.x, at.y, at.z]);
    });
    const drop = () => {
      held = null;
      this.controls.enabled = true;
    };
    canvas.addEventListener("pointerup", drop);
    canvas.addEventListener("pointercancel", drop);
  }
}

function line(points: three.Vector3[], material: three.LineBasicMaterial): three.Line {
  return new three.Line(new three.BufferGeometry().setFromPoints(points), material);
}

function ball(at: Place, material: three.MeshBasicMaterial, radius: number): three.Mesh {
  const made = new three.Mesh(SPHERE, material);
  made.position.set(...at);
  made.scale.setScalar(radius);
  made.renderOrder = 2;
  return made;
}
