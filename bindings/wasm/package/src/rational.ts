// SPDX-License-Identifier: Apache-2.0
//
// Exact fractions.

/** A fraction in lowest terms, its denominator positive. */
export class Rational {
  private constructor(readonly above: bigint, readonly below: bigint) {}

  static of(above: bigint, below = 1n): Rational {
    if (below === 0n) throw new RangeError("a fraction with denominator 0");
    if (below < 0n) return Rational.of(-above, -below);
    let a = above < 0n ? -above : above, b = below;
    while (b !== 0n) [a, b] = [b, a % b];
    return new Rational(above / a, below / a);
  }

  /** Exactly the number that a finite double is. */
  static from(x: number): Rational {
    if (!Number.isFinite(x)) throw new RangeError(`${x} is no fraction`);
    const bits = new BigUint64Array(new Float64Array([x]).buffer)[0];
    const exponent = Number((bits >> 52n) & 0x7ffn);
    const fraction = bits & 0xfffffffffffffn;
    const whole = exponent === 0 ? fraction : fraction | 0x10000000000000n;
    const power = Math.max(exponent, 1) - 1075;
    const sign = bits >> 63n === 1n ? -1n : 1n;
    return power >= 0 ? Rational.of(sign * whole << BigInt(power))
                      : Rational.of(sign * whole, 1n << BigInt(-power));
  }

  /** "3", "-2/7", "0.125", "1e-3": exactly what is written; null if it is no number. */
  static parse(text: string): Rational | null {
    const [over, under, ...more] = text.trim().replace(/\u2212/g, "-").split("/");
    const decimal = (s: string) => {
      const m = /^([+-]?)(\d*)\.?(\d*)(?:e([+-]?\d{1,3}))?$/i.exec(s.trim());
      if (!m || (m[2] === "" && m[3] === "")) return null;
      const power = Number(m[4] ?? 0) - m[3].length;
      const digits = BigInt(m[1] + "0" + m[2] + m[3]);
      const ten = 10n ** BigInt(Math.abs(power));
      return power >= 0 ? Rational.of(digits * ten) : Rational.of(digits, ten);
    };
    const above = decimal(over), below = under === undefined ? Rational.of(1n) : decimal(under);
    if (more.length || !above || !below || below.above === 0n) return null;
    return above.over(below);
  }

  plus(q: Rational) {
    return Rational.of(this.above * q.below + q.above * this.below, this.below * q.below);
  }
  minus(q: Rational) {
    return Rational.of(this.above * q.below - q.above * this.below, this.below * q.below);
  }
  times(q: Rational) {
    return Rational.of(this.above * q.above, this.below * q.below);
  }
  over(q: Rational) {
    return Rational.of(this.above * q.below, this.below * q.above);
  }
  /** -1, 0 or 1. */
  get sign(): number {
    return this.above > 0n ? 1 : this.above < 0n ? -1 : 0;
  }
  compare(q: Rational): number {
    return this.minus(q).sign;
  }

  /** The nearest double, but for the last bit. */
  toNumber(): number {
    if (this.above === 0n) return 0;
    const size = (n: bigint) => n.toString(2).length;
    const a = this.above < 0n ? -this.above : this.above;
    const shift = 64 - (size(a) - size(this.below));
    const q = shift >= 0 ? (a << BigInt(shift)) / this.below : a / (this.below << BigInt(-shift));
    const half = Math.trunc(shift / 2);  // 2^-shift alone may be out of range
    return this.sign * Number(q) * 2 ** -half * 2 ** -(shift - half);
  }
  toString(): string {
    return this.below === 1n ? `${this.above}` : `${this.above}/${this.below}`;
  }
}
