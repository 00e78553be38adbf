// SPDX-License-Identifier: Apache-2.0
//
// Scenes: meshes made ready to be asked. What the answers mean is in docs/guarantees.md.
import { Floats, Memory, Room } from "./memory.js";
import { Triangles, Verdicts, askMethod } from "./methods.js";

/** No triangle: what `triangle` and `geometry` of a miss are. */
export const NONE = 0xffffffff;

/** The hits of a batch, in columns. facing: 0 front, 1 back. */
export interface Hits<F extends Floats> {
  t: F;
  u: F;
  v: F;
  w: F;
  geometry: Uint32Array;
  triangle: Uint32Array;
  facing: Uint8Array;
}

/** The hits of ray i are those from offsets[i] to offsets[i + 1] - 1, in their exact order. */
export interface HitLists<F extends Floats> extends Hits<F> {
  offsets: Uint32Array;
}

export interface Crossings {
  count: Uint32Array;
  signedCount: Int32Array;
  originOnSurface: Uint8Array;
}

/** feature: 0, 1, 2 the corner a, b, c; 3, 4, 5 the edge ab, bc, ca; 6 the face. */
export interface Nearest<F extends Floats> {
  point: F;
  distance: F;
  u: F;
  v: F;
  w: F;
  geometry: Uint32Array;
  triangle: Uint32Array;
  feature: Uint8Array;
}

export interface QueryOptions {
  /** A hit exactly at tMin does not count. */
  openStart?: boolean;
  sides?: "both" | "front" | "back";
  /** Of hits at the same exact t only the first counts. */
  distinct?: boolean;
  /** A ray that is not valid is a miss, not an error. */
  invalidMiss?: boolean;
  /** Of allHits: no more than these a ray; 0 for no limit. */
  maxHits?: number;
}

export interface PointOptions {
  /** Inside is where the surface winds around the point; else, where a ray crosses it oddly. */
  nonZero?: boolean;
  /** Do not ask whether the surface is closed. */
  openMesh?: boolean;
}

export interface BuildOptions {
  quality?: "balanced" | "fast" | "high" | "compact";
}

export interface SceneInfo {
  triangles: number;
  vertices: number;
  degenerate: number;
  nodes: number;
  leaves: number;
  sahCost: number;
  bytes: number;
}

const SIDES = ["both", "front", "back"];
const QUALITIES = ["balanced", "fast", "high", "compact"];

/** The library, loaded. */
export class Pierce {
  private constructor(private readonly memory: Memory) {}

  /** `wasm`: what is in pierce.wasm, or a module compiled of it. */
  static async load(wasm: BufferSource | WebAssembly.Module): Promise<Pierce> {
    return new Pierce(await Memory.load(wasm));
  }

  get version(): string {
    return this.memory.text(this.memory.call.pierce_version() >>> 0);
  }

  /** A scene of one mesh, which is copied: rows of three numbers and of three indices. */
  scene<F extends Floats>(vertices: F, triangles: Uint32Array, options: BuildOptions = {}): Scene<F> {
    return new Scene(this.memory, vertices, triangles, options);
  }

  /** The names of the textbook's methods that `ask` knows. */
  methods(): string[] {
    const names: string[] = [];
    for (let i = 0, at; (at = this.memory.call.pierce_method_name(i) >>> 0) !== 0; ++i)
      names.push(this.memory.text(at));
    return names;
  }

  /** What a method says of each ray and its own triangle (nine numbers); "exact" is the truth. */
  ask<F extends Floats>(method: string, rays: F, triangles: Triangles<F>): Verdicts<F> {
    const number = method === "exact" ? 0xffffffff : this.methods().indexOf(method);
    if (number < 0) throw new RangeError(`no method is called ${method}`);
    return askMethod(this.memory, number, rays, triangles);
  }
}

export class Scene<F extends Floats> {
  private handle = 0;
  private readonly double: boolean;
  private readonly kind: string;

  constructor(
    private readonly memory: Memory,
    vertices: F,
    triangles: Uint32Array,
    options: BuildOptions,
  ) {
    this.double = vertices instanceof Float64Array;
    this.kind = this.double ? "f64" : "f32";
    if (vertices.length % 3 || triangles.length % 3)
      throw new RangeError("vertices and triangles have three numbers each");
    memory.within((room) => {
      const mesh = room.words(room.copy(vertices), vertices.length / 3, room.copy(triangles),
                              triangles.length / 3);
      const quality = chosen(QUALITIES, options.quality ?? "balanced", "quality");
      const build = room.words(quality, 0, 0, 0, 0, 0, 0);
      const out = room.bytes(4);
      room.checked(`pierce_build_${this.kind}`, mesh, 1, build, out);
      this.handle = new DataView(memory.buffer).getUint32(out, true);
    });
  }

  /** Gives the memory back; the scene is not to be asked any more. */
  free(): void {
    this.memory.call[`pierce_free_${this.kind}`](this.handle);
    this.handle = 0;
  }

  get info(): SceneInfo {
    return this.memory.within((room) => {
      const out = room.bytes(56);
      room.checked(`pierce_info_${this.kind}`, this.alive(), out);
      const view = new DataView(this.memory.buffer, out);
      const n = [0, 1, 2, 3, 4, 6].map((i) => Number(view.getBigUint64(8 * i, true)));
      const [triangles, vertices, degenerate, nodes, leaves, bytes] = n;
      const sahCost = view.getFloat64(40, true);
      return { triangles, vertices, degenerate, nodes, leaves, sahCost, bytes };
    });
  }

  /** The first hit of each ray. Rays are rows of eight: origin, direction, tMin, tMax. */
  closestHits(rays: F, options: QueryOptions = {}): Hits<F> {
    return this.cast("closest_hits", rays, options, this.double ? 48 : 28, (at, n) => this.hits(at, n));
  }

  /** 1 where a ray hits anything, else 0. */
  anyHits(rays: F, options: QueryOptions = {}): Uint8Array {
    return this.cast("any_hits", rays, options, 1,
                     (at, n) => new Uint8Array(this.memory.buffer, at, n).slice());
  }

  countHits(rays: F, options: QueryOptions = {}): Uint32Array {
    return this.cast("count_hits", rays, options, 4,
                     (at, n) => new Uint32Array(this.memory.buffer, at, n).slice());
  }

  crossings(rays: F, options: QueryOptions = {}): Crossings {
    return this.cast("crossings", rays, options, 12, (at, n) => {
      const view = new DataView(this.memory.buffer, at);
      const index = Array.from({ length: n }, (_, i) => 12 * i);
      return {
        count: Uint32Array.from(index, (i) => view.getUint32(i, true)),
        signedCount: Int32Array.from(index, (i) => view.getInt32(i + 4, true)),
        originOnSurface: Uint8Array.from(index, (i) => view.getUint8(i + 8)),
      };
    });
  }

  /** Every hit of every ray, by exact t, then triangle. */
  allHits(rays: F, options: QueryOptions = {}): HitLists<F> {
    const count = rows(rays, 8, "rays");
    return this.memory.within((room) => {
      const at = room.made(`pierce_gather_${this.kind}`, this.alive(), this.copy(room, rays), count,
                           query(room, this.memory, options));
      const offsets = new Uint32Array(this.memory.buffer, at, count + 1).slice();
      const head = (4 * (count + 1) + 7) & ~7;
      return { offsets, ...this.hits(at + head, offsets[count]) };
    });
  }

  /** -1 outside, 0 exactly on the surface, 1 inside. Points are rows of three. */
  locate(points: F, options: PointOptions = {}): Int8Array {
    return this.points("locate", points, 1, options,
                       (at, n) => new Int8Array(this.memory.buffer, at, n).slice());
  }

  /** The distance to the surface, negative inside. */
  signedDistances(points: F, options: PointOptions = {}): F {
    return this.points("signed_distances", points, this.double ? 8 : 4, options,
                       (at, n) => this.floats(at, n).slice() as F);
  }

  /** The point of the surface nearest to each point, no farther away than `radius`. */
  nearestPoints(points: F, radius = Infinity): Nearest<F> {
    const count = rows(points, 3, "points");
    return this.memory.within((room) => {
      const size = this.double ? 72 : 40;
      const words = size / (this.double ? 8 : 4);
      const out = room.space(count * size);
      room.checked(`pierce_nearest_points_${this.kind}`, this.alive(), this.copy(room, points), count,
                   radius, 0, out);
      const numbers = this.floats(out, count * words);
      const column = (j: number) => this.column(count, (i) => numbers[i * words + j]);
      const view = new DataView(this.memory.buffer, out);
      const tail = this.double ? 56 : 28;
      return {
        point: this.column(3 * count, (i) => numbers[Math.floor(i / 3) * words + (i % 3)]),
        distance: column(3), u: column(4), v: column(5), w: column(6),
        geometry: Uint32Array.from({ length: count }, (_, i) => view.getUint32(i * size + tail, true)),
        triangle: Uint32Array.from({ length: count },
                                   (_, i) => view.getUint32(i * size + tail + 4, true)),
        feature: Uint8Array.from({ length: count }, (_, i) => view.getUint8(i * size + tail + 8)),
      };
    });
  }

  private alive(): number {
    if (this.handle === 0) throw new Error("this scene has been freed");
    return this.handle;
  }

  private floats(at: number, count: number): F {
    const Type = this.double ? Float64Array : Float32Array;
    return new Type(this.memory.buffer, at, count) as F;
  }

  private empty(length: number): F {
    return (this.double ? new Float64Array(length) : new Float32Array(length)) as F;
  }

  private column(length: number, value: (i: number) => number): F {
    const made = this.empty(length);
    for (let i = 0; i < length; ++i) made[i] = value(i);
    return made;
  }

  private copy(room: Room, numbers: F): number {
    if (numbers instanceof Float64Array !== this.double)
      throw new TypeError(`this scene is of ${this.double ? "doubles: give a Float64Array"
                                                          : "floats: give a Float32Array"}`);
    return room.copy(numbers);
  }

  private hits(at: number, count: number): Hits<F> {
    const words = this.double ? 6 : 7, stride = this.double ? 12 : 7, first = this.double ? 8 : 4;
    const numbers = this.floats(at, count * words);
    const integers = new Uint32Array(this.memory.buffer, at, count * stride);
    const t = this.empty(count), u = this.empty(count), v = this.empty(count), w = this.empty(count);
    const geometry = new Uint32Array(count), triangle = new Uint32Array(count);
    const facing = new Uint8Array(count);
    for (let i = 0, n = 0, k = first; i < count; ++i, n += words, k += stride) {
      t[i] = numbers[n];
      u[i] = numbers[n + 1];
      v[i] = numbers[n + 2];
      w[i] = numbers[n + 3];
      geometry[i] = integers[k];
      triangle[i] = integers[k + 1];
      facing[i] = integers[k + 2];
    }
    return { t, u, v, w, geometry, triangle, facing };
  }

  private cast<T>(name: string, rays: F, options: QueryOptions, bytes: number,
                  read: (at: number, count: number) => T): T {
    const count = rows(rays, 8, "rays");
    return this.memory.within((room) => {
      const out = room.space(count * bytes);
      room.checked(`pierce_${name}_${this.kind}`, this.alive(), this.copy(room, rays), count,
                   query(room, this.memory, options), out);
      return read(out, count);
    });
  }

  private points<T>(name: string, points: F, bytes: number, options: PointOptions,
                    read: (at: number, count: number) => T): T {
    const count = rows(points, 3, "points");
    return this.memory.within((room) => {
      const out = room.space(count * bytes);
      const given = room.words(Number(options.nonZero ?? false), Number(options.openMesh ?? false),
                               0, 0, 0, 0);
      room.checked(`pierce_${name}_${this.kind}`, this.alive(), this.copy(room, points), count, given,
                   out);
      return read(out, count);
    });
  }
}

function rows(numbers: Floats, width: number, name: string): number {
  if (numbers.length % width) throw new RangeError(`${name} are rows of ${width} numbers`);
  return numbers.length / width;
}

function chosen(names: string[], name: string, what: string): number {
  const number = names.indexOf(name);
  if (number < 0) throw new RangeError(`${what} is ${name}: give one of ${names.join(", ")}`);
  return number;
}

function query(room: Room, memory: Memory, options: QueryOptions): number {
  const at = room.bytes(64);
  const view = new DataView(memory.buffer, at);
  view.setUint32(0, Number(options.openStart ?? false), true);
  view.setUint32(4, chosen(SIDES, options.sides ?? "both", "sides"), true);
  view.setUint32(8, Number(options.distinct ?? false), true);
  view.setUint32(12, Number(options.invalidMiss ?? false), true);
  view.setBigUint64(32, BigInt(options.maxHits ?? 0), true);
  return at;
}
