// SPDX-License-Identifier: Apache-2.0
//
// Every function of pierce/pierce_c.h, from C: exact answers on a tetrahedron, options, callbacks,
// and what is refused. Exit status 0 if all is as it should be; one line for each thing that is not.
#include <math.h>
#include <pierce/pierce_c.h>
#include <stdio.h>
#include <string.h>

static int wrong = 0;

#define EXPECT(condition)                                                   \
  do {                                                                      \
    if (!(condition)) {                                                     \
      printf("%s:%d: not so: %s\n", __FILE__, __LINE__, #condition);        \
      ++wrong;                                                              \
    }                                                                       \
  } while (0)

// x, y, z >= 0, x + y + z <= 4; triangles 0, 1, 2 lie in z = 0, y = 0, x = 0, and 3 faces away.
static const float kVertices_f32[] = {0, 0, 0, 4, 0, 0, 0, 4, 0, 0, 0, 4};
static const double kVertices_f64[] = {0, 0, 0, 4, 0, 0, 0, 4, 0, 0, 0, 4};
static const uint32_t kTriangles[] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};

typedef struct Seen {
  size_t calls, hits, rays;
  uint32_t triangles[8];
} Seen;

static int count_progress(void* user, double fraction) {
  EXPECT(fraction >= 0 && fraction <= 1);
  ++((Seen*)user)->calls;
  return 0;
}
static int stop_at_once(void* user, double fraction) {
  (void)fraction;
  ++((Seen*)user)->calls;
  return 1;
}
static int only_back(void* user, uint64_t ray, const pierce_hit_f64* hit) {
  Seen* seen = user;
  ++seen->calls;
  EXPECT(ray < 2 && hit->triangle < 4);
  return hit->facing == 1;
}
static int refuse_lists_f32(void* user, uint64_t first, size_t count, const uint64_t* offsets,
                            const pierce_hit_f32* hits) {
  (void)user, (void)first, (void)count, (void)offsets, (void)hits;
  return 1;
}
static int refuse_lists_f64(void* user, uint64_t first, size_t count, const uint64_t* offsets,
                            const pierce_hit_f64* hits) {
  (void)user, (void)first, (void)count, (void)offsets, (void)hits;
  return 1;
}

#define TESTS(kind, Real)                                                                         \
  static int gather_##kind(void* user, uint64_t first, size_t count, const uint64_t* offsets,     \
                           const pierce_hit_##kind* hits) {                                       \
    Seen* seen = user;                                                                            \
    EXPECT(first == seen->rays);                                                                  \
    seen->rays += count;                                                                          \
    for (uint64_t i = 0; i < offsets[count]; ++i) seen->triangles[seen->hits++] = hits[i].triangle; \
    return 0;                                                                                     \
  }                                                                                               \
                                                                                                  \
  static void ask_rays_##kind(const pierce_scene_##kind* scene) {                                 \
    pierce_error error;                                                                           \
    /* through two faces; through a vertex and along an edge to another; beside it all */         \
    const pierce_ray_##kind rays[3] = {{{1, 1, -1}, {0, 0, 1}, 0, INFINITY},                      \
                                       {{0, 0, -1}, {0, 0, 1}, 0, INFINITY},                      \
                                       {{9, 9, 9}, {1, 0, 0}, -INFINITY, INFINITY}};              \
    pierce_hit_##kind hits[3];                                                                    \
    EXPECT(pierce_closest_hits_##kind(scene, rays, 3, NULL, hits, &error) == PIERCE_OK);          \
    EXPECT(hits[0].t == 1 && hits[0].u == 0.25 && hits[0].v == 0.25 && hits[0].w == 0.5);         \
    EXPECT(hits[0].geometry == 0 && hits[0].triangle == 0 && hits[0].facing == 0);                \
    EXPECT(hits[1].t == 1 && hits[1].u == 0 && hits[1].v == 0 && hits[1].w == 1);                 \
    EXPECT(isinf(hits[2].t) && hits[2].triangle == (uint32_t)PIERCE_NONE);                        \
                                                                                                  \
    uint8_t any[3] = {9, 9, 9};                                                                   \
    EXPECT(pierce_any_hits_##kind(scene, rays, 3, NULL, any, NULL) == PIERCE_OK);                 \
    EXPECT(any[0] == 1 && any[1] == 1 && any[2] == 0);                                            \
    uint32_t counts[3] = {9, 9, 9};                                                               \
    EXPECT(pierce_count_hits_##kind(scene, rays, 3, NULL, counts, NULL) == PIERCE_OK);            \
    EXPECT(counts[0] == 2 && counts[1] == 2 && counts[2] == 0);                                   \
    pierce_crossings crossings[3];                                                                \
    EXPECT(pierce_crossings_##kind(scene, rays, 3, NULL, crossings, NULL) == PIERCE_OK);          \
    EXPECT(crossings[1].count == 2 && crossings[1].signed_count == 0);                            \
    EXPECT(crossings[2].count == 0 && crossings[2].origin_on_surface == 0);                       \
                                                                                                  \
    Seen seen = {0};                                                                              \
    EXPECT(pierce_all_hits_##kind(scene, rays, 3, NULL, gather_##kind, &seen, NULL) == PIERCE_OK); \
    EXPECT(seen.rays == 3 && seen.hits == 4);                                                     \
    EXPECT(seen.triangles[0] == 0 && seen.triangles[1] == 3 && seen.triangles[3] == 3);           \
    EXPECT(pierce_all_hits_##kind(scene, rays, 3, NULL, refuse_lists_##kind, NULL, &error) ==     \
           PIERCE_STOPPED);                                                                       \
    EXPECT(pierce_all_hits_##kind(scene, rays, 3, NULL, NULL, NULL, &error) ==                    \
           PIERCE_INVALID_ARGUMENT);                                                              \
                                                                                                  \
    /* options: each alone, and a filter with its user data */                                    \
    pierce_query_options back = {.sides = PIERCE_BACK};                                           \
    EXPECT(pierce_closest_hits_##kind(scene, rays, 1, &back, hits, NULL) == PIERCE_OK);           \
    EXPECT(hits[0].triangle == 3 && hits[0].t == 3 && hits[0].facing == 1);                       \
    const pierce_triangle_ref first = {0, 0};                                                     \
    pierce_query_options skip = {.skip = &first}, after = {.after = &first};                      \
    EXPECT(pierce_closest_hits_##kind(scene, rays, 1, &skip, hits, NULL) == PIERCE_OK);           \
    EXPECT(hits[0].triangle == 3);                                                                \
    EXPECT(pierce_count_hits_##kind(scene, rays, 1, &after, counts, NULL) == PIERCE_OK);          \
    EXPECT(counts[0] == 1);                                                                       \
    const uint32_t no_bits = 0;                                                                   \
    pierce_query_options blind = {.mask = &no_bits};                                              \
    EXPECT(pierce_any_hits_##kind(scene, rays, 1, &blind, any, NULL) == PIERCE_OK);               \
    EXPECT(any[0] == 0);                                                                          \
    pierce_query_options one = {.max_hits = 1};                                                   \
    memset(&seen, 0, sizeof seen);                                                                \
    EXPECT(pierce_all_hits_##kind(scene, rays, 2, &one, gather_##kind, &seen, NULL) == PIERCE_OK); \
    EXPECT(seen.hits == 2);                                                                       \
    memset(&seen, 0, sizeof seen);                                                                \
    pierce_statistics statistics = {0};                                                           \
    pierce_query_options filtered = {.filter = only_back, .filter_user = &seen,                   \
                                     .work = {.threads = 1, .statistics = &statistics}};          \
    EXPECT(pierce_closest_hits_##kind(scene, rays, 2, &filtered, hits, NULL) == PIERCE_OK);       \
    EXPECT(hits[0].triangle == 3 && hits[1].triangle == 3 && hits[1].t == 5 && seen.calls == 4);  \
    EXPECT(statistics.rays == 2);                                                                 \
                                                                                                  \
    /* a ray that is none: which one, how many, and what it is called */                          \
    pierce_ray_##kind bad[3] = {rays[0], rays[0], rays[0]};                                       \
    bad[1].direction[2] = 0;                                                                      \
    bad[2].origin[0] = NAN;                                                                       \
    EXPECT(pierce_closest_hits_##kind(scene, bad, 3, NULL, hits, &error) == PIERCE_INVALID_RAY);  \
    EXPECT(error.code == PIERCE_INVALID_RAY && error.index == 1 && error.count == 2);             \
    EXPECT(strstr(error.message, "ray") != NULL);                                                 \
    pierce_query_options lenient = {.invalid_miss = 1};                                           \
    EXPECT(pierce_closest_hits_##kind(scene, bad, 3, &lenient, hits, NULL) == PIERCE_OK);         \
    EXPECT(hits[0].triangle == 0 && hits[1].triangle == (uint32_t)PIERCE_NONE);                   \
    pierce_query_options no_such_side = {.sides = 3};                                             \
    EXPECT(pierce_closest_hits_##kind(scene, rays, 1, &no_such_side, hits, &error) ==             \
           PIERCE_INVALID_ARGUMENT);                                                              \
    EXPECT(strcmp(error.message, "sides is 3: give 0 to 2") == 0);                                \
    EXPECT(pierce_closest_hits_##kind(scene, NULL, 1, NULL, hits, &error) ==                      \
           PIERCE_INVALID_ARGUMENT);                                                              \
    EXPECT(pierce_closest_hits_##kind(NULL, rays, 1, NULL, hits, &error) ==                       \
           PIERCE_INVALID_ARGUMENT);                                                              \
    EXPECT(pierce_closest_hits_##kind(scene, NULL, 0, NULL, NULL, &error) == PIERCE_OK);          \
  }                                                                                               \
                                                                                                  \
  static void ask_points_##kind(const pierce_scene_##kind* scene) {                               \
    const Real points[] = {1, 1, 1, -1, 1, 1, 0, 1, 1};                                           \
    int8_t locations[3];                                                                          \
    EXPECT(pierce_locate_##kind(scene, points, 3, NULL, locations, NULL) == PIERCE_OK);           \
    EXPECT(locations[0] == 1 && locations[1] == -1 && locations[2] == 0);                         \
    Real distances[3];                                                                            \
    EXPECT(pierce_signed_distances_##kind(scene, points, 3, NULL, distances, NULL) == PIERCE_OK); \
    EXPECT(distances[0] == -(Real)0x1.279a74590331cp-1 && distances[1] == 1 && distances[2] == 0); \
    pierce_nearest_##kind nearest[3];                                                             \
    EXPECT(pierce_nearest_points_##kind(scene, points, 3, 1, NULL, nearest, NULL) == PIERCE_OK);  \
    EXPECT(nearest[1].distance == 1 && nearest[1].triangle == 2 && nearest[1].feature == 6);      \
    EXPECT(nearest[1].point[0] == 0 && nearest[1].point[1] == 1 && nearest[1].point[2] == 1);     \
    EXPECT(nearest[1].u == 0.25 && nearest[1].v == 0.25 && nearest[1].w == 0.5);                  \
    EXPECT(pierce_nearest_points_##kind(scene, points, 2, 0.5f, NULL, nearest, NULL) == PIERCE_OK); \
    EXPECT(nearest[1].triangle == (uint32_t)PIERCE_NONE);                                         \
    pierce_error error;                                                                           \
    EXPECT(pierce_nearest_points_##kind(scene, points, 1, -1, NULL, nearest, &error) ==           \
           PIERCE_INVALID_ARGUMENT);                                                              \
  }                                                                                               \
                                                                                                  \
  static void build_and_ask_##kind(void) {                                                        \
    pierce_error error;                                                                           \
    pierce_scene_##kind* scene = NULL;                                                            \
    Real vertices[12];                                                                            \
    memcpy(vertices, kVertices_##kind, sizeof vertices);                                          \
    pierce_mesh_##kind mesh = {vertices, 4, kTriangles, 4};                                       \
    Seen seen = {0};                                                                              \
    pierce_build_options options = {.quality = PIERCE_HIGH,                                       \
                                    .work = {.progress = count_progress, .progress_user = &seen}}; \
    EXPECT(pierce_build_##kind(&mesh, 1, &options, &scene, &error) == PIERCE_OK && seen.calls > 0); \
    memset(vertices, 0, sizeof vertices); /* a copy was made */                                   \
    ask_rays_##kind(scene);                                                                       \
    ask_points_##kind(scene);                                                                     \
    pierce_scene_info info;                                                                       \
    EXPECT(pierce_info_##kind(scene, &info, NULL) == PIERCE_OK);                                  \
    EXPECT(info.triangles == 4 && info.vertices == 4 && info.degenerate == 0 && info.bytes > 0);  \
                                                                                                  \
    /* twice as large */                                                                          \
    for (int i = 0; i < 12; ++i) vertices[i] = 2 * kVertices_##kind[i];                           \
    EXPECT(pierce_refit_##kind(scene, &mesh, 1, NULL, &error) == PIERCE_OK);                      \
    const pierce_ray_##kind ray = {{1, 1, -1}, {0, 0, 1}, 2, INFINITY};                           \
    pierce_hit_##kind hit;                                                                        \
    EXPECT(pierce_closest_hits_##kind(scene, &ray, 1, NULL, &hit, NULL) == PIERCE_OK);            \
    EXPECT(hit.t == 7 && hit.triangle == 3);                                                      \
    EXPECT(pierce_refit_##kind(scene, &mesh, 0, NULL, &error) == PIERCE_SIZE_MISMATCH);           \
    pierce_free_##kind(scene);                                                                    \
    pierce_free_##kind(NULL);                                                                     \
                                                                                                  \
    /* open, viewed in place, two at a time, none at all */                                       \
    pierce_mesh_##kind two[2] = {mesh, {vertices, 4, kTriangles, 1}};                             \
    pierce_build_options view = {.view_meshes = 1, .quality = PIERCE_COMPACT};                    \
    EXPECT(pierce_build_##kind(two, 2, &view, &scene, &error) == PIERCE_OK);                      \
    int8_t location;                                                                              \
    const Real point[3] = {1, 1, 1};                                                              \
    EXPECT(pierce_locate_##kind(scene, point, 1, NULL, &location, &error) == PIERCE_NOT_CLOSED);  \
    EXPECT(strcmp(pierce_code_name(error.code), "NotClosed") == 0);                               \
    pierce_point_options open = {.open_mesh = 1};                                                 \
    EXPECT(pierce_locate_##kind(scene, point, 1, &open, &location, NULL) == PIERCE_OK);           \
    EXPECT(location == 1);                                                                        \
    pierce_free_##kind(scene);                                                                    \
    EXPECT(pierce_build_##kind(NULL, 0, NULL, &scene, NULL) == PIERCE_OK && scene != NULL);       \
    pierce_free_##kind(scene);                                                                    \
                                                                                                  \
    /* what cannot be built leaves no scene */                                                    \
    const uint32_t beyond[3] = {0, 1, 4};                                                         \
    pierce_mesh_##kind broken = {vertices, 4, beyond, 1};                                         \
    EXPECT(pierce_build_##kind(&broken, 1, NULL, &scene, &error) == PIERCE_INDEX_OUT_OF_RANGE);   \
    EXPECT(scene == NULL && error.index == 0 && error.count == 1);                                \
    EXPECT(pierce_build_##kind(&mesh, 1, NULL, NULL, &error) == PIERCE_INVALID_ARGUMENT);         \
    options.work.progress = stop_at_once;                                                         \
    EXPECT(pierce_build_##kind(&mesh, 1, &options, &scene, &error) == PIERCE_STOPPED);            \
    EXPECT(scene == NULL);                                                                        \
    options.quality = 4;                                                                          \
    EXPECT(pierce_build_##kind(&mesh, 1, &options, &scene, &error) == PIERCE_INVALID_ARGUMENT);   \
  }

TESTS(f32, float)
TESTS(f64, double)

int main(void) {
  build_and_ask_f32();
  build_and_ask_f64();
  EXPECT(strcmp(pierce_version(), PIERCE_WANTED_VERSION) == 0);
  EXPECT(strcmp(pierce_code_name(PIERCE_OK), "Ok") == 0);
  EXPECT(strcmp(pierce_code_name((pierce_code)77), "Unknown") == 0);
  EXPECT(strcmp(pierce_code_name(PIERCE_OUT_OF_MEMORY), "OutOfMemory") == 0);
  printf(wrong == 0 ? "all as it should be\n" : "%d things are not as they should be\n", wrong);
  return wrong == 0 ? 0 : 1;
}
