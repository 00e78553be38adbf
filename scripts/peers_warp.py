# SPDX-License-Identifier: Apache-2.0
"""Warp's kernels for scripts/peers_engines.py: Warp reads their source."""

import warp as wp

FAR = wp.constant(1.0e30)


@wp.kernel
def closest(mesh: wp.uint64, o: wp.array(dtype=wp.vec3), d: wp.array(dtype=wp.vec3),
            result: wp.array(dtype=wp.int32)):
    i = wp.tid()
    query = wp.mesh_query_ray(mesh, o[i], d[i], FAR)
    if query.result:
        result[i] = query.face
    else:
        result[i] = -1


@wp.kernel
def any_hit(mesh: wp.uint64, o: wp.array(dtype=wp.vec3), d: wp.array(dtype=wp.vec3),
            result: wp.array(dtype=wp.bool)):
    i = wp.tid()
    result[i] = wp.mesh_query_ray_anyhit(mesh, o[i], d[i], FAR)


@wp.kernel
def nearest(mesh: wp.uint64, p: wp.array(dtype=wp.vec3), result: wp.array(dtype=wp.int32)):
    i = wp.tid()
    query = wp.mesh_query_point_no_sign(mesh, p[i], FAR)
    result[i] = query.face


@wp.kernel
def signed(mesh: wp.uint64, p: wp.array(dtype=wp.vec3), result: wp.array(dtype=wp.float32)):
    i = wp.tid()
    query = wp.mesh_query_point(mesh, p[i], FAR)
    there = wp.mesh_eval_position(mesh, query.face, query.u, query.v)
    result[i] = query.sign * wp.length(there - p[i])
