// SPDX-License-Identifier: Apache-2.0
//
// The error bounds of the float rung, by the names that the kernels use. They are set, proved and
// attacked where all bounds are: predicate/bounds.h.
#pragma once

#include "predicate/bounds.h"

namespace pierce::kernels {

using bounds::kBoxCopy;
using bounds::kBoxFloor;
using bounds::kBoxOrigin;
using bounds::kSmallestReach;
using bounds::kSmallestSlope;

using bounds::kBlurEdge;
using bounds::kBlurSquare;
using bounds::kBlurTau;

using bounds::kEdgeFloor;
using bounds::kEdgeLinear;
using bounds::kEdgeSquare;
using bounds::kSumFactor;

using bounds::kTauCube;
using bounds::kTauFloor;
using bounds::kTauFloorKept;
using bounds::kTauInput;
using bounds::kTauPad;
using bounds::kTauReach;
using bounds::kTauSquare;

}  // namespace pierce::kernels
