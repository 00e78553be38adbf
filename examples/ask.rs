// SPDX-License-Identifier: Apache-2.0
//
// pierce from Rust, by its C interface: a scene that frees itself, errors as Result. See ask.c.
// Build: rustc ask.rs -L FOLDER_OF_LIBPIERCE_C
use std::ffi::{c_char, c_int, c_void, CStr};
use std::marker::PhantomData;

#[repr(C)]
struct RawMesh {
    vertices: *const f32,
    vertex_count: usize,
    triangles: *const u32,
    triangle_count: usize,
}

#[repr(C)]
struct Ray {
    origin: [f32; 3],
    direction: [f32; 3],
    t_min: f32,
    t_max: f32,
}

#[repr(C)]
#[derive(Clone, Default)]
struct Hit {
    t: f32,
    u: f32,
    v: f32,
    w: f32,
    geometry: u32,
    triangle: u32,
    facing: u8,
}

#[repr(C)]
struct RawError {
    code: c_int,
    index: u64,
    count: u64,
    message: [c_char; 1000],
}

#[link(name = "pierce_c")]
extern "C" {
    fn pierce_build_f32(meshes: *const RawMesh, count: usize, options: *const c_void,
                        scene: *mut *mut c_void, error: *mut RawError) -> c_int;
    fn pierce_free_f32(scene: *mut c_void);
    fn pierce_closest_hits_f32(scene: *const c_void, rays: *const Ray, count: usize,
                               options: *const c_void, hits: *mut Hit,
                               error: *mut RawError) -> c_int;
    fn pierce_code_name(code: c_int) -> *const c_char;
}

/// What went wrong: the code's name, the number of the first offender, and a line that says more.
#[derive(Debug)]
struct Error {
    name: String,
    index: u64,
    #[allow(dead_code)] // for whoever prints it
    message: String,
}

fn checked(call: impl FnOnce(*mut RawError) -> c_int) -> Result<(), Error> {
    let mut raw = RawError { code: 0, index: 0, count: 0, message: [0; 1000] };
    if call(&mut raw) == 0 {
        return Ok(());
    }
    let text = |from| unsafe { CStr::from_ptr(from) }.to_string_lossy().into_owned();
    let name = text(unsafe { pierce_code_name(raw.code) });
    Err(Error { name, index: raw.index, message: text(raw.message.as_ptr()) })
}

/// A scene over its own copy of a mesh.
struct Scene(*mut c_void, PhantomData<f32>);

impl Scene {
    fn build(vertices: &[[f32; 3]], triangles: &[[u32; 3]]) -> Result<Scene, Error> {
        let mesh = RawMesh {
            vertices: vertices.as_ptr().cast(),
            vertex_count: vertices.len(),
            triangles: triangles.as_ptr().cast(),
            triangle_count: triangles.len(),
        };
        let mut scene = std::ptr::null_mut();
        checked(|error| unsafe {
            pierce_build_f32(&mesh, 1, std::ptr::null(), &mut scene, error)
        })?;
        Ok(Scene(scene, PhantomData))
    }

    fn closest_hits(&self, rays: &[Ray]) -> Result<Vec<Hit>, Error> {
        let mut hits = vec![Hit::default(); rays.len()];
        checked(|error| unsafe {
            pierce_closest_hits_f32(self.0, rays.as_ptr(), rays.len(), std::ptr::null(),
                                    hits.as_mut_ptr(), error)
        })?;
        Ok(hits)
    }
}

impl Drop for Scene {
    fn drop(&mut self) {
        unsafe { pierce_free_f32(self.0) }
    }
}

fn main() -> Result<(), Error> {
    let vertices = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let scene = Scene::build(&vertices, &[[0, 1, 2], [0, 2, 3]])?;
    let ray = |origin, direction| Ray { origin, direction, t_min: 0.0, t_max: f32::INFINITY };
    let rays = [ray([0.25, 0.25, 1.0], [0.0, 0.0, -3.0]), ray([0.0, 0.0, 1.0], [0.0; 3])];
    let hit = &scene.closest_hits(&rays[..1])?[0];
    println!("triangle {} at t = {:.9}, u = {}, v = {}", hit.triangle, hit.t, hit.u, hit.v);
    if let Err(error) = scene.closest_hits(&rays) {
        println!("ray {} is refused: {}", error.index, error.name);
    }
    Ok(())
}
