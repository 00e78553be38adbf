// SPDX-License-Identifier: Apache-2.0
//
// Three kinds of numbers, and vectors of them. The order of operations is that of
// include/pierce/vector.h, so that floats come out the same to the bit.
import { Rational } from "./rational.js";

export interface Numbers<T> {
  of(x: number): T;
  add(x: T, y: T): T;
  sub(x: T, y: T): T;
  mul(x: T, y: T): T;
  div(x: T, y: T): T;
  /** Negative, 0 or positive, as x is less than, equal to or greater than y. */
  compare(x: T, y: T): number;
  toNumber(x: T): number;
  show(x: T): string;
}

/** Every operation rounded to float: a double holds the exact sum or product of two floats, or
    enough of the quotient, so rounding it once more is right. */
export const float32: Numbers<number> = {
  of: Math.fround,
  add: (x, y) => Math.fround(x + y),
  sub: (x, y) => Math.fround(x - y),
  mul: (x, y) => Math.fround(x * y),
  div: (x, y) => Math.fround(x / y),
  compare: (x, y) => x - y,
  toNumber: (x) => x,
  show: (x) => String(Number(x.toPrecision(9))),
};

export const float64: Numbers<number> = {
  of: (x) => x,
  add: (x, y) => x + y,
  sub: (x, y) => x - y,
  mul: (x, y) => x * y,
  div: (x, y) => x / y,
  compare: (x, y) => x - y,
  toNumber: (x) => x,
  show: String,
};

export const exact: Numbers<Rational> = {
  of: Rational.from,
  add: (x, y) => x.plus(y),
  sub: (x, y) => x.minus(y),
  mul: (x, y) => x.times(y),
  div: (x, y) => x.over(y),
  compare: (x, y) => x.compare(y),
  toNumber: (x) => x.toNumber(),
  show: (x) => x.toString(),
};

export type Vec<T> = readonly [T, T, T];

export function vectors<T>(n: Numbers<T>) {
  const { add, sub, mul } = n;
  const dot = (p: Vec<T>, q: Vec<T>): T =>
    add(add(mul(p[0], q[0]), mul(p[1], q[1])), mul(p[2], q[2]));
  const cross = (p: Vec<T>, q: Vec<T>): Vec<T> => [
    sub(mul(p[1], q[2]), mul(p[2], q[1])),
    sub(mul(p[2], q[0]), mul(p[0], q[2])),
    sub(mul(p[0], q[1]), mul(p[1], q[0])),
  ];
  return {
    dot,
    cross,
    minus: (p: Vec<T>, q: Vec<T>): Vec<T> => [sub(p[0], q[0]), sub(p[1], q[1]), sub(p[2], q[2])],
    plus: (p: Vec<T>, q: Vec<T>): Vec<T> => [add(p[0], q[0]), add(p[1], q[1]), add(p[2], q[2])],
    scaled: (k: T, p: Vec<T>): Vec<T> => [mul(k, p[0]), mul(k, p[1]), mul(k, p[2])],
    negated: (p: Vec<T>): Vec<T> => p.map((x) => mul(n.of(-1), x)) as unknown as Vec<T>,
    determinant: (x: Vec<T>, y: Vec<T>, z: Vec<T>): T => dot(x, cross(y, z)),
    /** The axis along which p is longest; of equal ones, the first. */
    longestAxis: (p: Vec<T>): number => {
      const zero = n.of(0);
      const size = p.map((x) => (n.compare(x, zero) < 0 ? sub(zero, x) : x));
      if (n.compare(size[0], size[1]) >= 0 && n.compare(size[0], size[2]) >= 0) return 0;
      return n.compare(size[1], size[2]) >= 0 ? 1 : 2;
    },
  };
}
