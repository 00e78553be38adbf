# SPDX-License-Identifier: Apache-2.0
"""The Python packages that scripts/python_peers.py compares, each behind the same few methods.

An engine is built from float32 vertices (n, 3) and int triangles (m, 3). Its methods are the tasks
that it can do; each returns arrays of answers: closest: triangles, -1 a miss; any: bools; all: rays
and triangles of all hits; inside: bools; nearest: triangles; signed: distances, negative inside.
What a package must be handed (another type or order of numbers) is made ready outside of the
measured time where a user would keep it so, in `prepare`.
"""

import numpy as np


class Pierce:
    distribution = "pierce"

    def __init__(self, vertices, triangles):
        import pierce

        self.scene = pierce.Scene(vertices, triangles)

    def closest(self, o, d):
        return self.scene.closest_hit(o, d).triangle

    def any(self, o, d):
        return self.scene.any_hit(o, d)

    def all(self, o, d):
        hits = self.scene.all_hits(o, d)
        return hits.ray, hits.triangle

    def inside(self, p):
        return self.scene.locate(p) >= 0

    def nearest(self, p):
        return self.scene.nearest(p).triangle

    def signed(self, p):
        return self.scene.signed_distance(p)


class Open3D:
    distribution = "open3d"

    def __init__(self, vertices, triangles):
        import open3d

        self.tensor = open3d.core.Tensor.from_numpy
        self.scene = open3d.t.geometry.RaycastingScene()
        self.scene.add_triangles(self.tensor(vertices),
                                 self.tensor(triangles.astype(np.uint32)))

    def rays(self, o, d):
        return self.tensor(np.concatenate([o, d], axis=1))

    def closest(self, o, d):
        found = self.scene.cast_rays(self.rays(o, d))["primitive_ids"].numpy().astype(np.int64)
        return np.where(found == 0xFFFFFFFF, -1, found)

    def any(self, o, d):
        return self.scene.test_occlusions(self.rays(o, d)).numpy()

    def all(self, o, d):
        found = self.scene.list_intersections(self.rays(o, d))
        return found["ray_ids"].numpy(), found["primitive_ids"].numpy()

    def inside(self, p):
        return self.scene.compute_occupancy(self.tensor(p)).numpy() > 0

    def nearest(self, p):
        return self.scene.compute_closest_points(self.tensor(p))["primitive_ids"].numpy()

    def signed(self, p):
        return self.scene.compute_signed_distance(self.tensor(p)).numpy()


class Trimesh:
    """trimesh with its own engine, in Python with an R-tree."""

    distribution = "trimesh"
    also = ("rtree", "scipy")
    embree = False

    def __init__(self, vertices, triangles):
        import trimesh

        self.trimesh = trimesh
        self.mesh = trimesh.Trimesh(vertices, triangles, process=False)
        engine = trimesh.ray.ray_pyembree if self.embree else trimesh.ray.ray_triangle
        self.engine = self.mesh.ray = engine.RayMeshIntersector(self.mesh)

    def closest(self, o, d):
        return self.engine.intersects_first(o, d)

    def any(self, o, d):
        return self.engine.intersects_any(o, d)

    def all(self, o, d):
        triangles, rays = self.engine.intersects_id(o, d)
        return rays, triangles

    def inside(self, p):
        return self.engine.contains_points(p)

    def nearest(self, p):
        return self.trimesh.proximity.closest_point(self.mesh, p)[2]

    def signed(self, p):
        return -self.trimesh.proximity.signed_distance(self.mesh, p)


class TrimeshEmbree(Trimesh):
    """trimesh with embreex: what most people have."""

    also = ("embreex",)
    embree = True
    nearest = signed = None  # these have nothing to do with the engine


class Embreex:
    """embreex by itself: one thread, first hits."""

    distribution = "embreex"

    def __init__(self, vertices, triangles):
        from embreex import mesh_construction, rtcore_scene

        self.scene = rtcore_scene.EmbreeScene()
        self.mesh = mesh_construction.TriangleMesh(self.scene, vertices[triangles])

    def closest(self, o, d):
        return self.scene.run(o, d)

    def any(self, o, d):
        return self.scene.run(o, d, query="OCCLUDED") >= 0


class PointCloudUtils:
    distribution = "point-cloud-utils"

    def __init__(self, vertices, triangles):
        import point_cloud_utils as pcu

        self.pcu, self.mesh = pcu, (vertices, triangles.astype(np.int32))
        self.scene = pcu.RayMeshIntersector(*self.mesh)

    def closest(self, o, d):
        return self.scene.intersect_rays(o, d)[0]

    def inside(self, p):
        return self.pcu.triangle_soup_fast_winding_number(*self.mesh, p) > 0.5

    def nearest(self, p):
        return self.pcu.closest_points_on_mesh(p, *self.mesh)[1]

    def signed(self, p):
        return self.pcu.signed_distance_to_mesh(p, *self.mesh)[0]


class Libigl:
    distribution = "libigl"

    def __init__(self, vertices, triangles):
        import igl

        self.igl, self.mesh = igl, (vertices.astype(np.float64), triangles.astype(np.int64))
        self.tree = igl.AABB()
        self.tree.init(*self.mesh)

    def prepare(self, *arrays):
        return tuple(array.astype(np.float64) for array in arrays)

    def closest(self, o, d):
        return self.tree.intersect_ray_first(*self.mesh, o, d)[0]

    def all(self, o, d):
        lists = self.tree.intersect_ray(*self.mesh, o, d)
        rays = np.repeat(np.arange(len(lists)), [len(hits) for hits in lists])
        return rays, np.array([hit[0] for hits in lists for hit in hits], np.int64)

    def inside(self, p):
        return self.igl.fast_winding_number(*self.mesh, p) > 0.5

    def nearest(self, p):
        return self.tree.squared_distance(*self.mesh, p)[1]

    def signed(self, p):
        return self.igl.signed_distance(p, *self.mesh)[0]


class Fcpw:
    distribution = "fcpw"
    far = np.float32(3e38)

    def __init__(self, vertices, triangles):
        import fcpw

        self.fcpw, self.scene = fcpw, fcpw.scene_3D()
        self.scene.set_object_count(1)
        self.scene.set_object_vertices(np.asfortranarray(vertices), 0)
        self.scene.set_object_triangles(np.asfortranarray(triangles.astype(np.int32)), 0)
        self.scene.build(fcpw.aggregate_type.bvh_surface_area, True)

    def prepare(self, *arrays):
        return tuple(np.asfortranarray(array) for array in arrays)

    def cast(self, o, d, occlusion):
        found = self.fcpw.interaction_3D_list()
        self.scene.intersect(o, d, np.full(len(o), self.far), found, occlusion)
        return np.fromiter((hit.primitive_index for hit in found), np.int64, len(o))

    def closest(self, o, d):
        return self.cast(o, d, False)

    def inside(self, p):
        result = np.zeros(len(p), np.int32)
        self.scene.contains(p, result)
        return result > 0

    def nearest(self, p):
        found = self.fcpw.interaction_3D_list()
        self.scene.find_closest_points(p, np.full(len(p), self.far), found)
        return np.fromiter((hit.primitive_index for hit in found), np.int64, len(p))


class Warp:
    """NVIDIA Warp on the CPU, which is one thread; the user writes the kernels."""

    distribution = "warp-lang"

    def __init__(self, vertices, triangles):
        import peers_warp
        import warp

        warp.config.quiet = True
        self.warp, self.kernels = warp, peers_warp
        with warp.ScopedDevice("cpu"):
            self.mesh = warp.Mesh(warp.array(vertices, dtype=warp.vec3),
                                  warp.array(triangles.astype(np.int32).reshape(-1)))

    def run(self, kernel, dtype, *vectors):
        with self.warp.ScopedDevice("cpu"):
            result = self.warp.zeros(len(vectors[0]), dtype=dtype)
            given = [self.warp.array(v, dtype=self.warp.vec3, copy=False) for v in vectors]
            self.warp.launch(kernel, dim=len(vectors[0]), inputs=[self.mesh.id, *given, result])
            return result.numpy()

    def closest(self, o, d):
        return self.run(self.kernels.closest, self.warp.int32, o, d)

    def any(self, o, d):
        return self.run(self.kernels.any_hit, self.warp.bool, o, d)

    def nearest(self, p):
        return self.run(self.kernels.nearest, self.warp.int32, p)

    def inside(self, p):
        return self.signed(p) <= 0

    def signed(self, p):
        return self.run(self.kernels.signed, self.warp.float32, p)


ENGINES = {"pierce": Pierce, "Open3D": Open3D, "embreex": Embreex,
           "trimesh + embreex": TrimeshEmbree, "trimesh": Trimesh,
           "point-cloud-utils": PointCloudUtils, "libigl": Libigl, "fcpw": Fcpw, "Warp": Warp}
