// SPDX-License-Identifier: Apache-2.0
#include "pierce/options.h"

namespace pierce {

Statistics& Statistics::operator+=(const Statistics& other) {
  rays += other.rays;
  nodes += other.nodes;
  leaves += other.leaves;
  candidates += other.candidates;
  certified += other.certified;
  settled += other.settled;
  settled_big += other.settled_big;
  orders_certified += other.orders_certified;
  orders_settled += other.orders_settled;
  hits += other.hits;
  rounded_exactly += other.rounded_exactly;
  rays_placed_exactly += other.rays_placed_exactly;
  return *this;
}

}  // namespace pierce
