# SPDX-License-Identifier: Apache-2.0
"""pierce by ctypes, from the C library alone; see ask.c in the folder above.

(The Python package, docs/python.md, does all this and more for you.)

    python ask_ctypes.py libpierce_c.so
"""
import ctypes
import sys


class Mesh(ctypes.Structure):
    _fields_ = [("vertices", ctypes.POINTER(ctypes.c_float)), ("vertex_count", ctypes.c_size_t),
                ("triangles", ctypes.POINTER(ctypes.c_uint32)), ("triangle_count", ctypes.c_size_t)]


class Ray(ctypes.Structure):
    _fields_ = [("origin", ctypes.c_float * 3), ("direction", ctypes.c_float * 3),
                ("t_min", ctypes.c_float), ("t_max", ctypes.c_float)]


class Hit(ctypes.Structure):
    _fields_ = [*((name, ctypes.c_float) for name in "tuvw"), ("geometry", ctypes.c_uint32),
                ("triangle", ctypes.c_uint32), ("facing", ctypes.c_uint8)]


class Error(ctypes.Structure):
    _fields_ = [("code", ctypes.c_int), ("index", ctypes.c_uint64), ("count", ctypes.c_uint64),
                ("message", ctypes.c_char * 1000)]


pierce = ctypes.CDLL(sys.argv[1])
pierce.pierce_code_name.restype = ctypes.c_char_p
pierce.pierce_free_f32.argtypes = [ctypes.c_void_p]
pierce.pierce_free_f32.restype = None
pierce.pierce_closest_hits_f32.argtypes = [
    ctypes.c_void_p, ctypes.POINTER(Ray), ctypes.c_size_t, ctypes.c_void_p, ctypes.POINTER(Hit),
    ctypes.POINTER(Error)]

vertices = (ctypes.c_float * 12)(0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0)
triangles = (ctypes.c_uint32 * 6)(0, 1, 2, 0, 2, 3)
mesh = Mesh(vertices, 4, triangles, 2)
scene, error = ctypes.c_void_p(), Error()
if pierce.pierce_build_f32(ctypes.byref(mesh), ctypes.c_size_t(1), None, ctypes.byref(scene),
                           ctypes.byref(error)):
    sys.exit(error.message.decode())

end = float("inf")
rays = (Ray * 2)(Ray((0.25, 0.25, 1), (0, 0, -3), 0, end), Ray((0, 0, 1), (0, 0, 0), 0, end))
hits = (Hit * 2)()
if pierce.pierce_closest_hits_f32(scene, rays, 1, None, hits, error) == 0:
    hit = hits[0]
    print(f"triangle {hit.triangle} at t = {hit.t:.9g}, u = {hit.u:g}, v = {hit.v:g}")
code = pierce.pierce_closest_hits_f32(scene, rays, 2, None, hits, error)
if code:
    print(f"ray {error.index} is refused: {pierce.pierce_code_name(code).decode()}")
pierce.pierce_free_f32(scene)
