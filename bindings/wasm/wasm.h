// SPDX-License-Identifier: Apache-2.0
//
// What the module exports beside pierce/pierce_c.h: functions that need no callback, and the
// textbook's methods.
#pragma once

#include "pierce/pierce_c.h"

#ifdef __cplusplus
extern "C" {
#endif

// The size of a struct, by its place in package/src/memory.ts: error, query options, point options.
// The package refuses to run if a size is not what it was written for.
uint32_t pierce_size(uint32_t which);

// Every hit of every ray, in one piece of memory: offsets (as many as rays, and one more, of 32
// bits), then, at the next multiple of 8, the hits. To be freed; NULL if that fails (see error).
void* pierce_gather_f32(const pierce_scene_f32* scene, const pierce_ray_f32* rays, size_t count,
                        const pierce_query_options* options, pierce_error* error);
void* pierce_gather_f64(const pierce_scene_f64* scene, const pierce_ray_f64* rays, size_t count,
                        const pierce_query_options* options, pierce_error* error);

// The name of a method, by number; NULL beyond the last.
const char* pierce_method_name(uint32_t method);
// Each ray against its own triangle (nine numbers). `method` UINT32_MAX: exactly. answers: four
// numbers each: 1 for a hit or 0, and t, u, v. Returns 0, or 1 if there is no such method.
int pierce_textbook_f32(uint32_t method, const pierce_ray_f32* rays, const float* triangles,
                        size_t count, float* answers);
int pierce_textbook_f64(uint32_t method, const pierce_ray_f64* rays, const double* triangles,
                        size_t count, double* answers);

#ifdef __cplusplus
}
#endif
