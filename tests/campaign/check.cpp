// SPDX-License-Identifier: Apache-2.0
#include "campaign/check.h"

#include <exception>

namespace pierce::campaign {
namespace {

template <class Real>
void check_case(const Case<Real>& made, Tally& tally) {
  const World world = world_of<Real>(made.meshes);
  Scenes<Real> scenes;
  for (const auto quality : made.qualities) scenes.emplace_back(made, quality);
  check_info(made, scenes, world, tally);
  check_rays(made, scenes, world, tally);
  check_steps(made, scenes, world, tally);
  check_starts(made, scenes, world, tally);
  check_nearest(made, scenes, world, tally);
  check_inside(made, scenes, world, tally);
}

}  // namespace

void check(const AnyCase& any, Tally& tally) {
  try {
    std::visit([&](const auto& made) { check_case(made, tally); }, any);
  } catch (const std::exception& error) {
    tally.fail(std::string("an exception that should not be: ") + error.what());
  }
}

}  // namespace pierce::campaign
