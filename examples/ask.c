// SPDX-License-Identifier: Apache-2.0
//
// pierce from C: one ray through the edge that two triangles share, and one that is no ray.
// Build: cc ask.c $(pkg-config --cflags --libs pierce_c)
#include <math.h>
#include <pierce/pierce_c.h>
#include <stdio.h>

int main(void) {
  const float vertices[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
  const uint32_t triangles[] = {0, 1, 2, 0, 2, 3};
  const pierce_mesh_f32 mesh = {vertices, 4, triangles, 2};
  pierce_scene_f32* scene = NULL;
  pierce_error error;
  if (pierce_build_f32(&mesh, 1, NULL, &scene, &error) != PIERCE_OK) {
    fprintf(stderr, "%s\n", error.message);
    return 1;
  }

  pierce_ray_f32 rays[2] = {{{0.25f, 0.25f, 1}, {0, 0, -3}, 0, INFINITY},
                            {{0, 0, 1}, {0, 0, 0}, 0, INFINITY}};
  pierce_hit_f32 hits[2];
  if (pierce_closest_hits_f32(scene, rays, 1, NULL, hits, &error) == PIERCE_OK) {
    printf("triangle %u at t = %.9g, u = %g, v = %g\n", (unsigned)hits[0].triangle, hits[0].t,
           hits[0].u, hits[0].v);
  }
  if (pierce_closest_hits_f32(scene, rays, 2, NULL, hits, &error) != PIERCE_OK) {
    printf("ray %u is refused: %s\n", (unsigned)error.index, pierce_code_name(error.code));
  }
  pierce_free_f32(scene);
  return 0;
}
