// SPDX-License-Identifier: Apache-2.0
//
// The campaign draws from the tests' own numbers and meshes; only its oracles are its own.
#pragma once

#include "support/hard_numbers.h"

namespace pierce::campaign {

using hard::any_size;
using hard::finite;
using hard::in_cube;
using hard::nudged;
using hard::Rng;

}  // namespace pierce::campaign
