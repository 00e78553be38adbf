#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs programs of trimesh, Open3D, pyvista and embreex as they are, and with pierce in place.

The programs are examples of these projects: some are in the installed packages or in their
docstrings, others in their repositories, from which they are fetched, or taken from FOLDER if they
are there already; of notebooks the cells run one after the other. Nothing in them is changed:
before they start, `install()` of a stand-in is called or not. All arrays that they leave behind and
all pictures that they show are compared. Two minutes.

usage: stand_in_programs.py [FOLDER]      by the Python of an environment as for stand_in_tests.py,
                                          with matplotlib and Pillow
"""

import argparse
import doctest
import json
import os
import pathlib
import runpy
import subprocess
import sys
import tempfile
import types
import urllib.error
import urllib.request

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
GITHUB = "https://raw.githubusercontent.com/"
# Name, the stand-in, where the program is: in a package, in a docstring, or in a repository.
PROGRAMS = {
    "open3d_to_image.py": ("open3d", "package", "examples/geometry/ray_casting_to_image.py"),
    "open3d_closest.py": ("open3d", "package", "examples/geometry/ray_casting_closest_geometry.py"),
    "open3d_sdf.py": ("open3d", "package", "examples/geometry/ray_casting_sdf.py"),
    "open3d_ray_casting.ipynb": ("open3d", "repository", "isl-org/Open3D/"
        "380410ef6eeb041dc5a9e185e38c37a986565872/docs/jupyter/geometry/ray_casting.ipynb"),
    "open3d_distance_queries.ipynb": ("open3d", "repository", "isl-org/Open3D/"
        "1dc7672f5d5a1f49fab29f2a8ecd186246548b5a/docs/jupyter/geometry/distance_queries.ipynb"),
    "pyvista_ray_trace.py": ("pyvista", "docstring", "ray_trace"),
    "pyvista_multi_ray_trace.py": ("pyvista", "docstring", "multi_ray_trace"),
    "pyvista_interior_points.py": ("pyvista", "docstring", "select_interior_points"),
    "pyvista_implicit_distance.py": ("pyvista", "docstring", "compute_implicit_distance"),
    "pyvista_poly_ray_trace.py": ("pyvista", "repository", "pyvista/pyvista/"
        "5235d2c99d4608103aac65bbfa146d995781172a/examples/01-filter/poly_ray_trace.py"),
    "pyvista_distance_between_surfaces.py": ("pyvista", "repository", "pyvista/pyvista/"
        "218166997f6ab2ad2433eda5dbb08604ca46e08b/examples/01-filter/distance_between_surfaces.py"),
    "trimesh_ray.py": ("trimesh", "repository", "mikedh/trimesh/"
        "4368031a543c904dd85522819895a2a63359d761/examples/ray.py"),
    "trimesh_raytrace.py": ("trimesh", "repository", "mikedh/trimesh/"
        "d41ff7fed847ba817a1c3f768be11c62b2d5dcbb/examples/raytrace.py"),
    "embreex_intersection.py": ("embreex", "repository", "trimesh/embreex/"
        "11836702f55472392738674f698eaea810a0879f/examples/intersection.py"),
    "embreex_attenuate.py": ("embreex", "repository", "trimesh/embreex/"
        "b751432708d561525625254ae77b399f43e8d816/examples/attenuate.py"),
}


def fetch(name, folder):
    """The program's path, or None."""
    package, kind, where = PROGRAMS[name]
    path = folder / name
    if kind == "package":
        module = __import__(package)
        return pathlib.Path(module.__file__).parent / where
    if kind == "docstring":
        import pyvista

        text = getattr(pyvista.PolyData, where).__doc__
        examples = doctest.DocTestParser().get_examples(text)
        path.write_text("".join(example.source for example in examples))
        return path
    if not path.exists():
        try:
            with urllib.request.urlopen(GITHUB + where, timeout=20) as page:
                path.write_bytes(page.read())
        except urllib.error.URLError:
            return None
    return cells_of(path) if path.suffix == ".ipynb" else path


def cells_of(path):
    """A notebook's code as a program."""
    cells = json.loads(path.read_text())["cells"]
    program = path.with_suffix(".cells.py")
    program.write_text("\n".join("".join(cell["source"]) + "\n" for cell in cells
                                 if cell["cell_type"] == "code"))
    return program


def prepare(package, folder):
    """Windows stay shut, pictures are kept, downloads are made here."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.axes
    import matplotlib.pyplot

    pictures = []
    draw = matplotlib.axes.Axes.imshow

    def imshow(axes, image, *args, **options):
        pictures.append(np.asarray(image))
        return draw(axes, image, *args, **options)

    matplotlib.axes.Axes.imshow = imshow
    matplotlib.pyplot.show = lambda *args, **options: None
    sys.path.insert(0, str(HERE.parent / "examples" / "python"))
    if package == "open3d":
        import meshes
        import open3d

        vertices, triangles = meshes.knot(along=120, around=24)
        path = str(folder / "knot.ply")
        open3d.io.write_triangle_mesh(path, open3d.geometry.TriangleMesh(
            open3d.utility.Vector3dVector(vertices),
            open3d.utility.Vector3iVector(triangles.astype(np.int32))))
        open3d.data.ArmadilloMesh = lambda: types.SimpleNamespace(path=path)
        sys.modules["open3d_tutorial"] = types.ModuleType("open3d_tutorial")  # it shows windows
        open3d.visualization.draw_geometries = lambda *args, **options: None
    if package == "pyvista":
        import pyvista

        pyvista.OFF_SCREEN = True
        pyvista.Plotter.show = lambda *args, **options: None
        pyvista.Plotter.add_mesh = pyvista.Plotter.add_points = lambda *args, **options: None
        pyvista.Plotter.add_legend = pyvista.Plotter.show_grid = lambda *args, **options: None
    if package == "trimesh":
        import PIL.Image
        import trimesh

        sys.path.insert(0, str(HERE / "stand_ins"))
        import generic

        (folder / "models").mkdir(exist_ok=True)
        generic.get_mesh("featuretype.STL").export(folder / "models" / "featuretype.STL")
        trimesh.Scene.show = lambda *args, **options: None
        PIL.Image.Image.show = lambda image: pictures.append(np.asarray(image))
    work = folder / "work"
    work.mkdir(exist_ok=True)
    os.chdir(work)
    np.random.seed(0)
    return pictures


def arrays_of(name, value, found):
    """Adds the numbers of a program's variable."""
    if isinstance(value, dict):
        for key, part in value.items():
            arrays_of(f"{name}.{key}", part, found)
    elif hasattr(value, "point_data") and hasattr(value, "points"):  # pyvista
        found[f"{name}.points"] = np.asarray(value.points)
        for key in value.array_names:
            found[f"{name}.{key}"] = np.asarray(value[key])
    elif type(value).__name__ == "Tensor":
        found[name] = value.numpy()
    elif isinstance(value, np.ndarray) and value.dtype.kind in "fiub":
        found[name] = np.asarray(value)


def child(name, stand_in, path, out, folder):
    package = PROGRAMS[name][0]
    pictures = prepare(package, folder)
    if stand_in:
        __import__(f"pierce.{package}")
        getattr(__import__("pierce"), package).install()
    names = runpy.run_path(str(path), run_name="__main__")
    found = {}
    for key, value in names.items():
        if not key.startswith("_"):
            arrays_of(key, value, found)
    found.update({f"picture {i}": picture for i, picture in enumerate(pictures)})
    np.savez(out, **found)


def compare(first, second):
    """(arrays, numbers, those that differ by more than 1e-5 of the array's size, names)."""
    count = numbers = different = 0
    names = []
    for key in first.files:
        a, b = first[key], second[key]
        count, numbers = count + 1, numbers + a.size
        if a.shape != b.shape:
            different += max(a.size, b.size)
            names.append(key)
            continue
        a, b = a.astype(np.float64), b.astype(np.float64)
        finite = np.isfinite(a) & np.isfinite(b)
        size = np.abs(a[finite]).max(initial=0)
        with np.errstate(invalid="ignore"):
            same = (np.abs(a - b) <= 1e-5 * size) | (a == b) | (np.isnan(a) & np.isnan(b))
        if not same.all():
            different += int((~same).sum())
            names.append(f"{key} ({int((~same).sum())})")
    return count, numbers, different, names


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", nargs="?", type=pathlib.Path)
    parser.add_argument("--child", help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.child:
        name, stand_in, path, out, folder = json.loads(options.child)
        child(name, stand_in, path, out, pathlib.Path(folder))
        return
    done = 0
    with tempfile.TemporaryDirectory() as temporary:
        programs = (options.folder or pathlib.Path(temporary) / "programs").resolve()
        programs.mkdir(exist_ok=True)
        for name in PROGRAMS:
            path = fetch(name, programs)
            if path is None:
                print(f"{name}: GitHub cannot be reached: left out; put it into {programs}")
                continue
            results = []
            for stand_in in (False, True):
                out = f"{temporary}/{name}.{stand_in}.npz"
                call = json.dumps([name, stand_in, str(path), out, temporary])
                ran = subprocess.run([sys.executable, __file__, "--child", call],
                                     capture_output=True, text=True, check=False)
                if ran.returncode:
                    sys.exit(f"{name}: {ran.stderr}")
                results.append(np.load(out))
            count, numbers, different, names = compare(*results)
            print(f"{name}: {count} arrays of {numbers:,} numbers; {different:,} differ "
                  f"{', '.join(names)}".rstrip(), flush=True)
            done += 1
    print(f"{done} programs")


if __name__ == "__main__":
    main()
