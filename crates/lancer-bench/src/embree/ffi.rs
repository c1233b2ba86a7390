//! The few calls of Embree's C interface that the comparison needs, behind safe types.
//!
//! The only file of the workspace with `unsafe` in it: Embree is a C library, loaded at run time so that nothing
//! of it is needed to build. Version 4 is meant; version 3 differs in the last two arguments of its queries, and is
//! served too. Source: the headers of Embree 4.4, `rtcore_*.h`.

#![allow(unsafe_code, reason = "there is no other way to call a C library")]

use crate::Failure;
use libloading::Library as Code;
use std::ffi::{CString, c_char, c_int, c_void};
use std::path::Path;
use std::ptr::null_mut;
use std::sync::Arc;
use std::sync::atomic::{AtomicI64, Ordering};

type Handle = *mut c_void;
type MemoryMonitor = extern "C" fn(*mut c_void, isize, bool) -> bool;
/// (scene, ray, arguments) in version 4, (scene, context, ray) in version 3.
type QuerySingle = unsafe extern "C" fn(Handle, *mut c_void, *mut c_void);
/// The same behind the mask of the lanes that count.
type QueryPacket = unsafe extern "C" fn(*const c_int, Handle, *mut c_void, *mut c_void);
type SetSharedBuffer = unsafe extern "C" fn(Handle, u32, u32, u32, *const c_void, usize, usize, usize);

/// No geometry, no instance, no primitive: RTC_INVALID_GEOMETRY_ID.
pub(crate) const NONE: u32 = u32::MAX;

const BUFFER_INDEX: u32 = 0;
const BUFFER_VERTEX: u32 = 1;
const BUFFER_TRANSFORM: u32 = 23;
const FORMAT_UINT3: u32 = 0x5003;
const FORMAT_FLOAT3: u32 = 0x9003;
const FORMAT_FLOAT3X4_COLUMN_MAJOR: u32 = 0x9234;
const GEOMETRY_TRIANGLE: u32 = 0;
const GEOMETRY_INSTANCE: u32 = 121;
const GEOMETRY_INSTANCE_ARRAY: u32 = 122;
const SCENE_ROBUST: u32 = 1 << 2;
const DEVICE_VERSION: u32 = 0;
const COHERENT_3: u32 = 1;
const COHERENT_4: u32 = 1 << 16;

macro_rules! calls {
    ($($field:ident: $symbol:literal as $type:ty;)*) => {
        struct Calls { $($field: $type,)* }

        impl Calls {
            fn load(code: &Code) -> Result<Self, libloading::Error> {
                // SAFETY: each type is that of the function of this name in Embree's headers, which both versions
                // keep; `code` is never unloaded.
                unsafe { Ok(Self { $($field: *code.get::<$type>(concat!($symbol, "\0").as_bytes())?,)* }) }
            }
        }
    };
}

calls! {
    new_device: "rtcNewDevice" as unsafe extern "C" fn(*const c_char) -> Handle;
    release_device: "rtcReleaseDevice" as unsafe extern "C" fn(Handle);
    device_error: "rtcGetDeviceError" as unsafe extern "C" fn(Handle) -> c_int;
    device_property: "rtcGetDeviceProperty" as unsafe extern "C" fn(Handle, u32) -> isize;
    set_memory_monitor: "rtcSetDeviceMemoryMonitorFunction"
        as unsafe extern "C" fn(Handle, MemoryMonitor, *mut c_void);
    new_scene: "rtcNewScene" as unsafe extern "C" fn(Handle) -> Handle;
    release_scene: "rtcReleaseScene" as unsafe extern "C" fn(Handle);
    set_scene_flags: "rtcSetSceneFlags" as unsafe extern "C" fn(Handle, u32);
    set_scene_quality: "rtcSetSceneBuildQuality" as unsafe extern "C" fn(Handle, u32);
    commit_scene: "rtcCommitScene" as unsafe extern "C" fn(Handle);
    new_geometry: "rtcNewGeometry" as unsafe extern "C" fn(Handle, u32) -> Handle;
    release_geometry: "rtcReleaseGeometry" as unsafe extern "C" fn(Handle);
    commit_geometry: "rtcCommitGeometry" as unsafe extern "C" fn(Handle);
    attach_geometry: "rtcAttachGeometry" as unsafe extern "C" fn(Handle, Handle) -> u32;
    set_geometry_quality: "rtcSetGeometryBuildQuality" as unsafe extern "C" fn(Handle, u32);
    set_shared_buffer: "rtcSetSharedGeometryBuffer" as SetSharedBuffer;
    set_instanced_scene: "rtcSetGeometryInstancedScene" as unsafe extern "C" fn(Handle, Handle);
    set_transform: "rtcSetGeometryTransform" as unsafe extern "C" fn(Handle, u32, u32, *const c_void);
    intersect1: "rtcIntersect1" as QuerySingle;
    intersect8: "rtcIntersect8" as QueryPacket;
    intersect16: "rtcIntersect16" as QueryPacket;
    occluded1: "rtcOccluded1" as QuerySingle;
    occluded8: "rtcOccluded8" as QueryPacket;
    occluded16: "rtcOccluded16" as QueryPacket;
}

/// Embree, loaded.
pub(crate) struct Library {
    calls: Calls,
}

impl Library {
    /// Loads the library from a path, or by a name that the system's loader knows.
    pub(crate) fn open(path: &Path) -> Result<Arc<Self>, Failure> {
        // SAFETY: Embree's initialisers only fill its own tables.
        let code = unsafe { Code::new(path)? };
        let calls = Calls::load(&code)?;
        // Never unloaded: threads that it started may still be in it.
        std::mem::forget(code);
        Ok(Arc::new(Self { calls }))
    }
}

/// Bytes that Embree has told of, now and at most.
#[derive(Default)]
struct Meter {
    now: AtomicI64,
    peak: AtomicI64,
}

extern "C" fn on_memory(meter: *mut c_void, bytes: isize, _after: bool) -> bool {
    // SAFETY: `meter` is what `Device::new` gave, which lives until after the device.
    let meter = unsafe { &*meter.cast::<Meter>() };
    let now = meter.now.fetch_add(bytes as i64, Ordering::Relaxed) + bytes as i64;
    meter.peak.fetch_max(now, Ordering::Relaxed);
    true
}

/// A device: a number of threads to build with, and an account of memory.
pub(crate) struct Device {
    library: Arc<Library>,
    raw: Handle,
    meter: Box<Meter>,
    /// 30000 and more in version 3, 40000 and more in version 4.
    version: isize,
}

// SAFETY: Embree's devices may be used from any thread; the meter is atomic.
unsafe impl Send for Device {}
// SAFETY: as above.
unsafe impl Sync for Device {}

impl Device {
    /// A device with Embree's configuration text, as `threads=1`.
    pub(crate) fn new(library: &Arc<Library>, config: &str) -> Result<Arc<Self>, Failure> {
        let config = CString::new(config)?;
        let meter = Box::new(Meter::default());
        // SAFETY: the text ends in NUL; the meter is boxed, so that it stays where it is for as long as the device.
        unsafe {
            let raw = (library.calls.new_device)(config.as_ptr());
            if raw.is_null() {
                return Err("Embree made no device".into());
            }
            let user = std::ptr::from_ref::<Meter>(&meter).cast_mut().cast();
            (library.calls.set_memory_monitor)(raw, on_memory, user);
            let version = (library.calls.device_property)(raw, DEVICE_VERSION);
            Ok(Arc::new(Self { library: Arc::clone(library), raw, meter, version }))
        }
    }

    /// As `4.4.0`.
    pub(crate) fn version(&self) -> String {
        format!("{}.{}.{}", self.version / 10_000, self.version / 100 % 100, self.version % 100)
    }

    /// Bytes in use by the device's scenes.
    pub(crate) fn bytes(&self) -> u64 {
        self.meter.now.load(Ordering::Relaxed).max(0) as u64
    }

    /// The most bytes that were ever in use.
    pub(crate) fn peak_bytes(&self) -> u64 {
        self.meter.peak.load(Ordering::Relaxed).max(0) as u64
    }

    /// Whether many instances may be one geometry.
    fn has_instance_arrays(&self) -> bool {
        self.version >= 40_300
    }

    fn check(&self) -> Result<(), Failure> {
        // SAFETY: the device is alive.
        match unsafe { (self.library.calls.device_error)(self.raw) } {
            0 => Ok(()),
            code => Err(format!("Embree reports error {code}").into()),
        }
    }
}

impl Drop for Device {
    fn drop(&mut self) {
        // SAFETY: scenes hold an `Arc` of their device, so that none is left.
        unsafe { (self.library.calls.release_device)(self.raw) }
    }
}

/// How much work a build does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Quality {
    Low,
    Medium,
    High,
}

/// What a scene is built for.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Build {
    pub(crate) quality: Quality,
    /// Embree's watertight mode.
    pub(crate) robust: bool,
}

/// Triangles in the form that Embree reads.
pub(crate) struct Triangles {
    /// Three a vertex, and one more: Embree reads vertices 16 bytes at a time.
    positions: Vec<f32>,
    indices: Vec<[u32; 3]>,
}

impl Triangles {
    pub(crate) fn new(positions: &[[f32; 3]], indices: &[[u32; 3]]) -> Self {
        assert!(indices.iter().flatten().all(|&index| (index as usize) < positions.len()));
        let mut flat = Vec::with_capacity(3 * positions.len() + 1);
        flat.extend(positions.iter().flatten());
        flat.push(0.0);
        Self { positions: flat, indices: indices.to_vec() }
    }

    /// Bytes of vertices and indices.
    pub(crate) fn bytes(&self) -> u64 {
        (size_of_val(&self.positions[..]) + size_of_val(&self.indices[..])) as u64
    }
}

/// What a scene is made of, which must live for as long as it.
#[expect(dead_code, reason = "held, and read by Embree alone")]
enum Part {
    Triangles(Arc<Triangles>),
    Instances(Arc<Scene>, Arc<Vec<[f32; 12]>>),
}

/// A scene, committed: immutable.
pub(crate) struct Scene {
    raw: Handle,
    intersect1: QuerySingle,
    intersect8: QueryPacket,
    intersect16: QueryPacket,
    occluded1: QuerySingle,
    occluded8: QueryPacket,
    occluded16: QueryPacket,
    is_version_3: bool,
    /// An instance's number is its geometry's rather than its place in an array.
    instances_are_geometries: bool,
    _parts: Vec<Part>,
    device: Arc<Device>,
}

// SAFETY: a committed scene may be traced from any number of threads at once; nothing else is done to it.
unsafe impl Send for Scene {}
// SAFETY: as above.
unsafe impl Sync for Scene {}

impl Scene {
    /// Builds the scene of one mesh, which is object 0.
    pub(crate) fn of_triangles(
        device: &Arc<Device>,
        triangles: &Arc<Triangles>,
        build: Build,
    ) -> Result<Self, Failure> {
        let mut scene = Self::empty(device, build);
        let calls = &device.library.calls;
        // SAFETY: the buffers hold what is said of them, are not written to again, and live as long as the scene,
        // which keeps them as its part; vertices are padded as Embree asks.
        unsafe {
            let geometry = (calls.new_geometry)(device.raw, GEOMETRY_TRIANGLE);
            let (positions, indices) = (&triangles.positions, &triangles.indices);
            let vertices = (positions.len() - 1) / 3;
            (calls.set_shared_buffer)(
                geometry,
                BUFFER_VERTEX,
                0,
                FORMAT_FLOAT3,
                positions.as_ptr().cast(),
                0,
                12,
                vertices,
            );
            (calls.set_shared_buffer)(
                geometry,
                BUFFER_INDEX,
                0,
                FORMAT_UINT3,
                indices.as_ptr().cast(),
                0,
                12,
                indices.len(),
            );
            scene.attach(geometry, build);
        }
        scene._parts.push(Part::Triangles(Arc::clone(triangles)));
        scene.commit()
    }

    /// Builds the scene of one other scene in many places, each a matrix of four columns; object i is in place i.
    pub(crate) fn of_instances(
        of: &Arc<Self>,
        places: &Arc<Vec<[f32; 12]>>,
        build: Build,
    ) -> Result<Self, Failure> {
        let device = &of.device;
        let mut scene = Self::empty(device, build);
        let calls = &device.library.calls;
        // SAFETY: the matrices have the layout that is said and live as long as the scene, as does the other scene.
        unsafe {
            if device.has_instance_arrays() {
                let geometry = (calls.new_geometry)(device.raw, GEOMETRY_INSTANCE_ARRAY);
                (calls.set_instanced_scene)(geometry, of.raw);
                (calls.set_shared_buffer)(
                    geometry,
                    BUFFER_TRANSFORM,
                    0,
                    FORMAT_FLOAT3X4_COLUMN_MAJOR,
                    places.as_ptr().cast(),
                    0,
                    48,
                    places.len(),
                );
                scene.attach(geometry, build);
            } else {
                scene.instances_are_geometries = true;
                for place in places.iter() {
                    let geometry = (calls.new_geometry)(device.raw, GEOMETRY_INSTANCE);
                    (calls.set_instanced_scene)(geometry, of.raw);
                    (calls.set_transform)(geometry, 0, FORMAT_FLOAT3X4_COLUMN_MAJOR, place.as_ptr().cast());
                    scene.attach(geometry, build);
                }
            }
        }
        scene._parts.push(Part::Instances(Arc::clone(of), Arc::clone(places)));
        scene.commit()
    }

    fn empty(device: &Arc<Device>, build: Build) -> Self {
        let calls = &device.library.calls;
        // SAFETY: the device is alive, and the scene, which holds it, is released once, when it is dropped.
        let raw = unsafe {
            let raw = (calls.new_scene)(device.raw);
            (calls.set_scene_flags)(raw, if build.robust { SCENE_ROBUST } else { 0 });
            (calls.set_scene_quality)(raw, build.quality as u32);
            raw
        };
        Self {
            raw,
            intersect1: calls.intersect1,
            intersect8: calls.intersect8,
            intersect16: calls.intersect16,
            occluded1: calls.occluded1,
            occluded8: calls.occluded8,
            occluded16: calls.occluded16,
            is_version_3: device.version < 40_000,
            instances_are_geometries: false,
            _parts: Vec::new(),
            device: Arc::clone(device),
        }
    }

    /// # Safety
    /// `geometry` is a live geometry of the same device with all of its buffers set; it is released here.
    unsafe fn attach(&self, geometry: Handle, build: Build) {
        let calls = &self.device.library.calls;
        // SAFETY: as the caller says; the scene keeps the geometry alive.
        unsafe {
            (calls.set_geometry_quality)(geometry, build.quality as u32);
            (calls.commit_geometry)(geometry);
            (calls.attach_geometry)(self.raw, geometry);
            (calls.release_geometry)(geometry);
        }
    }

    fn commit(self) -> Result<Self, Failure> {
        // SAFETY: all geometries are committed.
        unsafe { (self.device.library.calls.commit_scene)(self.raw) };
        self.device.check()?;
        Ok(self)
    }

    /// Finds the nearest hit of each ray that `valid` marks with -1. `N` is 1, 8 or 16.
    #[inline(always)]
    pub(crate) fn intersect<const N: usize>(
        &self,
        valid: &Aligned<[i32; N]>,
        rays: &mut Aligned<RayHits<N>>,
        query: &mut Query,
    ) {
        let (first, second) = self.arguments(std::ptr::from_mut(rays).cast(), query);
        let valid = valid.0.as_ptr();
        // SAFETY: the scene is committed; rays and mask are laid out and aligned as Embree asks, and long enough
        // for the width that each call reads and writes.
        unsafe {
            match N {
                1 => (self.intersect1)(self.raw, first, second),
                8 => (self.intersect8)(valid, self.raw, first, second),
                16 => (self.intersect16)(valid, self.raw, first, second),
                _ => unreachable!("Embree has packets of 1, 8 and 16"),
            }
        }
    }

    /// Sets `tfar` of each ray that `valid` marks with -1 below 0 where it meets anything. `N` is 1, 8 or 16.
    #[inline(always)]
    pub(crate) fn occluded<const N: usize>(
        &self,
        valid: &Aligned<[i32; N]>,
        rays: &mut Aligned<Rays<N>>,
        query: &mut Query,
    ) {
        let (first, second) = self.arguments(std::ptr::from_mut(rays).cast(), query);
        let valid = valid.0.as_ptr();
        // SAFETY: as for `intersect`; these calls read and write the rays alone.
        unsafe {
            match N {
                1 => (self.occluded1)(self.raw, first, second),
                8 => (self.occluded8)(valid, self.raw, first, second),
                16 => (self.occluded16)(valid, self.raw, first, second),
                _ => unreachable!("Embree has packets of 1, 8 and 16"),
            }
        }
    }

    /// The object that a hit is of.
    #[inline(always)]
    pub(crate) fn object<const N: usize>(&self, hits: &Hits<N>, lane: usize) -> u32 {
        match (hits.instance[lane], self.instances_are_geometries) {
            (NONE, _) => 0,
            (instance, true) => instance,
            (_, false) => hits.instance_primitive[lane],
        }
    }

    /// The last two arguments of a query in the order of this version.
    #[inline(always)]
    fn arguments(&self, rays: *mut c_void, query: &mut Query) -> (*mut c_void, *mut c_void) {
        if self.is_version_3 {
            (std::ptr::from_mut(&mut query.context_3).cast(), rays)
        } else {
            (rays, std::ptr::from_mut(&mut query.arguments_4).cast())
        }
    }
}

impl Drop for Scene {
    fn drop(&mut self) {
        // SAFETY: nothing uses it any more, and its parts are dropped after this.
        unsafe { (self.device.library.calls.release_scene)(self.raw) }
    }
}

/// How rays are traced; one a thread, since version 3 writes to it.
pub(crate) struct Query {
    arguments_4: Arguments4,
    context_3: Context3,
}

/// RTCIntersectArguments and RTCOccludedArguments.
#[repr(C)]
struct Arguments4 {
    flags: u32,
    feature_mask: u32,
    context: *mut c_void,
    filter: *mut c_void,
    callback: *mut c_void,
    min_width_distance_factor: f32,
}

/// RTCIntersectContext of version 3.
#[repr(C)]
struct Context3 {
    flags: u32,
    filter: *mut c_void,
    instance: u32,
    min_width_distance_factor: f32,
}

impl Query {
    /// `coherent` tells Embree that the rays of a packet go together.
    pub(crate) fn new(coherent: bool) -> Self {
        let flag = |value: u32| if coherent { value } else { 0 };
        Self {
            arguments_4: Arguments4 {
                flags: flag(COHERENT_4),
                feature_mask: u32::MAX,
                context: null_mut(),
                filter: null_mut(),
                callback: null_mut(),
                min_width_distance_factor: 0.0,
            },
            context_3: Context3 {
                flags: flag(COHERENT_3),
                filter: null_mut(),
                instance: NONE,
                min_width_distance_factor: 0.0,
            },
        }
    }
}

/// At an address that every width's calls accept.
#[derive(Clone, Copy)]
#[repr(C, align(64))]
pub(crate) struct Aligned<T>(pub(crate) T);

/// RTCRay, RTCRay8, RTCRay16: the same members in the same order.
#[derive(Clone, Copy)]
#[repr(C)]
pub(crate) struct Rays<const N: usize> {
    pub(crate) origin: [[f32; N]; 3],
    pub(crate) t_near: [f32; N],
    pub(crate) direction: [[f32; N]; 3],
    pub(crate) time: [f32; N],
    pub(crate) t_far: [f32; N],
    pub(crate) mask: [u32; N],
    pub(crate) id: [u32; N],
    pub(crate) flags: [u32; N],
}

impl<const N: usize> Rays<N> {
    /// Rays from t = 0.
    #[inline(always)]
    pub(crate) fn new(origin: [[f32; N]; 3], direction: [[f32; N]; 3], t_far: [f32; N]) -> Self {
        Self {
            origin,
            t_near: [0.0; N],
            direction,
            time: [0.0; N],
            t_far,
            mask: [u32::MAX; N],
            id: [0; N],
            flags: [0; N],
        }
    }
}

/// RTCHit, RTCHit8, RTCHit16.
#[derive(Clone, Copy)]
#[repr(C)]
pub(crate) struct Hits<const N: usize> {
    /// Of any length, in the space of the geometry.
    pub(crate) normal: [[f32; N]; 3],
    pub(crate) u: [f32; N],
    pub(crate) v: [f32; N],
    pub(crate) primitive: [u32; N],
    pub(crate) geometry: [u32; N],
    pub(crate) instance: [u32; N],
    /// Only in versions with arrays of instances.
    pub(crate) instance_primitive: [u32; N],
}

/// RTCRayHit, RTCRayHit8, RTCRayHit16.
#[derive(Clone, Copy)]
#[repr(C)]
pub(crate) struct RayHits<const N: usize> {
    pub(crate) rays: Rays<N>,
    pub(crate) hits: Hits<N>,
}

impl<const N: usize> RayHits<N> {
    /// Rays that have met nothing yet.
    #[inline(always)]
    pub(crate) fn new(rays: Rays<N>) -> Self {
        Self {
            rays,
            hits: Hits {
                normal: [[0.0; N]; 3],
                u: [0.0; N],
                v: [0.0; N],
                primitive: [NONE; N],
                geometry: [NONE; N],
                instance: [NONE; N],
                instance_primitive: [NONE; N],
            },
        }
    }
}

/// Work that gains from wide vectors. `run` is to be `#[inline(always)]`, as is all that it calls.
pub(crate) trait Vectorised {
    /// Does it.
    fn run(self);
}

/// Does work with the vectors that this processor has: a renderer on Embree would be compiled for it.
pub(crate) fn vectorised(work: impl Vectorised) {
    #[cfg(target_arch = "x86_64")]
    if is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma") {
        // SAFETY: both features were found just now.
        return unsafe { with_avx2(work) };
    }
    work.run();
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn with_avx2(work: impl Vectorised) {
    work.run();
}
