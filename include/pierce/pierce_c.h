// SPDX-License-Identifier: Apache-2.0
//
// pierce for C, and for every language that can call C: the library pierce_c. What the answers mean
// is in docs/guarantees.md; this page says how to ask.
//
// Names end in _f32 for scenes of floats and in _f64 for scenes of doubles; both do the same. Every
// struct of options may be all zeros, and every pointer to one NULL: that is the default. Functions
// return a code; what went wrong stands, with the first offender and the cure, in the pierce_error
// that is given last (NULL: not wanted). No exception leaves the library, none may enter it.
//
// A scene may be asked by any number of threads at a time; nobody may ask while it is refitted.
// Before 1.0 a minor version may change this interface, a patch may not.
#pragma once

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/* Stands for "no triangle" and "no geometry"; a hit whose triangle it is, is a miss. */
enum { PIERCE_NONE = -1 };  // as uint32_t: 0xffffffff

/* Codes. Those below 100 are ErrorCode of pierce/error.h, in its order. */
typedef enum pierce_code {
  PIERCE_OK = 0,
  PIERCE_NON_FINITE_VERTEX = 1,
  PIERCE_INDEX_OUT_OF_RANGE = 2,
  PIERCE_TOO_MANY_TRIANGLES = 3,
  PIERCE_INVALID_RAY = 4,
  PIERCE_INVALID_POINT = 5,
  PIERCE_SIZE_MISMATCH = 6,
  PIERCE_INVALID_ARGUMENT = 7,
  PIERCE_NOT_CLOSED = 8,
  PIERCE_UNKNOWN_KERNEL = 9,
  PIERCE_STOPPED = 10,
  PIERCE_BAD_FILE = 11,
  PIERCE_OUT_OF_MEMORY = 100,
  PIERCE_UNEXPECTED = 101  // of the C++ library below; the message is its own
} pierce_code;

/* index: by which number the message names the first offender (of a ray in its batch, a triangle in
   its mesh), UINT64_MAX if by none. count: how many offenders there are. message: one line, cut
   where it is longer, ends with 0. All is set by every call that fails, and by no other. */
typedef struct pierce_error {
  pierce_code code;
  uint64_t index, count;
  char message[1000];
} pierce_error;

/* "InvalidRay" and so on; "Unknown" for a number that is no code. Never NULL. */
const char* pierce_code_name(pierce_code code);
/* "0.1.0": of the library that runs; never NULL. */
const char* pierce_version(void);

/* A mesh in the caller's arrays: three numbers a vertex, three indices a triangle. */
typedef struct pierce_mesh_f32 {
  const float* vertices;
  size_t vertex_count;
  const uint32_t* triangles;
  size_t triangle_count;
} pierce_mesh_f32;
typedef struct pierce_mesh_f64 {
  const double* vertices;
  size_t vertex_count;
  const uint32_t* triangles;
  size_t triangle_count;
} pierce_mesh_f64;

/* The points origin + t direction with t_min <= t <= t_max. The direction is not zero, and need not
   have unit length; the ends may be infinite. t_max is not infinity by itself: set it. */
typedef struct pierce_ray_f32 {
  float origin[3], direction[3], t_min, t_max;
} pierce_ray_f32;
typedef struct pierce_ray_f64 {
  double origin[3], direction[3], t_min, t_max;
} pierce_ray_f64;

/* The point hit is w a + u b + v c; each number is the exact one rounded once. facing: 0 front (the
   corners run counter-clockwise as seen from the origin), 1 back. A miss: t infinite, u, v, w 0,
   geometry and triangle 0xffffffff. */
typedef struct pierce_hit_f32 {
  float t, u, v, w;
  uint32_t geometry, triangle;
  uint8_t facing;
} pierce_hit_f32;
typedef struct pierce_hit_f64 {
  double t, u, v, w;
  uint32_t geometry, triangle;
  uint8_t facing;
} pierce_hit_f64;

typedef struct pierce_triangle_ref {
  uint32_t geometry, triangle;
} pierce_triangle_ref;

/* Passages through the surface; signed: leaving counts +1, entering -1. */
typedef struct pierce_crossings {
  uint32_t count;
  int32_t signed_count;
  uint8_t origin_on_surface;
} pierce_crossings;

/* feature: 0, 1, 2 the corner a, b, c; 3, 4, 5 the inside of the edge ab, bc, ca; 6 of the face.
   triangle 0xffffffff: there is none. */
typedef struct pierce_nearest_f32 {
  float point[3], distance, u, v, w;
  uint32_t geometry, triangle;
  uint8_t feature;
} pierce_nearest_f32;
typedef struct pierce_nearest_f64 {
  double point[3], distance, u, v, w;
  uint32_t geometry, triangle;
  uint8_t feature;
} pierce_nearest_f64;

/* What batches of rays and points took; see Statistics in pierce/options.h. Calls add to it. */
typedef struct pierce_statistics {
  uint64_t rays, nodes, leaves, candidates, certified, settled, settled_big, orders_certified,
      orders_settled, hits, rounded_exactly, rays_placed_exactly;
} pierce_statistics;

typedef struct pierce_scene_info {
  uint64_t triangles, vertices, degenerate, nodes, leaves;
  double sah_cost;
  uint64_t bytes;
} pierce_scene_info;

/* How a call works, whatever it is asked. threads: 0, as many as the machine has. progress is
   called now and then, from one thread at a time, with a number from 0 to 1: what it returns is 0
   to go on; else the call ends with PIERCE_STOPPED and what it was to fill is unspecified (unless
   it has come to its end by then: PIERCE_OK says that all is there). */
typedef struct pierce_work {
  uint32_t threads;
  int (*progress)(void* user, double fraction);
  void* progress_user;
  pierce_statistics* statistics;  // not for builds
} pierce_work;

enum { PIERCE_BALANCED = 0, PIERCE_FAST = 1, PIERCE_HIGH = 2, PIERCE_COMPACT = 3 };  // quality

/* view_meshes 0: the scene copies the meshes' arrays. 1: it looks at them where they are, and they
   must outlive it unchanged. masks: NULL or one a mesh. */
typedef struct pierce_build_options {
  uint32_t quality;
  uint32_t view_meshes;
  const uint32_t* masks;
  pierce_work work;
} pierce_build_options;

enum { PIERCE_BOTH_SIDES = 0, PIERCE_FRONT = 1, PIERCE_BACK = 2 };  // sides

/* See BatchOptions in pierce/options.h. open_start: a hit exactly at t_min does not count. mask:
   NULL or one for all rays; masks, skip, after: NULL or one a ray. max_hits: of all_hits, 0 for no
   limit. distinct: of hits at one t the first. invalid_miss: a ray that is not valid is a miss, not
   an error. filter: asked whether a hit counts (not 0), from several threads at a time. */
typedef struct pierce_query_options {
  uint32_t open_start, sides, distinct, invalid_miss;
  const uint32_t* mask;
  const uint32_t* masks;
  const pierce_triangle_ref* skip;
  const pierce_triangle_ref* after;
  uint64_t max_hits;
  int (*filter)(void* user, uint64_t ray, const pierce_hit_f64* hit);
  void* filter_user;
  pierce_work work;
} pierce_query_options;

/* For points. non_zero: inside is where the surface winds around the point; else where a ray from
   it crosses the surface an odd number of times. open_mesh: do not ask whether the surface is
   closed. */
typedef struct pierce_point_options {
  uint32_t non_zero, open_mesh;
  pierce_work work;
} pierce_point_options;

typedef struct pierce_scene_f32 pierce_scene_f32;
typedef struct pierce_scene_f64 pierce_scene_f64;

/* Makes a scene of meshes (geometry i is meshes[i]; none is welcome) and puts it into *scene, which
   is NULL if that fails. pierce_free it; NULL is welcome there. */
pierce_code pierce_build_f32(const pierce_mesh_f32* meshes, size_t count,
                             const pierce_build_options* options, pierce_scene_f32** scene,
                             pierce_error* error);
pierce_code pierce_build_f64(const pierce_mesh_f64* meshes, size_t count,
                             const pierce_build_options* options, pierce_scene_f64** scene,
                             pierce_error* error);
void pierce_free_f32(pierce_scene_f32* scene);
void pierce_free_f64(pierce_scene_f64* scene);

/* Takes in other vertices (as many meshes, with as many triangles each), copied or viewed as when
   it was built: answers as of a new scene, in a third of the time or less. */
pierce_code pierce_refit_f32(pierce_scene_f32* scene, const pierce_mesh_f32* meshes, size_t count,
                             const pierce_work* work, pierce_error* error);
pierce_code pierce_refit_f64(pierce_scene_f64* scene, const pierce_mesh_f64* meshes, size_t count,
                             const pierce_work* work, pierce_error* error);

pierce_code pierce_info_f32(const pierce_scene_f32* scene, pierce_scene_info* info,
                            pierce_error* error);
pierce_code pierce_info_f64(const pierce_scene_f64* scene, pierce_scene_info* info,
                            pierce_error* error);

/* The first hit of each ray by (exact t, geometry, triangle). One answer a ray, in their order; so
   it is with all that follow. */
pierce_code pierce_closest_hits_f32(const pierce_scene_f32* scene, const pierce_ray_f32* rays,
                                    size_t count, const pierce_query_options* options,
                                    pierce_hit_f32* hits, pierce_error* error);
pierce_code pierce_closest_hits_f64(const pierce_scene_f64* scene, const pierce_ray_f64* rays,
                                    size_t count, const pierce_query_options* options,
                                    pierce_hit_f64* hits, pierce_error* error);

/* 1 where a ray hits anything, else 0. */
pierce_code pierce_any_hits_f32(const pierce_scene_f32* scene, const pierce_ray_f32* rays,
                                size_t count, const pierce_query_options* options, uint8_t* any,
                                pierce_error* error);
pierce_code pierce_any_hits_f64(const pierce_scene_f64* scene, const pierce_ray_f64* rays,
                                size_t count, const pierce_query_options* options, uint8_t* any,
                                pierce_error* error);

/* How many hits each ray has. */
pierce_code pierce_count_hits_f32(const pierce_scene_f32* scene, const pierce_ray_f32* rays,
                                  size_t count, const pierce_query_options* options,
                                  uint32_t* counts, pierce_error* error);
pierce_code pierce_count_hits_f64(const pierce_scene_f64* scene, const pierce_ray_f64* rays,
                                  size_t count, const pierce_query_options* options,
                                  uint32_t* counts, pierce_error* error);

/* Every hit, in order, in pieces: consume is handed the lists of the rays first ... first + count -
   1 (at most 1,024), those of ray first + i being hits[offsets[i]] ... hits[offsets[i + 1] - 1].
   Called from the calling thread, in the order of the rays; the arrays are good until it returns.
   What it returns is 0 to go on; else the call ends with PIERCE_STOPPED. */
typedef int (*pierce_consume_f32)(void* user, uint64_t first, size_t count, const uint64_t* offsets,
                                  const pierce_hit_f32* hits);
typedef int (*pierce_consume_f64)(void* user, uint64_t first, size_t count, const uint64_t* offsets,
                                  const pierce_hit_f64* hits);
pierce_code pierce_all_hits_f32(const pierce_scene_f32* scene, const pierce_ray_f32* rays,
                                size_t count, const pierce_query_options* options,
                                pierce_consume_f32 consume, void* user, pierce_error* error);
pierce_code pierce_all_hits_f64(const pierce_scene_f64* scene, const pierce_ray_f64* rays,
                                size_t count, const pierce_query_options* options,
                                pierce_consume_f64 consume, void* user, pierce_error* error);

/* How often each ray passes through the surface. */
pierce_code pierce_crossings_f32(const pierce_scene_f32* scene, const pierce_ray_f32* rays,
                                 size_t count, const pierce_query_options* options,
                                 pierce_crossings* crossings, pierce_error* error);
pierce_code pierce_crossings_f64(const pierce_scene_f64* scene, const pierce_ray_f64* rays,
                                 size_t count, const pierce_query_options* options,
                                 pierce_crossings* crossings, pierce_error* error);

/* Where each point lies (three numbers a point): -1 outside, 0 exactly on the surface, 1 inside. */
pierce_code pierce_locate_f32(const pierce_scene_f32* scene, const float* points, size_t count,
                              const pierce_point_options* options, int8_t* locations,
                              pierce_error* error);
pierce_code pierce_locate_f64(const pierce_scene_f64* scene, const double* points, size_t count,
                              const pierce_point_options* options, int8_t* locations,
                              pierce_error* error);

/* The point of the surface nearest to each point, no farther away than radius (INFINITY). */
pierce_code pierce_nearest_points_f32(const pierce_scene_f32* scene, const float* points,
                                      size_t count, float radius, const pierce_work* work,
                                      pierce_nearest_f32* nearest, pierce_error* error);
pierce_code pierce_nearest_points_f64(const pierce_scene_f64* scene, const double* points,
                                      size_t count, double radius, const pierce_work* work,
                                      pierce_nearest_f64* nearest, pierce_error* error);

/* The distance to the surface, negative inside. */
pierce_code pierce_signed_distances_f32(const pierce_scene_f32* scene, const float* points,
                                        size_t count, const pierce_point_options* options,
                                        float* distances, pierce_error* error);
pierce_code pierce_signed_distances_f64(const pierce_scene_f64* scene, const double* points,
                                        size_t count, const pierce_point_options* options,
                                        double* distances, pierce_error* error);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
