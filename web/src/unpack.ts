// SPDX-License-Identifier: Apache-2.0
//
// LZMA, as `xz --format=raw --lzma1=lc=3,lp=0,pb=0` packs: a quarter less than what browsers unpack
// themselves. The way of it is I. Pavlov's specification (in the public domain).

// Where the probabilities of each kind of bit begin.
const MATCH = 0, REP = 12, REP0 = 24, REP1 = 36, REP2 = 48, REP0_LONG = 60;
const SLOT = 72, SPECIAL = SLOT + 256, ALIGN = SPECIAL + 128, LENGTH = ALIGN + 16;
const REP_LENGTH = LENGTH + 274, LITERAL = REP_LENGTH + 274;

/** The `size` bytes that were packed. */
export function unpacked(packed: Uint8Array, size: number): Uint8Array<ArrayBuffer> {
  const out = new Uint8Array(size);
  const odds = new Uint16Array(LITERAL + 0x300 * 8).fill(1024);
  let at = 1, range = 0xffffffff, code = 0;
  while (at < 5) code = ((code << 8) | packed[at++]) >>> 0;

  const refill = () => {
    if (range >= 0x1000000) return;
    range = (range << 8) >>> 0;
    code = ((code << 8) | (packed[at++] ?? 0)) >>> 0;
  };
  const bit = (index: number): number => {
    const odd = odds[index], bound = (range >>> 11) * odd;
    const answer = code < bound ? 0 : 1;
    if (answer) {
      range -= bound;
      code -= bound;
      odds[index] -= odd >> 5;
    } else {
      range = bound;
      odds[index] += (2048 - odd) >> 5;
    }
    refill();
    return answer;
  };
  const tree = (base: number, bits: number): number => {
    let m = 1;
    for (let i = 0; i < bits; ++i) m = (m << 1) | bit(base + m);
    return m - (1 << bits);
  };
  const reversed = (base: number, bits: number): number => {
    let m = 1, value = 0;
    for (let i = 0; i < bits; ++i) {
      const next = bit(base + m);
      m = (m << 1) | next;
      value |= next << i;
    }
    return value;
  };
  const even = (bits: number): number => {
    let value = 0;
    for (let i = 0; i < bits; ++i) {
      range >>>= 1;
      const next = code >= range ? 1 : 0;
      if (next) code -= range;
      value = value * 2 + next;
      refill();
    }
    return value;
  };
  const length = (base: number): number => {
    if (!bit(base)) return tree(base + 2, 3);
    return bit(base + 1) ? 16 + tree(base + 18, 8) : 8 + tree(base + 10, 3);
  };
  const distance = (long: number): number => {
    const slot = tree(SLOT + 64 * Math.min(long, 3), 6);
    if (slot < 4) return slot;
    const bits = (slot >> 1) - 1, high = (2 | (slot & 1)) * 2 ** bits;
    if (slot < 14) return high + reversed(SPECIAL + high - slot, bits);
    return high + even(bits - 4) * 16 + reversed(ALIGN, 4);
  };

  const far = [0, 0, 0, 0]; // the last four distances
  for (let to = 0, state = 0; to < size; ) {
    if (!bit(MATCH + state)) {
      const base = LITERAL + 0x300 * ((to ? out[to - 1] : 0) >> 5);
      let symbol = 1;
      if (state >= 7) {
        let match = out[to - far[0] - 1];
        while (symbol < 256) {
          const likely = match >> 7, next = bit(base + ((1 + likely) << 8) + symbol);
          match = (match << 1) & 255;
          symbol = (symbol << 1) | next;
          if (likely !== next) break;
        }
      }
      while (symbol < 256) symbol = (symbol << 1) | bit(base + symbol);
      out[to++] = symbol;
      state = state < 4 ? 0 : state < 10 ? state - 3 : state - 6;
      continue;
    }
    let count = 0;
    if (bit(REP + state)) {
      if (!bit(REP0 + state)) {
        if (!bit(REP0_LONG + state)) {
          out[to] = out[to - far[0] - 1];
          ++to;
          state = state < 7 ? 9 : 11;
          continue;
        }
      } else {
        const which = !bit(REP1 + state) ? 1 : !bit(REP2 + state) ? 2 : 3;
        far.unshift(...far.splice(which, 1));
      }
      count = length(REP_LENGTH) + 2;
      state = state < 7 ? 8 : 11;
    } else {
      const long = length(LENGTH);
      far.pop();
      far.unshift(distance(long));
      if (far[0] === 0xffffffff) break; // the end
      count = long + 2;
      state = state < 7 ? 7 : 10;
    }
    for (const end = Math.min(to + count, size); to < end; ++to) out[to] = out[to - far[0] - 1];
  }
  return out;
}
