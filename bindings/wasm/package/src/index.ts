// SPDX-License-Identifier: Apache-2.0
export { PierceError, type Floats } from "./memory.js";
export * from "./scene.js";
export { type Triangles, type Verdicts } from "./methods.js";
export { Rational } from "./rational.js";
export { type Numbers, type Vec, exact, float32, float64, vectors } from "./numbers.js";
export { type MethodName, type Step, type Trace, METHODS, trace } from "./textbook.js";
