// SPDX-License-Identifier: Apache-2.0
//
// The module's memory, and calls into it.

/** What the module exports: the functions of pierce/pierce_c.h and bindings/wasm/wasm.h. */
export type Exports = Record<string, (...args: number[]) => number>;

/** Thrown for whatever is refused; the message names the first offender and the cure. */
export class PierceError extends Error {
  constructor(
    readonly code: string,
    message: string,
    /** By which number the message names the first offender; -1 if by none. */
    readonly index: number,
    readonly count: number,
  ) {
    super(message);
    this.name = "PierceError";
  }
}

const ERROR_BYTES = 1024;
const SIZES = [ERROR_BYTES, 64, 24]; // as pierce_size gives them
const NO_SYSTEM = 52; // ENOSYS

/** The numbers of a scene, its rays and its answers. */
export type Floats = Float32Array | Float64Array;

export class Memory {
  private constructor(
    readonly call: Exports,
    private readonly memory: WebAssembly.Memory,
  ) {}

  static async load(wasm: BufferSource | WebAssembly.Module): Promise<Memory> {
    // Whatever the C library might ask of a system: there is none.
    const none = () => NO_SYSTEM;
    const module = wasm instanceof WebAssembly.Module ? wasm : await WebAssembly.compile(wasm);
    const imports: Record<string, Record<string, () => number>> = {};
    for (const { module: from, name, kind } of WebAssembly.Module.imports(module)) {
      if (kind === "function") (imports[from] ??= {})[name] = none;
    }
    const instance = await WebAssembly.instantiate(module, imports);
    const { memory, ...functions } = instance.exports;
    const loaded = new Memory(functions as unknown as Exports, memory as WebAssembly.Memory);
    (functions._initialize as (() => void) | undefined)?.();
    SIZES.forEach((bytes, i) => {
      if (loaded.call.pierce_size(i) !== bytes)
        throw new Error("pierce.wasm is of another version than this package: build both anew");
    });
    return loaded;
  }

  /** Runs f with an allocator whose blocks are freed when f is done. */
  within<T>(f: (room: Room) => T): T {
    const room = new Room(this);
    try {
      return f(room);
    } finally {
      room.free();
    }
  }

  get buffer(): ArrayBuffer {
    return this.memory.buffer as ArrayBuffer;
  }

  text(at: number): string {
    const bytes = new Uint8Array(this.buffer, at);
    return new TextDecoder().decode(bytes.slice(0, bytes.indexOf(0)));
  }
}

/** Blocks of the module's memory for the time of one call. */
export class Room {
  private readonly blocks: number[] = [];
  constructor(private readonly memory: Memory) {}

  /** Bytes that mean nothing yet. */
  space(count: number): number {
    const at = this.memory.call.malloc(Math.max(count, 1)) >>> 0;
    if (at === 0) throw new PierceError("OutOfMemory", "not enough memory", -1, 1);
    this.blocks.push(at);
    return at;
  }

  /** Bytes that are zero. */
  bytes(count: number): number {
    const at = this.space(count);
    new Uint8Array(this.memory.buffer, at, count).fill(0);
    return at;
  }

  /** A copy of an array. */
  copy(from: Floats | Uint32Array): number {
    const at = this.space(from.byteLength);
    const bytes = new Uint8Array(from.buffer, from.byteOffset, from.byteLength);
    new Uint8Array(this.memory.buffer, at, from.byteLength).set(bytes);
    return at;
  }

  words(...values: number[]): number {
    return this.copy(Uint32Array.from(values));
  }

  /** Calls a function whose last argument is a pierce_error, and throws what it says. */
  checked(name: string, ...args: number[]): void {
    const error = this.bytes(ERROR_BYTES);
    if (this.memory.call[name](...args, error) !== 0) this.refused(error);
  }

  /** The same for one that returns memory, or null. */
  made(name: string, ...args: number[]): number {
    const error = this.bytes(ERROR_BYTES);
    const at = this.memory.call[name](...args, error) >>> 0;
    if (at === 0) this.refused(error);
    this.blocks.push(at);
    return at;
  }

  private refused(error: number): never {
    const view = new DataView(this.memory.buffer, error);
    const code = view.getInt32(0, true);
    if (code === 0) throw new PierceError("OutOfMemory", "not enough memory", -1, 1);
    const index = view.getBigUint64(8, true);
    throw new PierceError(
      this.memory.text(this.memory.call.pierce_code_name(code) >>> 0),
      this.memory.text(error + 24),
      index === 0xffffffffffffffffn ? -1 : Number(index),
      Number(view.getBigUint64(16, true)),
    );
  }

  free(): void {
    for (const at of this.blocks) this.memory.call.free(at);
  }
}
