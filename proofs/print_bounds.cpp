// SPDX-License-Identifier: Apache-2.0
//
// Prints the constants of predicate/bounds.h as Gappa reads them, name = m b e; (m 2^e, exact): the
// proofs take them from here, so that proof and header cannot disagree.
#include <cmath>
#include <cstdio>

#include "predicate/bounds.h"

namespace {

void print(const char* name, double value) {
  int exponent = 0;
  const double significand = std::frexp(value, &exponent);
  std::printf("%s = %lldb%d;\n", name, static_cast<long long>(std::ldexp(significand, 53)),
              exponent - 53);
}

}  // namespace

#define PIERCE_PRINT(name) print(#name, static_cast<double>(pierce::bounds::name))

int main() {
  PIERCE_PRINT(kKeptOrigin);
  PIERCE_PRINT(kNearOrigin);
  PIERCE_PRINT(kFarthestOrigin);
  PIERCE_PRINT(kTauLimit);
  PIERCE_PRINT(kTauPad);
  PIERCE_PRINT(kTauFloorKept);
  PIERCE_PRINT(kTauFloorMoved);
  PIERCE_PRINT(kMoveError);
  PIERCE_PRINT(kSmallestReach);
  PIERCE_PRINT(kBoxPlane);
  PIERCE_PRINT(kBoxOrigin);
  PIERCE_PRINT(kBoxFloor);
  PIERCE_PRINT(kBoxCopy);
  PIERCE_PRINT(kSmallestSlope);
  PIERCE_PRINT(kCutSlack);
  PIERCE_PRINT(kPointPad);
  PIERCE_PRINT(kEdgeLinear);
  PIERCE_PRINT(kEdgeSquare);
  PIERCE_PRINT(kEdgeFloor);
  PIERCE_PRINT(kSumFactor);
  PIERCE_PRINT(kTauReach);
  PIERCE_PRINT(kTauInput);
  PIERCE_PRINT(kTauCube);
  PIERCE_PRINT(kTauSquare);
  PIERCE_PRINT(kTauFloor);
  PIERCE_PRINT(kBlurEdge);
  PIERCE_PRINT(kBlurSquare);
  PIERCE_PRINT(kBlurTau);
  PIERCE_PRINT(kLargestBlur);
  PIERCE_PRINT(kLocalRound);
  PIERCE_PRINT(kAxisSquare);
  PIERCE_PRINT(kAxisInput);
  PIERCE_PRINT(kAxisMore);
  PIERCE_PRINT(kAxisFloor);
  PIERCE_PRINT(kNearestLow);
  PIERCE_PRINT(kNearestHigh);
  PIERCE_PRINT(kNearestRoom);
  PIERCE_PRINT(kNearestShortest);
  PIERCE_PRINT(kNearestPlainCopy);
  PIERCE_PRINT(kNearestPlainReach);
  PIERCE_PRINT(kNearestFarthest);
  PIERCE_PRINT(kNearestFar);
  PIERCE_PRINT(kSideFactor);
  PIERCE_PRINT(kSideFloor);
  PIERCE_PRINT(kDenFactor);
  PIERCE_PRINT(kUvFactor);
  PIERCE_PRINT(kTFactor);
  PIERCE_PRINT(kWFactor);
  PIERCE_PRINT(kRangeFactor);
  PIERCE_PRINT(kRangeFloor);
  PIERCE_PRINT(kIntervalFactor);
  PIERCE_PRINT(kAlongAxis);
  PIERCE_PRINT(kLostAlongAxis);
  PIERCE_PRINT(kTermwise);
  PIERCE_PRINT(kSmallestComponent);
  PIERCE_PRINT(kAlongAxisWeights);
  PIERCE_PRINT(kQuotientClear);
  PIERCE_PRINT(kQuotientRoom);
  PIERCE_PRINT(kQuotientFactor);
  PIERCE_PRINT(kDoubleDoubleFactor);
  PIERCE_PRINT(kFiner);
  PIERCE_PRINT(kFineQuotientFactor);
  PIERCE_PRINT(kFineEnds);
}
