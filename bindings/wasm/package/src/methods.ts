// SPDX-License-Identifier: Apache-2.0
//
// The textbook's methods as the C++ headers have them, many rays at a time.
import { Floats, Memory } from "./memory.js";

/** Nine numbers a triangle: the corners a, b, c. */
export type Triangles<F extends Floats> = F;

export interface Verdicts<F extends Floats> {
  /** 1 for a hit, 0 for none; then t, u, v are 0. */
  hit: Uint8Array;
  t: F;
  u: F;
  v: F;
}

export function askMethod<F extends Floats>(memory: Memory, method: number, rays: F,
                                            triangles: Triangles<F>): Verdicts<F> {
  const count = rays.length / 8;
  if (rays.length % 8 || triangles.length !== 9 * count)
    throw new RangeError("rays are rows of 8 numbers, triangles of 9, and they are equally many");
  const double = rays instanceof Float64Array;
  if (triangles instanceof Float64Array !== double)
    throw new TypeError("rays and triangles are of the same type");
  return memory.within((room) => {
    const Type = double ? Float64Array : Float32Array;
    const out = room.bytes(count * 4 * Type.BYTES_PER_ELEMENT);
    const name = double ? "pierce_textbook_f64" : "pierce_textbook_f32";
    const from = room.copy(rays), at = room.copy(triangles);
    if (memory.call[name](method, from, at, count, out) !== 0)
      throw new RangeError(`there is no method ${method}`);
    const answers = new Type(memory.buffer, out, 4 * count);
    const column = (j: number) => {
      const made = new Type(count);
      for (let i = 0; i < count; ++i) made[i] = answers[4 * i + j];
      return made as unknown as F;
    };
    return { hit: Uint8Array.from(column(0)), t: column(1), u: column(2), v: column(3) };
  });
}
