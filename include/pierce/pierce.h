// SPDX-License-Identifier: Apache-2.0
//
// Everything that answers questions about rays and meshes. The classic methods (textbook.h), the
// barycentric toolbox (barycentric.h) and the other shapes (shapes.h) are included one by one.
#pragma once

#include "pierce/arrays.h"
#include "pierce/closed.h"
#include "pierce/error.h"
#include "pierce/intersect.h"
#include "pierce/measure.h"
#include "pierce/mesh.h"
#include "pierce/nearest.h"
#include "pierce/options.h"
#include "pierce/scene.h"
#include "pierce/scene_file.h"
#include "pierce/transform.h"
#include "pierce/types.h"
#include "pierce/version.h"
#include "pierce/voxelise.h"
#include "pierce/winding.h"
