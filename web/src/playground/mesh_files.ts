// SPDX-License-Identifier: Apache-2.0
//
// Meshes that are dropped on the page: OBJ, STL, and PLY of little-endian binary or of text.
import type { Mesh } from "../library.js";

export async function readMesh(file: File): Promise<Mesh> {
  const bytes = await file.arrayBuffer();
  const kind = file.name.toLowerCase().split(".").pop();
  const mesh = kind === "obj" ? obj(new TextDecoder().decode(bytes)) : kind === "stl" ? stl(bytes)
    : kind === "ply" ? ply(bytes) : null;
  if (!mesh) throw new Error(`${file.name}: give a file named .obj, .stl or .ply`);
  if (mesh.triangles.length === 0) throw new Error(`${file.name}: no triangle was found in it`);
  return { ...mesh, name: file.name };
}

type Bare = Omit<Mesh, "name">;

function fan(corners: number[], into: number[]): void {
  for (let i = 2; i < corners.length; ++i) into.push(corners[0], corners[i - 1], corners[i]);
}

function obj(text: string): Bare {
  const vertices: number[] = [], triangles: number[] = [];
  for (const line of text.split("\n")) {
    const [kind, ...rest] = line.trim().split(/\s+/);
    if (kind === "v") vertices.push(...rest.slice(0, 3).map(Number));
    if (kind === "f") {
      const index = (word: string) => {
        const n = parseInt(word, 10);
        return n < 0 ? vertices.length / 3 + n : n - 1;
      };
      fan(rest.map(index), triangles);
    }
  }
  return { vertices: Float32Array.from(vertices), triangles: Uint32Array.from(triangles) };
}

/** Corners at the same place become one vertex, so that the surface is closed where it was. */
function stl(bytes: ArrayBuffer): Bare {
  const view = new DataView(bytes);
  const numbers: number[] = [];
  if (bytes.byteLength >= 84 && bytes.byteLength === 84 + 50 * view.getUint32(80, true)) {
    for (let at = 84; at < bytes.byteLength; at += 50)
      for (let k = 0; k < 9; ++k) numbers.push(view.getFloat32(at + 12 + 4 * k, true));
  } else {
    for (const m of new TextDecoder().decode(bytes).matchAll(/vertex\s+(\S+)\s+(\S+)\s+(\S+)/g))
      numbers.push(Number(m[1]), Number(m[2]), Number(m[3]));
  }
  const places = new Map<string, number>(), vertices: number[] = [], triangles: number[] = [];
  for (let i = 0; i + 2 < numbers.length; i += 3) {
    const at = numbers.slice(i, i + 3), key = at.join();
    if (!places.has(key)) {
      places.set(key, vertices.length / 3);
      vertices.push(...at);
    }
    triangles.push(places.get(key)!);
  }
  return { vertices: Float32Array.from(vertices), triangles: Uint32Array.from(triangles) };
}

const SIZES: Record<string, number> = { char: 1, uchar: 1, int8: 1, uint8: 1, short: 2, ushort: 2,
  int16: 2, uint16: 2, int: 4, uint: 4, int32: 4, uint32: 4, float: 4, float32: 4, double: 8, float64: 8 };

function ply(bytes: ArrayBuffer): Bare {
  const head = new TextDecoder("latin1").decode(bytes.slice(0, 65536));
  const end = head.indexOf("end_header");
  if (!head.startsWith("ply") || end < 0) throw new Error("this is no PLY file: its header is missing");
  const lines = head.slice(0, end).split("\n").map((line) => line.trim().split(/\s+/));
  const format = lines.find((words) => words[0] === "format")?.[1];
  const data = bytes.slice(head.indexOf("\n", end) + 1);
  let next: (type: string) => number;
  if (format === "ascii") {
    const words = new TextDecoder().decode(data).split(/\s+/).filter(Boolean);
    let i = 0;
    next = () => Number(words[i++]);
  } else if (format === "binary_little_endian") {
    const view = new DataView(data);
    let at = 0;
    next = (type) => {
      const size = SIZES[type], here = at;
      if (!size) throw new Error(`${type} is no type of a PLY property`);
      at += size;
      if (/float|double/.test(type))
        return size === 4 ? view.getFloat32(here, true) : view.getFloat64(here, true);
      return size === 1 ? view.getUint8(here) : size === 2 ? view.getUint16(here, true)
                                                           : view.getUint32(here, true);
    };
  } else {
    throw new Error(`PLY ${format}: only ascii and binary_little_endian are read here`);
  }
  const vertices: number[] = [], triangles: number[] = [];
  for (let i = 0; i < lines.length; ++i) {
    if (lines[i][0] !== "element") continue;
    const [, element, count] = lines[i];
    const properties: string[][] = [];
    for (let j = i + 1; j < lines.length && lines[j][0] !== "element"; ++j)
      if (lines[j][0] === "property") properties.push(lines[j].slice(1));
    for (let row = 0; row < Number(count); ++row)
      for (const property of properties) {
        if (property[0] === "list") {
          const corners = Array.from({ length: next(property[1]) }, () => next(property[2]));
          if (element === "face" && /vertex_ind/.test(property[3])) fan(corners, triangles);
        } else {
          const value = next(property[0]);
          if (element === "vertex" && "xyz".includes(property[1])) vertices.push(value);
        }
      }
  }
  return { vertices: Float32Array.from(vertices), triangles: Uint32Array.from(triangles) };
}
