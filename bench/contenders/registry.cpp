// SPDX-License-Identifier: Apache-2.0
//
// The list of contenders of this build.
#include "contenders/families.h"
#include "pierce/error.h"
#include "workloads/names.h"

namespace pierce::bench {

const std::vector<ContenderKind>& contender_kinds() {
  static const std::vector<ContenderKind> kinds{
      {"pierce", "ray by ray", "pierce", true},
      {"pierce-batch", "batches", "pierce", true},
      {"pierce-batch-1", "batches of one ray", "pierce", false},
      {"pierce-batch-16", "batches of 16", "pierce", false},
      {"pierce-batch-256", "batches of 256", "pierce", false},
      {"pierce-batch-4096", "batches of 4,096", "pierce", false},
      {"pierce-batch-all", "batches on all threads of the machine", "pierce", true},
      {"pierce-double", "double scene, ray by ray", "pierce", true},
      {"pierce-double-batch", "double scene, batches", "pierce", true},
      {"pierce-fast", "Quality::Fast, ray by ray", "pierce", false},
      {"pierce-high", "Quality::High, ray by ray", "pierce", false},
      {"pierce-compact", "Quality::Compact, ray by ray", "pierce", false},
      {"pierce-compact-batch", "Quality::Compact, batches", "pierce", false},
#ifdef PIERCE_BENCH_EMBREE
      {"embree", "Embree's default scene, ray by ray", "embree", true},
      {"embree-robust", "Embree's robust scene, ray by ray", "embree", true},
      {"embree-16", "Embree's default scene, coherent packets of 16", "embree", true},
      {"embree-high", "Embree built with high quality, ray by ray", "embree", false},
      {"embree4", "Embree 4's default scene, ray by ray", "embree", has_embree4()},
      {"embree4-high", "Embree 4 built with high quality, ray by ray", "embree", false},
#endif
#ifdef PIERCE_BENCH_CGAL
      {"cgal", "CGAL's AABB tree, exact predicates, ray by ray (2^14 of the rays)", "cgal", true},
#endif
      {"textbook", "Moeller-Trumbore on every triangle (64 of the rays)", "textbook", false},
  };
  return kinds;
}

Field make_field(const std::vector<std::string>& names) {
  Field field;
  for (const std::string& name : names) {
    bool added = add_pierce(field, name) || add_textbook(field, name);
#ifdef PIERCE_BENCH_EMBREE
    added = added || add_embree(field, name) || add_embree4(field, name);
#endif
#ifdef PIERCE_BENCH_CGAL
    added = added || add_cgal(field, name);
#endif
    if (added) continue;
    throw Error(ErrorCode::InvalidArgument,
                "there is no contender '" + name +
                    "' in this build; there are: " + names_of(contender_kinds()));
  }
  return field;
}

}  // namespace pierce::bench
