//! Embree 4, loaded where it is found.
#![allow(unsafe_code)]

use std::ffi::{c_char, c_int, c_uint, c_void};
use std::path::PathBuf;
use std::ptr::null;

use caustica_scene::bvh::Ray;
use libloading::{Library, Symbol};

use crate::rooms::Room;

type Handle = *mut c_void;

/// `RTCRayHit`, with room to spare at the end.
#[repr(C, align(16))]
struct RayHit {
    origin: [f32; 3],
    t_near: f32,
    direction: [f32; 3],
    time: f32,
    t_far: f32,
    mask: c_uint,
    id: c_uint,
    flags: c_uint,
    normal: [f32; 3],
    u: f32,
    v: f32,
    primitive: c_uint,
    geometry: c_uint,
    instance: [c_uint; 5],
}

impl RayHit {
    fn new(ray: &Ray) -> Self {
        Self {
            origin: ray.origin.to_array(),
            t_near: 0.0,
            direction: ray.direction.to_array(),
            time: 0.0,
            t_far: ray.t_max,
            mask: c_uint::MAX,
            id: 0,
            flags: 0,
            normal: [0.0; 3],
            u: 0.0,
            v: 0.0,
            primitive: c_uint::MAX,
            geometry: c_uint::MAX,
            instance: [c_uint::MAX; 5],
        }
    }
}

/// A scene of Embree's.
#[derive(Debug)]
pub struct Embree {
    scene: Handle,
    intersect: unsafe extern "C" fn(Handle, *mut RayHit, *const c_void),
    occluded: unsafe extern "C" fn(Handle, *mut RayHit, *const c_void),
    release_scene: unsafe extern "C" fn(Handle),
    release_device: unsafe extern "C" fn(Handle),
    device: Handle,
}

// SAFETY: Embree's scenes may be asked by many threads once they are committed.
unsafe impl Sync for Embree {}

/// Where the library may be: in `EMBREE_LIBRARY`, among the system's, or in a Python package.
fn candidates() -> Vec<PathBuf> {
    if let Some(path) = std::env::var_os("EMBREE_LIBRARY") {
        return vec![path.into()];
    }
    let mut paths =
        ["libembree4.so.4", "libembree4.so", "libembree4.dylib", "embree4.dll"].map(PathBuf::from).to_vec();
    let find = "import embreex, glob, os; p = os.path.dirname(embreex.__file__); \
                print(*glob.glob(p + '.libs/libembree4*') + glob.glob(p + '/*embree4*'), sep='\\n')";
    if let Ok(output) = std::process::Command::new("python3").args(["-c", find]).output() {
        paths.extend(String::from_utf8_lossy(&output.stdout).lines().map(PathBuf::from));
    }
    paths
}

impl Embree {
    /// Builds the tree of a room, at Embree's usual quality and in its fast mode. `None` if no library is found.
    pub fn new(room: &Room) -> Option<Self> {
        // SAFETY: loading Embree runs its constructors, which do nothing but set up.
        let library = candidates().into_iter().find_map(|p| unsafe { Library::new(p) }.ok())?;
        // Its threads outlive scenes, so the library is never unloaded.
        // SAFETY: the signatures are those of Embree 4's `rtcore.h`; the buffers that it hands out have the
        // sizes that are asked for.
        unsafe { Self::build(Box::leak(Box::new(library)), room) }.ok()
    }

    unsafe fn build(library: &'static Library, room: &Room) -> Result<Self, libloading::Error> {
        // SAFETY: as in `new`.
        unsafe {
            let new_device: Symbol<'_, unsafe extern "C" fn(*const c_char) -> Handle> =
                library.get(b"rtcNewDevice")?;
            let new_scene: Symbol<'_, unsafe extern "C" fn(Handle) -> Handle> =
                library.get(b"rtcNewScene")?;
            let new_geometry: Symbol<'_, unsafe extern "C" fn(Handle, c_int) -> Handle> =
                library.get(b"rtcNewGeometry")?;
            type NewBuffer = unsafe extern "C" fn(Handle, c_int, c_uint, c_int, usize, usize) -> Handle;
            let new_buffer: Symbol<'_, NewBuffer> = library.get(b"rtcSetNewGeometryBuffer")?;
            let commit_geometry: Symbol<'_, unsafe extern "C" fn(Handle)> =
                library.get(b"rtcCommitGeometry")?;
            let attach: Symbol<'_, unsafe extern "C" fn(Handle, Handle) -> c_uint> =
                library.get(b"rtcAttachGeometry")?;
            let release_geometry: Symbol<'_, unsafe extern "C" fn(Handle)> =
                library.get(b"rtcReleaseGeometry")?;
            let commit_scene: Symbol<'_, unsafe extern "C" fn(Handle)> = library.get(b"rtcCommitScene")?;
            let device = new_device(null());
            let (scene, geometry) = (new_scene(device), new_geometry(device, 0));
            let vertices = new_buffer(geometry, 1, 0, 0x9003, 12, room.positions.len()).cast::<[f32; 3]>();
            for (i, p) in room.positions.iter().enumerate() {
                *vertices.add(i) = p.to_array();
            }
            let indices = new_buffer(geometry, 0, 0, 0x5003, 12, room.triangles.len()).cast::<[u32; 3]>();
            for (i, t) in room.triangles.iter().enumerate() {
                *indices.add(i) = *t;
            }
            commit_geometry(geometry);
            attach(scene, geometry);
            release_geometry(geometry);
            commit_scene(scene);
            Ok(Self {
                scene,
                device,
                intersect: *library.get(b"rtcIntersect1")?,
                occluded: *library.get(b"rtcOccluded1")?,
                release_scene: *library.get(b"rtcReleaseScene")?,
                release_device: *library.get(b"rtcReleaseDevice")?,
            })
        }
    }

    /// Distance and triangle of the first hit.
    #[inline]
    pub fn closest(&self, ray: &Ray) -> Option<(f32, u32)> {
        let mut query = RayHit::new(ray);
        // SAFETY: the scene lives as long as this does, and the query is laid out as Embree has it.
        unsafe { (self.intersect)(self.scene, &mut query, null()) };
        (query.geometry != c_uint::MAX).then_some((query.t_far, query.primitive))
    }

    /// Whether the ray hits anything.
    #[inline]
    pub fn occluded(&self, ray: &Ray) -> bool {
        let mut query = RayHit::new(ray);
        // SAFETY: as in `closest`; occlusion queries write nothing but `t_far`.
        unsafe { (self.occluded)(self.scene, &mut query, null()) };
        query.t_far < 0.0
    }
}

impl Drop for Embree {
    fn drop(&mut self) {
        // SAFETY: both were made by `build` and are released once.
        unsafe {
            (self.release_scene)(self.scene);
            (self.release_device)(self.device);
        }
    }
}
