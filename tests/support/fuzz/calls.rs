//! One entry per function of the header: a call with random parameters on the objects of a small world.

use std::ffi::{CString, c_char, c_void};
use std::ptr::{null, null_mut};

use welkin::capi::{
    abi, air::*, area::*, cloud_map::*, cloud_shadow::*, clouds::*, conditions::*, context::*, device::*,
    environment::*, fog_law::*, frame::*, ground::*, ground_grid::*, ground_texture::*, light::*, lightning::*,
    occluder::*, plan::*, query::*, radiance::*, rain::*, region::*, report::*, sea::*, sky::*, snow::*, snowpack::*,
    soil::*, stars::*, status::*, surface::*, terrain::*, texture::*, timeline::*, veil::*, view::*, vulkan::*,
    wind::*, wind_field::*, wind_grid::*, windscreen::*,
};

use crate::refusals::message;

use super::{
    dice::Dice,
    structs::{MOST, Struct},
    texts,
};

/// The result of a call as the host sees it.
pub struct Answer {
    pub status: wk_status,
    /// Errors in the output of a successful call: numbers that are not finite.
    pub faults: Vec<String>,
}

impl From<wk_status> for Answer {
    fn from(status: wk_status) -> Self {
        Self { status, faults: vec![] }
    }
}

/// Surface classes of the header, with holes, and occasionally one beyond them.
static CLASSES: [u8; 1024] = {
    let mut classes = [0; 1024];
    let mut i = 0;
    while i < 1024 {
        classes[i] = if i % 61 == 60 { 255 } else { (i % 7) as u8 };
        i += 1;
    }
    classes[1000] = 7;
    classes
};

/// Cells of a 32 x 32 tile. Mostly the tile may exist and the cells lie within it.
fn terrain_cells(d: &mut Dice) -> Struct {
    let mut cells = Struct::random(d, "wk_terrain_cells", 10);
    if !d.one_in(10) {
        cells.set("tile", [d.below(3) as i32 - 1, d.below(3) as i32 - 1]);
    }
    if !d.one_in(4) {
        cells.set("first_cell", [d.below(20) as u32, d.below(20) as u32]);
        cells.set("cells", [1 + d.below(12) as u32, 1 + d.below(12) as u32]);
        cells.set("height_stride", 0u32);
        cells.set("surface_class_stride", 0u32);
    }
    let torn = d.one_in(8);
    let height = |d: &mut Dice| if torn && d.one_in(300) { d.float() as f32 } else { d.unit() as f32 };
    cells.set_numbers("heights_m", (0..1024).map(|_| height(d)).collect());
    cells.set("height_count", if d.one_in(10) { d.below(1025) as u32 } else { 1024 });
    let classes = if d.one_in(2) { 0 } else { d.below(1025) as u32 };
    cells.set("surface_classes", if classes == 0 { null() } else { CLASSES.as_ptr() });
    cells.set("surface_class_count", classes);
    cells
}

/// A context that mostly has a tile (0, 0) of flat ground, because random calls alone rarely reach an existing tile.
fn tiled(d: &mut Dice, contexts: &[*mut wk_context]) -> *mut wk_context {
    let context = handle(d, contexts);
    if !d.one_in(3) && contexts.contains(&context) {
        let (mut terrain, mut tile) = (Struct::plain("wk_terrain"), Struct::plain("wk_terrain_cells"));
        terrain.set("tile_cells", 32u32);
        tile.set_numbers("heights_m", vec![1.0; 1024]);
        tile.set("height_count", 1024u32);
        unsafe {
            wk_context_set_terrain(context, terrain.ptr().cast());
            wk_context_set_terrain_tile(context, tile.ptr().cast());
        }
    }
    context
}

/// A pose of a bucket about the middle of tile (0, 0), in or above the ground, mostly later than all before.
fn soil_pose(d: &mut Dice, time_s: f64) -> Struct {
    let mut pose = Struct::random(d, "wk_soil_pose", 60);
    let (x, z) = (14.0 + 4.0 * d.unit(), 0.5 + d.unit());
    pose.set("time_s", if d.one_in(10) { d.float() } else { time_s + 1e-3 + 0.1 * d.unit() });
    if !d.one_in(8) {
        pose.set("edge_left_m", [x, 17.0, z]);
        pose.set("edge_right_m", [x, 15.0, z]);
        pose.set("upper_left_m", [x - 0.2, 17.0, z + 1.0]);
        pose.set("upper_right_m", [x - 0.2, 15.0, z + 1.0]);
        pose.set("facing", [1.0f64, 0.0, 0.2]);
        pose.set("load_n", if d.one_in(2) { 0.0 } else { 1e4 * d.unit() });
    }
    pose
}

/// A context that mostly has soil on its tile, and a tool in it.
fn dug(d: &mut Dice, w: &World) -> *mut wk_context {
    let context = tiled(d, &w.contexts);
    if !d.one_in(4) && w.contexts.contains(&context) {
        let (mut soil, mut shape) = (Struct::plain("wk_soil"), Struct::plain("wk_soil_tool"));
        let (mut pose, mut tool) = (soil_pose(d, w.time_s), 0);
        unsafe {
            wk_context_set_soil(context, soil.ptr().cast());
            wk_context_add_soil_tool(context, shape.ptr().cast(), pose.ptr().cast(), &mut tool);
        }
    }
    context
}

impl Answer {
    fn of(status: wk_status, out: &Struct) -> Self {
        let faults = if status == WK_OK { out.not_finite() } else { vec![] };
        // In empty space the visibility is infinite, as the header states.
        let faults = faults.into_iter().filter(|f| *f != "visibility_m");
        Self { status, faults: faults.map(|f| format!("{f} is not finite")).collect() }
    }
}

/// Live and dead objects, and the host's current time.
pub struct World {
    devices: Vec<*mut wk_device>,
    contexts: Vec<*mut wk_context>,
    views: Vec<*mut wk_view>,
    textures: Vec<*mut wk_texture>,
    saved: Vec<u8>,
    plan: Vec<u8>,
    time_s: f64,
    frame: u64,
    /// Whether the objects are destroyed with this world.
    owner: bool,
    /// Whether the first device survives this world.
    keeps_device: bool,
}

// SAFETY: handles are numbers; calls from several threads are the subject of the test.
unsafe impl Send for World {}

/// A random element; occasionally NULL or an invalid handle.
fn handle<T>(dice: &mut Dice, live: &[*mut T]) -> *mut T {
    if live.is_empty() || dice.one_in(60) {
        return dice.pick(&[null_mut(), 0x55 as *mut T, usize::MAX as *mut T]);
    }
    dice.pick(live)
}

/// A buffer large enough for most returned lists.
fn room<T: Copy>(zero: T) -> Vec<T> {
    vec![zero; 64]
}

/// The element size that a caller passes, rarely wrong.
fn size_of_element<T>(dice: &mut Dice) -> u32 {
    if dice.one_in(30) { dice.pick(&[0, 4, 8]) } else { size_of::<T>() as u32 }
}

impl World {
    /// Creates objects on a device of the backend that needs no GPU.
    pub fn on_noop() -> Self {
        let (mut device, mut desc) = (null_mut(), Struct::plain("wk_device_desc"));
        desc.set("backends", WK_BACKEND_NOOP);
        // SAFETY: pointers to live locals.
        assert_eq!(unsafe { wk_device_create(desc.ptr().cast(), &mut device) }, WK_OK);
        Self::on(device)
    }

    /// Creates objects on another world's device, which stays alive.
    pub fn beside(&self) -> Self {
        let mut new = Self::on(self.devices[0]);
        new.keeps_device = true;
        new
    }

    fn on(device: *mut wk_device) -> Self {
        let (mut context, mut view, mut texture) = (null_mut(), null_mut(), null_mut());
        let mut size = Struct::plain("wk_texture_desc");
        size.set("width", 16_u32);
        size.set("height", 8_u32);
        // A context with simulated snow on a terrain, because random calls would rarely create one.
        let (mut simulated, mut simulation) = (Struct::plain("wk_context_desc"), Struct::plain("wk_simulation_desc"));
        simulation.set("lying_snow_model", WK_LYING_SNOW_SIMULATED);
        simulated.set_struct("next", simulation);
        let mut grid = Struct::plain("wk_ground_grid");
        grid.set("height_count", 4_u32);
        grid.set_numbers("heights_m", vec![0.0_f32; 4]);
        // SAFETY: pointers to live locals.
        unsafe {
            assert_eq!(wk_context_create(device, simulated.ptr().cast(), &mut context), WK_OK);
            assert_eq!(wk_context_set_ground_grid(context, grid.ptr().cast()), WK_OK);
            assert_eq!(wk_view_create(context, null(), &mut view), WK_OK);
            assert_eq!(wk_texture_create(device, size.ptr().cast(), &mut texture), WK_OK);
        }
        Self {
            devices: vec![device],
            contexts: vec![context],
            views: vec![view],
            textures: vec![texture],
            saved: vec![],
            plan: vec![],
            time_s: 0.0,
            frame: 0,
            owner: true,
            keeps_device: false,
        }
    }

    /// The first context, which has simulated snow on a terrain.
    pub fn context(&self) -> *mut wk_context {
        self.contexts[0]
    }

    /// The first view.
    pub fn view(&self) -> *mut wk_view {
        self.views[0]
    }

    /// Another `World` with the same objects, for use by another thread.
    pub fn shared(&self) -> Self {
        Self {
            devices: self.devices.clone(),
            contexts: self.contexts.clone(),
            views: self.views.clone(),
            textures: self.textures.clone(),
            saved: self.saved.clone(),
            plan: self.plan.clone(),
            time_s: self.time_s,
            frame: self.frame,
            owner: false,
            keeps_device: false,
        }
    }

    /// Adopts objects that another thread created.
    pub fn adopt(&mut self, other: &Self) {
        self.devices.extend(&other.devices);
        self.contexts.extend(&other.contexts);
        self.views.extend(&other.views);
        self.textures.extend(&other.textures);
    }

    /// Loses the first device and returns its status.
    pub fn lose(&self) -> wk_status {
        abi::lose_in_next_call();
        // SAFETY: a live handle.
        unsafe { wk_device_get_status(self.devices[0]) }
    }

    /// A time: now, a little later, or anything.
    fn time(&self, dice: &mut Dice) -> f64 {
        match dice.below(8) {
            0 => dice.float(),
            1..4 => self.time_s + 60.0 * dice.unit(),
            _ => self.time_s,
        }
    }
}

impl Drop for World {
    fn drop(&mut self) {
        if !self.owner {
            return;
        }
        // SAFETY: children first; what is dead is refused.
        unsafe {
            self.views.iter().for_each(|&v| _ = wk_view_destroy(v));
            self.contexts.iter().for_each(|&c| _ = wk_context_destroy(c));
            self.textures.iter().for_each(|&t| _ = wk_texture_destroy(t));
            for &device in self.devices.iter().skip(usize::from(self.keeps_device)) {
                let status = wk_device_destroy(device);
                let gone = status == WK_OK || status == WK_ERROR_BAD_HANDLE;
                assert!(gone || std::thread::panicking(), "a device is left with status {status}: {}", message());
            }
        }
    }
}

/// A position, mostly near the origin.
fn position(dice: &mut Dice) -> [f64; 3] {
    std::array::from_fn(|_| if dice.one_in(6) { dice.float() } else { 200.0 * dice.unit() - 100.0 })
}

/// A direction, mostly not of unit length, because the first answer for a new air takes a second.
fn direction(dice: &mut Dice) -> [f64; 3] {
    if dice.one_in(4) {
        return dice.pick(&[[0.0, 0.0, 1.0], [0.6, 0.0, 0.8], [0.0, 0.8, -0.6]]);
    }
    std::array::from_fn(|_| if dice.one_in(6) { dice.float() } else { 2.0 * dice.unit() - 1.0 })
}

pub type Call = fn(&mut Dice, &mut World) -> Answer;

/// Calls a setter with a random struct, or with NULL.
fn set_one(dice: &mut Dice, name: &str, call: impl FnOnce(*mut c_void) -> wk_status) -> Answer {
    let mut value = Struct::random(dice, name, 6);
    call(if dice.one_in(30) { null_mut() } else { value.ptr() }).into()
}

/// Calls a setter with a random list.
fn set_list(dice: &mut Dice, name: &str, call: impl FnOnce(*mut c_void, u32, u32) -> wk_status) -> Answer {
    let (mut list, count) = Struct::random_list(dice, name, 12);
    let stride = if dice.one_in(30) { dice.pick(&[0, 3, 8]) } else { list.stride() };
    call(if dice.one_in(30) { null_mut() } else { list.ptr() }, count, stride).into()
}

/// Calls a query with room for one struct.
fn get(name: &str, call: impl FnOnce(*mut c_void) -> wk_status) -> Answer {
    let mut out = Struct::plain(name);
    let status = call(out.ptr());
    Answer::of(status, &out)
}

/// Checks a create call: on success, keeps the object; otherwise the out-parameter must not have been written.
fn made<T>(
    status: wk_status,
    out: *mut T,
    kept: &mut Vec<*mut T>,
    most: usize,
    destroy: impl FnOnce(*mut T),
) -> Answer {
    if status == WK_OK {
        if kept.len() < most {
            kept.push(out);
        } else {
            destroy(out);
        }
    }
    let faults =
        if (status == WK_OK) == out.is_null() { vec!["the out-parameter does not agree".into()] } else { vec![] };
    Answer { status, faults }
}

/// Destroys any object but the first. It may stay in the list as a dead handle.
fn destroy<T>(dice: &mut Dice, live: &mut Vec<*mut T>, call: impl FnOnce(*mut T) -> wk_status) -> Answer {
    if live.len() < 2 {
        return WK_OK.into();
    }
    let at = 1 + dice.below(live.len() - 1);
    let status = call(live[at]);
    if status == WK_OK && dice.one_in(2) {
        live.swap_remove(at);
    }
    status.into()
}

fn weather(dice: &mut Dice) -> Struct {
    let rarity = dice.pick(&[6, 25, 25, 25]);
    let mut weather = Struct::random(dice, "wk_weather", rarity);
    if dice.one_in(2) {
        let (layers, count) = Struct::random_list(dice, "wk_cloud_layer", 20);
        weather.set("cloud_count", count);
        weather.set("cloud_stride", layers.stride());
        weather.set_struct("clouds", layers);
    }
    if dice.one_in(6) {
        weather.set_struct("next", Struct::random(dice, "wk_weather_overrides", 6));
    }
    weather
}

fn frame(dice: &mut Dice, world: &mut World) -> Struct {
    let mut frame = Struct::random(dice, "wk_frame", 40);
    if !dice.one_in(4) {
        world.frame += 1;
    }
    frame.set("frame_id", world.frame);
    if dice.one_in(2) {
        let mut target = Struct::plain("wk_own_target");
        target.set("color", handle(dice, &world.textures));
        for field in ["depth", "mask", "surface_classes", "normals"] {
            if dice.one_in(3) {
                target.set(field, handle(dice, &world.textures));
            }
        }
        frame.set_struct("target", target);
    }
    frame
}

/// One entry per function of the header, except initialisers and functions for hosts' devices and windows, which have
/// tests of their own.
pub const CALLS: &[(&str, Call)] = &[
    ("wk_version", |_, _| {
        let (mut a, mut b, mut c) = (0, 0, 0);
        unsafe { wk_version(&mut a, &mut b, &mut c) }.into()
    }),
    ("wk_device_create", |d, w| {
        let mut out = null_mut();
        let mut desc = Struct::random(d, "wk_device_desc", 20);
        // Only the backend without a driver: other tests cover the others.
        desc.set("backends", WK_BACKEND_NOOP);
        let status = unsafe { wk_device_create(desc.ptr().cast(), &mut out) };
        made(status, out, &mut w.devices, 2, |x| _ = unsafe { wk_device_destroy(x) })
    }),
    ("wk_device_destroy", |d, w| destroy(d, &mut w.devices, |x| unsafe { wk_device_destroy(x) })),
    ("wk_device_get_status", |d, w| unsafe { wk_device_get_status(handle(d, &w.devices)) }.into()),
    ("wk_device_get_caps", |d, w| {
        let device = handle(d, &w.devices);
        get("wk_caps", |p| unsafe { wk_device_get_caps(device, p.cast()) })
    }),
    ("wk_device_forget_vulkan_image", |d, w| {
        unsafe { wk_device_forget_vulkan_image(handle(d, &w.devices), d.whole()) }.into()
    }),
    ("wk_texture_create", |d, w| {
        let (device, mut out) = (handle(d, &w.devices), null_mut());
        let mut desc = Struct::random(d, "wk_texture_desc", 4);
        desc.set("width", 1 + d.below(16) as u32);
        if d.one_in(3) {
            desc.set("height", d.whole() as u32 & 0x3ff);
        }
        let status = unsafe { wk_texture_create(device, desc.ptr().cast(), &mut out) };
        made(status, out, &mut w.textures, 4, |x| _ = unsafe { wk_texture_destroy(x) })
    }),
    ("wk_texture_destroy", |d, w| destroy(d, &mut w.textures, |x| unsafe { wk_texture_destroy(x) })),
    ("wk_texture_write", |d, w| {
        let data = vec![0_u8; 8192];
        let (size, row) = (if d.one_in(3) { d.below(8193) } else { 8192 }, d.pick(&[0, 1, 64, 128, 256, u32::MAX]));
        unsafe { wk_texture_write(handle(d, &w.textures), data.as_ptr().cast(), size, row) }.into()
    }),
    ("wk_texture_read", |d, w| {
        let mut data = vec![0_u8; 8192];
        let (size, row) = (if d.one_in(3) { d.below(8193) } else { 8192 }, d.pick(&[0, 1, 64, 128, 256, u32::MAX]));
        unsafe { wk_texture_read(handle(d, &w.textures), data.as_mut_ptr().cast(), size, row) }.into()
    }),
    ("wk_context_create", |d, w| {
        let (device, mut out) = (handle(d, &w.devices), null_mut());
        let mut desc = Struct::random(d, "wk_context_desc", 12);
        if d.one_in(3) {
            desc.set_text("planet_toml", &texts::planet(d));
        }
        if d.one_in(3) {
            let name = d.pick(&["wk_sky_settings", "wk_simulation_desc"]);
            desc.set_struct("next", Struct::random(d, name, 5));
        }
        let status = unsafe { wk_context_create(device, desc.ptr().cast(), &mut out) };
        made(status, out, &mut w.contexts, 3, |x| _ = unsafe { wk_context_destroy(x) })
    }),
    ("wk_context_destroy", |d, w| destroy(d, &mut w.contexts, |x| unsafe { wk_context_destroy(x) })),
    ("wk_context_build_sky", |d, w| {
        unsafe extern "C" fn stop(_: *mut c_void, _: f64) -> i32 {
            0
        }
        // A complete build takes seconds of processor time, so each build is started and stopped.
        unsafe { wk_context_build_sky(handle(d, &w.contexts), Some(stop), null_mut()) }.into()
    }),
    ("wk_context_set_weather", |d, w| {
        let (mut weather, start) = (weather(d), w.time(d));
        let transition = if d.one_in(4) { d.float() } else { 100.0 * d.unit() };
        unsafe { wk_context_set_weather(handle(d, &w.contexts), weather.ptr().cast(), start, transition) }.into()
    }),
    ("wk_context_update", |d, w| {
        let next = if d.one_in(10) { d.float() } else { w.time_s + 2.0 * d.unit() };
        let status = unsafe { wk_context_update(handle(d, &w.contexts), next) };
        if status == WK_OK {
            w.time_s = next;
        }
        status.into()
    }),
    ("wk_context_get_state_time", |d, w| {
        let mut state_time_s = 0.0;
        let status = unsafe { wk_context_get_state_time(handle(d, &w.contexts), &mut state_time_s) };
        assert!(state_time_s.is_finite());
        status.into()
    }),
    ("wk_context_set_clock", |d, w| {
        let utc = if d.one_in(2) { d.float() } else { 1.7e9 * d.unit() };
        unsafe { wk_context_set_clock(handle(d, &w.contexts), utc, w.time(d)) }.into()
    }),
    ("wk_utc_from_calendar", |d, _| {
        let mut out = 0.0;
        let status = unsafe {
            let n = |d: &mut Dice| d.whole() as u32;
            wk_utc_from_calendar(1900 + d.whole() as i32, n(d), n(d), n(d), n(d), d.float(), &mut out)
        };
        status.into()
    }),
    ("wk_context_set_lightning", |d, w| {
        let context = handle(d, &w.contexts);
        set_one(d, "wk_lightning", |p| unsafe { wk_context_set_lightning(context, p.cast()) })
    }),
    ("wk_context_trigger_flash", |d, w| {
        let context = handle(d, &w.contexts);
        set_one(d, "wk_flash_trigger", |p| unsafe { wk_context_trigger_flash(context, p.cast()) })
    }),
    ("wk_context_get_flashes", |d, w| {
        let mut flashes = room(unsafe { std::mem::zeroed::<wk_flash>() });
        let (context, at, from, mut count) = (handle(d, &w.contexts), position(d), w.time(d), 0);
        let (until, far) = (from + if d.one_in(4) { d.float() } else { 60.0 * d.unit() }, 6e4 * d.unit());
        let (most, size) = (d.below(65) as u32, size_of_element::<wk_flash>(d));
        let to = flashes.as_mut_ptr();
        unsafe { wk_context_get_flashes(context, &at, from, until, far, to, most, size, &mut count) }.into()
    }),
    ("wk_context_get_flash_light", |d, w| {
        let (context, at, time) = (handle(d, &w.contexts), position(d), w.time(d));
        let exposure = if d.one_in(4) { d.float() } else { d.unit() };
        get("wk_flash_light", |p| unsafe { wk_context_get_flash_light(context, &at, time, exposure, p.cast()) })
    }),
    ("wk_context_set_sea", |d, w| {
        let mut sea = Struct::random(d, "wk_sea", 12);
        sea.set("has", d.pick(&[0, 0x2, 0x6, 0x1f, 0x81, 0x7c0, 0x790]));
        if d.one_in(2) {
            let (swells, count) = Struct::random_list(d, "wk_sea_swell", 20);
            sea.set("swell_count", count);
            sea.set("swell_stride", swells.stride());
            sea.set_struct("swells", swells);
        }
        if d.one_in(2) {
            let (mut waves, count) = Struct::random_list(d, "wk_sea_wave", 20);
            waves.set("period_s", 5.0 * d.unit());
            sea.set("wave_count", count);
            sea.set("wave_stride", waves.stride());
            sea.set_struct("waves", waves);
        }
        let sea = if d.one_in(8) { null() } else { sea.ptr().cast_const().cast() };
        unsafe { wk_context_set_sea(handle(d, &w.contexts), sea) }.into()
    }),
    ("wk_context_set_sea_hulls", |d, w| {
        let (mut hulls, count) = Struct::random_list(d, "wk_sea_hull", 20);
        if d.one_in(2) {
            hulls.set("speed_m_s", 20.0 * d.unit());
            hulls.set("at_s", w.time(d));
        }
        let (context, stride) = (handle(d, &w.contexts), hulls.stride());
        unsafe { wk_context_set_sea_hulls(context, hulls.ptr().cast(), count.min(1), stride) }.into()
    }),
    ("wk_context_set_sea_regions", |d, w| {
        let corners: [[f64; 2]; 4] =
            [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|c| c.map(|v| 50.0 * v + 30.0 * d.unit()));
        let (mut regions, count) = Struct::random_list(d, "wk_sea_region", 20);
        regions.set("corners_m", corners.as_ptr());
        regions.set("corner_count", if d.one_in(8) { d.below(5) as u32 } else { 4 });
        let (context, stride) = (handle(d, &w.contexts), regions.stride());
        unsafe { wk_context_set_sea_regions(context, regions.ptr().cast(), count.min(1), stride) }.into()
    }),
    ("wk_context_get_sea_at", |d, w| {
        let places: [_; MOST as usize] = std::array::from_fn(|_| position(d));
        let mut points = room(unsafe { std::mem::zeroed::<wk_sea_point>() });
        let (context, time, count) = (handle(d, &w.contexts), w.time(d), d.below(MOST as usize + 1) as u32);
        let shortest = if d.one_in(4) { d.float() } else { 3.0 * d.unit() };
        let (size, to) = (size_of_element::<wk_sea_point>(d), points.as_mut_ptr());
        let status = unsafe { wk_context_get_sea_at(context, places.as_ptr(), count, 24, time, shortest, to, size) };
        let finite = |p: &wk_sea_point| p.height_m.is_finite() && p.normal.iter().all(|v| v.is_finite());
        let is_whole = points.iter().all(finite);
        Answer { status, faults: if is_whole { vec![] } else { vec!["a point is not finite".into()] } }
    }),
    ("wk_context_get_sea_state", |d, w| {
        let (context, time) = (handle(d, &w.contexts), w.time(d));
        // Few sequences set a sea in this very context before.
        let mut sea = unsafe { std::mem::zeroed::<wk_sea>() };
        if d.one_in(2) {
            unsafe { wk_sea_init(&mut sea, size_of::<wk_sea>() as u32) };
            unsafe { wk_context_set_sea(context, &sea) };
        }
        get("wk_sea_state", |p| unsafe { wk_context_get_sea_state(context, time, p.cast()) })
    }),
    ("wk_context_set_stars", |d, w| {
        let context = handle(d, &w.contexts);
        set_one(d, "wk_stars", |p| unsafe { wk_context_set_stars(context, p.cast()) })
    }),
    ("wk_context_set_sun", |d, w| {
        let context = handle(d, &w.contexts);
        set_one(d, "wk_given_direction", |p| unsafe { wk_context_set_sun(context, p.cast()) })
    }),
    ("wk_context_set_moon", |d, w| {
        let context = handle(d, &w.contexts);
        set_one(d, "wk_given_direction", |p| unsafe { wk_context_set_moon(context, p.cast()) })
    }),
    ("wk_context_set_exposure", |d, w| {
        unsafe { wk_context_set_exposure(handle(d, &w.contexts), d.below(4) as u32, d.float()) }.into()
    }),
    ("wk_context_set_tone_curve", |d, w| {
        unsafe { wk_context_set_tone_curve(handle(d, &w.contexts), d.below(4) as u32) }.into()
    }),
    ("wk_context_set_planet", |d, w| {
        let text = CString::new(texts::planet(d).replace('\0', " ")).unwrap();
        let text = if d.one_in(4) { null() } else { text.as_ptr() };
        unsafe { wk_context_set_planet(handle(d, &w.contexts), text) }.into()
    }),
    ("wk_context_set_sky_settings", |d, w| {
        let context = handle(d, &w.contexts);
        set_one(d, "wk_sky_settings", |p| unsafe { wk_context_set_sky_settings(context, p.cast()) })
    }),
    ("wk_context_set_fog_law", |d, w| {
        let context = handle(d, &w.contexts);
        set_one(d, "wk_fog_law", |p| unsafe { wk_context_set_fog_law(context, p.cast()) })
    }),
    ("wk_fog_law_cull_distance", |d, _| {
        let mut out = 0.0;
        set_one(d, "wk_fog_law", |p| unsafe { wk_fog_law_cull_distance(p.cast(), &mut out) })
    }),
    ("wk_visibility_cull_distance", |d, _| {
        let mut out = 0.0;
        unsafe { wk_visibility_cull_distance(d.float(), &mut out) }.into()
    }),
    ("wk_context_set_lights", |d, w| {
        let context = handle(d, &w.contexts);
        set_list(d, "wk_light", |p, n, s| unsafe { wk_context_set_lights(context, p.cast(), n, s) })
    }),
    ("wk_context_set_rain_areas", |d, w| {
        let context = handle(d, &w.contexts);
        set_list(d, "wk_rain_area", |p, n, s| unsafe { wk_context_set_rain_areas(context, p.cast(), n, s) })
    }),
    ("wk_context_set_weather_regions", |d, w| {
        let context = handle(d, &w.contexts);
        let (mut list, count) = Struct::random_list(d, "wk_weather_region", 30);
        if d.one_in(2) {
            list.set_struct("weather", weather(d));
        }
        unsafe { wk_context_set_weather_regions(context, list.ptr().cast(), count, list.stride()) }.into()
    }),
    ("wk_context_set_shelters", |d, w| {
        let context = handle(d, &w.contexts);
        set_list(d, "wk_shelter", |p, n, s| unsafe { wk_context_set_shelters(context, p.cast(), n, s) })
    }),
    ("wk_context_set_occluder_maps", |d, w| {
        let context = handle(d, &w.contexts);
        set_list(d, "wk_occluder_map", |p, n, s| unsafe { wk_context_set_occluder_maps(context, p.cast(), n, s) })
    }),
    ("wk_context_set_wind_field", |d, w| {
        let mut field = Struct::random(d, "wk_wind_field", 10);
        let cells: [u32; 3] = std::array::from_fn(|_| 6 + d.below(6) as u32);
        field.set("cells", cells);
        field.set("most_iterations", d.below(6) as u32);
        let start_s = 20.0 * d.unit();
        unsafe { wk_context_set_wind_field(handle(d, &w.contexts), field.ptr().cast(), start_s) }.into()
    }),
    ("wk_context_get_wind_field_report", |d, w| {
        let context = handle(d, &w.contexts);
        get("wk_wind_field_report", |p| unsafe { wk_context_get_wind_field_report(context, p.cast()) })
    }),
    ("wk_context_set_wind_grid", |d, w| {
        let mut grid = Struct::random(d, "wk_wind_grid", 10);
        let nodes: [u32; 3] = std::array::from_fn(|_| 2 + d.below(3) as u32);
        grid.set("nodes", nodes);
        let count = if d.one_in(10) { d.below(400) as u32 } else { nodes.iter().product::<u32>() };
        grid.set("velocity_count", count);
        grid.set_numbers("velocities_m_s", (0..1200).map(|_| 20.0 * d.unit() as f32).collect());
        unsafe { wk_context_set_wind_grid(handle(d, &w.contexts), grid.ptr().cast()) }.into()
    }),
    ("wk_context_set_ground_grid", |d, w| {
        let mut grid = Struct::random(d, "wk_ground_grid", 10);
        let nodes: [u32; 2] = std::array::from_fn(|_| 2 + d.below(12) as u32);
        grid.set("nodes", nodes);
        let count = if d.one_in(10) { d.below(400) as u32 } else { nodes.iter().product::<u32>() };
        grid.set("height_count", count);
        grid.set_numbers(
            "heights_m",
            (0..400).map(|_| if d.one_in(300) { d.float() as f32 } else { d.unit() as f32 }).collect(),
        );
        // Classes of the header and one beyond it, for a number of cells that may be smaller or larger than the number
        // of heights.
        let classes: Vec<u8> = (0..400).map(|i| if d.one_in(2000) { 7 } else { i as u8 % 7 }).collect();
        if d.one_in(2) {
            grid.set("surface_classes", classes.as_ptr());
            grid.set("surface_class_count", if d.one_in(10) { d.below(400) as u32 } else { count });
        }
        unsafe { wk_context_set_ground_grid(handle(d, &w.contexts), grid.ptr().cast()) }.into()
    }),
    ("wk_context_set_cloud_map", |d, w| {
        let mut map = Struct::random(d, "wk_cloud_map", 10);
        let cells: [u32; 2] = std::array::from_fn(|_| 1 + d.below(9) as u32);
        map.set("cells", cells);
        map.set("cover_count", if d.one_in(10) { d.below(100) as u32 } else { cells.iter().product::<u32>() });
        map.set_numbers(
            "cover",
            (0..100).map(|_| if d.one_in(300) { d.float() as f32 } else { d.unit() as f32 }).collect(),
        );
        unsafe { wk_context_set_cloud_map(handle(d, &w.contexts), map.ptr().cast()) }.into()
    }),
    ("wk_context_set_terrain", |d, w| {
        let mut terrain = Struct::random(d, "wk_terrain", 10);
        if !d.one_in(5) {
            terrain.set("tile_cells", 32u32);
            terrain.set("cell_m", 1.0f64);
        }
        unsafe { wk_context_set_terrain(handle(d, &w.contexts), terrain.ptr().cast()) }.into()
    }),
    ("wk_context_set_terrain_drawing", |d, w| {
        let mut drawing = Struct::random(d, "wk_terrain_drawing", 10);
        unsafe { wk_context_set_terrain_drawing(handle(d, &w.contexts), drawing.ptr().cast()) }.into()
    }),
    ("wk_context_set_terrain_tile", |d, w| {
        let mut cells = terrain_cells(d);
        if !d.one_in(5) {
            cells.set("cells", [0u32, 0]);
            cells.set("first_cell", [0u32, 0]);
            cells.set("height_stride", 0u32);
        }
        unsafe { wk_context_set_terrain_tile(handle(d, &w.contexts), cells.ptr().cast()) }.into()
    }),
    ("wk_context_update_terrain", |d, w| {
        let mut cells = terrain_cells(d);
        unsafe { wk_context_update_terrain(tiled(d, &w.contexts), cells.ptr().cast()) }.into()
    }),
    ("wk_context_remove_terrain_tile", |d, w| {
        let (east, north) = (d.below(3) as i32 - 1, d.below(3) as i32 - 1);
        unsafe { wk_context_remove_terrain_tile(tiled(d, &w.contexts), east, north) }.into()
    }),
    ("wk_context_set_soil", |d, w| {
        let mut soil = Struct::random(d, "wk_soil", 10);
        let (mut kinds, count) = Struct::random_list(d, "wk_soil_kind", 20);
        let (tops, layers) = ([0.0, 0.3, d.unit()], [d.below(9) as u32, 4, 3]);
        if d.one_in(2) {
            soil.set("own_kind_count", count);
            soil.set("own_kind_stride", kinds.stride());
            soil.set("own_kinds", kinds.ptr());
            soil.set("horizon_count", d.below(4) as u32);
            soil.set("horizon_tops_m", tops.as_ptr());
            soil.set("horizon_kinds", layers.as_ptr());
        }
        unsafe { wk_context_set_soil(tiled(d, &w.contexts), soil.ptr().cast()) }.into()
    }),
    ("wk_context_add_soil_tool", |d, w| {
        let (context, mut shape, mut tool) = (dug(d, w), Struct::random(d, "wk_soil_tool", 20), 0);
        shape.set("shape", d.below(6) as u32);
        let mut pose = soil_pose(d, w.time_s);
        unsafe { wk_context_add_soil_tool(context, shape.ptr().cast(), pose.ptr().cast(), &mut tool) }.into()
    }),
    ("wk_context_move_soil_tool", |d, w| {
        let (context, mut pose) = (dug(d, w), soil_pose(d, w.time_s + 0.2));
        unsafe { wk_context_move_soil_tool(context, d.below(4) as u32, pose.ptr().cast()) }.into()
    }),
    ("wk_context_end_soil_tool", |d, w| unsafe { wk_context_end_soil_tool(dug(d, w), d.below(4) as u32) }.into()),
    ("wk_context_get_soil_tool", |d, w| {
        let (context, tool) = (dug(d, w), d.below(4) as u32);
        get("wk_soil_tool_report", |p| unsafe { wk_context_get_soil_tool(context, tool, p.cast()) })
    }),
    ("wk_context_get_soil_resistance", |d, w| {
        let (context, tool, mut blade) = (dug(d, w), d.below(4) as u32, Struct::random(d, "wk_soil_blade", 10));
        let blade = blade.ptr().cast();
        get("wk_cutting_force", |p| unsafe { wk_context_get_soil_resistance(context, tool, blade, p.cast()) })
    }),
    ("wk_context_bring_soil", |d, w| {
        let (context, kind, mass) =
            (dug(d, w), d.below(9) as u32, if d.one_in(5) { d.float() } else { 100.0 * d.unit() });
        let at = if d.one_in(2) { position(d) } else { [16.0 * d.unit(), 16.0 * d.unit(), 0.0] };
        unsafe { wk_context_bring_soil(context, &at, kind, mass, null_mut()) }.into()
    }),
    ("wk_context_get_soil_points", |d, w| {
        let (context, at, mut points) = (dug(d, w), position(d), [unsafe { std::mem::zeroed() }; 1]);
        let size = size_of_element::<wk_soil_point>(d);
        unsafe { wk_context_get_soil_points(context, &at, 1, 24, points.as_mut_ptr(), size) }.into()
    }),
    ("wk_context_get_soil_changes", |d, w| {
        let mut changes = room(unsafe { std::mem::zeroed::<wk_soil_change>() });
        let (context, since, mut count) = (dug(d, w), d.below(20) as u64, 0);
        let size = size_of_element::<wk_soil_change>(d);
        let most = changes.len() as u32;
        unsafe { wk_context_get_soil_changes(context, since, changes.as_mut_ptr(), most, size, &mut count) }.into()
    }),
    ("wk_context_get_soil_cells", |d, w| {
        let mut points = vec![unsafe { std::mem::zeroed::<wk_soil_point>() }; 1024];
        let (context, tile) = (dug(d, w), [d.below(2) as i32, 0]);
        let [first, size] = [0, 1].map(|least| [d.below(20) as u32 + least, d.below(20) as u32 + least]);
        let element = size_of_element::<wk_soil_point>(d);
        unsafe { wk_context_get_soil_cells(context, &tile, &first, &size, points.as_mut_ptr(), 1024, element) }.into()
    }),
    ("wk_context_get_soil_balance", |d, w| {
        let context = dug(d, w);
        get("wk_soil_balance", |p| unsafe { wk_context_get_soil_balance(context, p.cast()) })
    }),
    ("wk_context_get_terrain_revision", |d, w| {
        let mut revision = 0;
        unsafe { wk_context_get_terrain_revision(handle(d, &w.contexts), &mut revision) }.into()
    }),
    ("wk_context_get_terrain_at", |d, w| {
        let places: [_; MOST as usize] = std::array::from_fn(|_| position(d));
        let mut points = room(unsafe { std::mem::zeroed::<wk_terrain_point>() });
        let (context, count) = (handle(d, &w.contexts), d.below(MOST as usize + 1) as u32);
        let size = size_of_element::<wk_terrain_point>(d);
        unsafe { wk_context_get_terrain_at(context, places.as_ptr(), count, 24, points.as_mut_ptr(), size) }.into()
    }),
    ("wk_context_get_terrain_water", |d, w| {
        let mut cells = vec![unsafe { std::mem::zeroed::<wk_ground_cell>() }; 1024];
        let (context, mut revision) = (tiled(d, &w.contexts), 0);
        let most = if d.one_in(2) { 1024 } else { d.below(1025) as u32 };
        let size = size_of_element::<wk_ground_cell>(d);
        let beside = |d: &mut Dice| if d.one_in(2) { 0 } else { d.below(3) as i32 - 1 };
        let (east, north) = (beside(d), beside(d));
        unsafe { wk_context_get_terrain_water(context, east, north, cells.as_mut_ptr(), most, size, &mut revision) }
            .into()
    }),
    ("wk_context_set_cloud_model", |d, w| {
        let model = d.below(3) as u32;
        unsafe { wk_context_set_cloud_model(handle(d, &w.contexts), model) }.into()
    }),
    ("wk_context_set_default_surface_class", |d, w| {
        let class = d.below(8) as u32;
        unsafe { wk_context_set_default_surface_class(handle(d, &w.contexts), class) }.into()
    }),
    ("wk_context_save", |d, w| {
        let (context, mut size) = (handle(d, &w.contexts), 0);
        let mut buffer = vec![0_u8; if d.one_in(6) { d.below(200) } else { 1 << 18 }];
        let status = unsafe { wk_context_save(context, buffer.as_mut_ptr().cast(), buffer.len(), &mut size) };
        if status == WK_OK {
            buffer.truncate(size);
            w.saved = buffer;
        }
        status.into()
    }),
    ("wk_context_load", |d, w| {
        let mut state = w.saved.clone();
        if !d.one_in(3) {
            texts::damage(d, &mut state);
        }
        unsafe { wk_context_load(handle(d, &w.contexts), state.as_ptr().cast(), state.len()) }.into()
    }),
    ("wk_context_state_hash", |d, w| {
        let mut hash = 0;
        unsafe { wk_context_state_hash(handle(d, &w.contexts), &mut hash) }.into()
    }),
    ("wk_context_get_conditions", |d, w| {
        let (context, at, time) = (handle(d, &w.contexts), position(d), w.time(d));
        get("wk_conditions", |p| unsafe { wk_context_get_conditions(context, &at, time, p.cast()) })
    }),
    ("wk_context_get_air", |d, w| {
        let (context, at, time) = (handle(d, &w.contexts), position(d), w.time(d));
        get("wk_air", |p| unsafe { wk_context_get_air(context, &at, time, p.cast()) })
    }),
    ("wk_context_get_wind_at", |d, w| {
        let (context, at, time) = (handle(d, &w.contexts), position(d), w.time(d));
        get("wk_wind", |p| unsafe { wk_context_get_wind_at(context, &at, time, p.cast()) })
    }),
    ("wk_context_get_rainfall_at", |d, w| {
        let (context, at, time) = (handle(d, &w.contexts), position(d), w.time(d));
        get("wk_rainfall", |p| unsafe { wk_context_get_rainfall_at(context, &at, time, p.cast()) })
    }),
    ("wk_context_get_rain_on_at", |d, w| {
        let (mut surfaces, count) = Struct::random_list(d, "wk_rain_surface", 8);
        let (size, out_size) = (surfaces.size(), size_of_element::<wk_rain_on>(d));
        let mut on = room(unsafe { std::mem::zeroed::<wk_rain_on>() });
        let (context, time) = (handle(d, &w.contexts), w.time(d));
        unsafe {
            wk_context_get_rain_on_at(context, surfaces.ptr().cast(), count, size, time, on.as_mut_ptr(), out_size)
                .into()
        }
    }),
    ("wk_context_get_cloud_slabs", |d, w| {
        let mut slabs = room(unsafe { std::mem::zeroed::<wk_cloud_slab>() });
        let (context, at, time, mut count) = (handle(d, &w.contexts), position(d), w.time(d), 0);
        let (most, size) = (d.below(65) as u32, size_of_element::<wk_cloud_slab>(d));
        unsafe { wk_context_get_cloud_slabs(context, &at, time, slabs.as_mut_ptr(), most, size, &mut count) }.into()
    }),
    ("wk_context_get_sun", |d, w| {
        let (context, at) = (handle(d, &w.contexts), position(d));
        get("wk_celestial", |p| unsafe { wk_context_get_sun(context, &at, p.cast()) })
    }),
    ("wk_context_get_sun_share", |d, w| {
        let (context, at, time) = (handle(d, &w.contexts), position(d), w.time(d));
        let mut share = 0.0;
        unsafe { wk_context_get_sun_share(context, &at, time, &mut share) }.into()
    }),
    ("wk_context_get_sun_at", |d, w| {
        let (context, at, time) = (handle(d, &w.contexts), position(d), w.time(d));
        get("wk_celestial", |p| unsafe { wk_context_get_sun_at(context, &at, time, p.cast()) })
    }),
    ("wk_context_get_moon", |d, w| {
        let (context, at) = (handle(d, &w.contexts), position(d));
        get("wk_celestial", |p| unsafe { wk_context_get_moon(context, &at, p.cast()) })
    }),
    ("wk_context_get_moon_at", |d, w| {
        let (context, at, time) = (handle(d, &w.contexts), position(d), w.time(d));
        get("wk_celestial", |p| unsafe { wk_context_get_moon_at(context, &at, time, p.cast()) })
    }),
    ("wk_context_get_light", |d, w| {
        let (context, at) = (handle(d, &w.contexts), position(d));
        get("wk_ground_light", |p| unsafe {
            wk_context_get_light(context, &at, 1, 24, p.cast(), size_of::<wk_ground_light>() as u32)
        })
    }),
    ("wk_context_get_light_at", |d, w| {
        let places: [_; MOST as usize] = std::array::from_fn(|_| position(d));
        let mut lights = room(unsafe { std::mem::zeroed::<wk_ground_light>() });
        let (context, time, count) = (handle(d, &w.contexts), w.time(d), d.below(MOST as usize + 1) as u32);
        let size = size_of_element::<wk_ground_light>(d);
        unsafe { wk_context_get_light_at(context, places.as_ptr(), count, 24, time, lights.as_mut_ptr(), size) }.into()
    }),
    ("wk_context_get_between", |d, w| {
        let (mut segment, context) = (Struct::random(d, "wk_segment", 3), handle(d, &w.contexts));
        get("wk_between", |p| unsafe {
            wk_context_get_between(
                context,
                segment.ptr().cast(),
                1,
                segment.size(),
                p.cast(),
                size_of::<wk_between>() as u32,
            )
        })
    }),
    ("wk_context_get_between_at", |d, w| {
        let (mut segment, context, time) = (Struct::random(d, "wk_segment", 3), handle(d, &w.contexts), w.time(d));
        let size = size_of::<wk_between>() as u32;
        get("wk_between", |p| unsafe {
            wk_context_get_between_at(context, segment.ptr().cast(), 1, segment.size(), time, p.cast(), size)
        })
    }),
    ("wk_context_get_sky_radiance", |d, w| {
        let (context, at, toward) = (handle(d, &w.contexts), position(d), direction(d));
        get("wk_sky_radiance", |p| unsafe {
            let size = size_of::<wk_sky_radiance>() as u32;
            wk_context_get_sky_radiance(context, &at, &toward, 1, 24, p.cast(), size)
        })
    }),
    ("wk_context_get_sky_radiance_at", |d, w| {
        let toward: [_; MOST as usize] = std::array::from_fn(|_| direction(d));
        let mut radiances = room(unsafe { std::mem::zeroed::<wk_sky_radiance>() });
        let (context, at, time) = (handle(d, &w.contexts), position(d), w.time(d));
        let (count, size) = (d.below(MOST as usize + 1) as u32, size_of_element::<wk_sky_radiance>(d));
        let (list, room) = (toward.as_ptr(), radiances.as_mut_ptr());
        unsafe { wk_context_get_sky_radiance_at(context, &at, list, count, 24, time, room, size) }.into()
    }),
    ("wk_context_get_frame_light", |d, w| {
        let (context, mut frame) = (handle(d, &w.contexts), Struct::random(d, "wk_frame", 20));
        get("wk_frame_light", |p| unsafe { wk_context_get_frame_light(context, frame.ptr().cast(), p.cast()) })
    }),
    ("wk_context_get_ambient", |d, w| {
        let (context, at) = (handle(d, &w.contexts), position(d));
        get("wk_ambient", |p| unsafe { wk_context_get_ambient(context, &at, p.cast()) })
    }),
    ("wk_context_get_ambient_at", |d, w| {
        let (context, at, time) = (handle(d, &w.contexts), position(d), w.time(d));
        get("wk_ambient", |p| unsafe { wk_context_get_ambient_at(context, &at, time, p.cast()) })
    }),
    ("wk_context_get_visibility_at", |d, w| {
        let (context, at, toward, time) = (handle(d, &w.contexts), position(d), direction(d), w.time(d));
        let mut out = 0.0;
        unsafe { wk_context_get_visibility_at(context, &at, &toward, time, &mut out) }.into()
    }),
    ("wk_context_get_limiting_magnitude_at", |d, w| {
        let (context, at, time) = (handle(d, &w.contexts), position(d), w.time(d));
        let mut out = 0.0;
        unsafe { wk_context_get_limiting_magnitude_at(context, &at, time, &mut out) }.into()
    }),
    ("wk_context_get_ground", |d, w| {
        let (context, at) = (handle(d, &w.contexts), position(d));
        get("wk_ground", |p| unsafe { wk_context_get_ground(context, &at, p.cast()) })
    }),
    ("wk_context_get_lying_snow", |d, w| {
        let (context, at, mut snow) = (handle(d, &w.contexts), position(d), [unsafe { std::mem::zeroed() }; 1]);
        let size = size_of_element::<wk_lying_snow>(d);
        unsafe { wk_context_get_lying_snow(context, &at, 1, 24, snow.as_mut_ptr(), size) }.into()
    }),
    ("wk_context_take_snow", |d, w| {
        let (mut strip, path) = (Struct::random(d, "wk_snow_strip", 10), [position(d), position(d)]);
        strip.set("points_m", path.as_ptr());
        strip.set("point_count", 2u32);
        let mut mass = 0.0;
        unsafe { wk_context_take_snow(handle(d, &w.contexts), strip.ptr().cast(), d.unit(), &mut mass) }.into()
    }),
    ("wk_context_press_snow", |d, w| {
        let (mut strip, path) = (Struct::random(d, "wk_snow_strip", 10), [position(d), position(d)]);
        strip.set("points_m", path.as_ptr());
        strip.set("point_count", 2u32);
        unsafe { wk_context_press_snow(handle(d, &w.contexts), strip.ptr().cast()) }.into()
    }),
    ("wk_context_accumulate", |d, w| {
        let hours = if d.one_in(4) { d.float() } else { 1e-3 * d.unit() };
        unsafe { wk_context_accumulate(handle(d, &w.contexts), hours) }.into()
    }),
    ("wk_context_get_ground_cells", |d, w| {
        let mut cells = vec![unsafe { std::mem::zeroed::<wk_ground_cell>() }; 256];
        let (context, mut revision) = (handle(d, &w.contexts), 0);
        let (most, size) = (d.below(257) as u32, size_of_element::<wk_ground_cell>(d));
        unsafe { wk_context_get_ground_cells(context, cells.as_mut_ptr(), most, size, &mut revision) }.into()
    }),
    ("wk_context_get_ground_texture", |d, w| {
        let context = handle(d, &w.contexts);
        get("wk_ground_texture", |p| unsafe { wk_context_get_ground_texture(context, p.cast()) })
    }),
    ("wk_context_get_terrain_texture", |d, w| {
        let (context, at) = (handle(d, &w.contexts), [d.float(), d.float(), d.float()]);
        get("wk_ground_texture", |p| unsafe { wk_context_get_terrain_texture(context, &at, p.cast()) })
    }),
    ("wk_weather_from_metar", |d, _| {
        let report = CString::new(texts::metar(d)).expect("no zeros");
        let (mut layers, mut out, mut metar) =
            (Struct::random_list(d, "wk_cloud_layer", 1000).0, Struct::plain("wk_weather"), Struct::plain("wk_metar"));
        let (room, size) = (d.below(MOST as usize + 1) as u32, layers.stride());
        let status = unsafe {
            let layers = layers.ptr().cast();
            wk_weather_from_metar(report.as_ptr(), layers, room, size, out.ptr().cast(), metar.ptr().cast())
        };
        Answer::of(status, &out)
    }),
    ("wk_weather_from_metar_with", |d, _| {
        let report = CString::new(texts::metar(d)).expect("no zeros");
        let mut options = Struct::random(d, "wk_metar_options", 2);
        let (mut layers, mut out, mut metar) =
            (Struct::random_list(d, "wk_cloud_layer", 1000).0, Struct::plain("wk_weather"), Struct::plain("wk_metar"));
        let (room, size) = (d.below(MOST as usize + 1) as u32, layers.stride());
        let status = unsafe {
            let (options, layers) = (options.ptr().cast(), layers.ptr().cast());
            let (out, metar) = (out.ptr().cast(), metar.ptr().cast());
            wk_weather_from_metar_with(report.as_ptr(), options, layers, room, size, out, metar)
        };
        Answer::of(status, &out)
    }),
    ("wk_weather_from_preset", |d, _| {
        let name = CString::new(d.pick(&["CLEAR", "clear", "rain", "", "storm_at_sea", "fog", "overcast", "\u{e9}"]))
            .expect("no zeros");
        let (mut layers, mut out) = (Struct::random_list(d, "wk_cloud_layer", 1000).0, Struct::plain("wk_weather"));
        let (room, size) = (d.below(MOST as usize + 1) as u32, layers.stride());
        let status =
            unsafe { wk_weather_from_preset(name.as_ptr(), layers.ptr().cast(), room, size, out.ptr().cast()) };
        Answer::of(status, &out)
    }),
    ("wk_get_preset", |d, _| {
        let (mut name, mut text): (*const c_char, *const c_char) = (null(), null());
        unsafe { wk_get_preset(d.whole() as u32, &mut name, &mut text) }.into()
    }),
    ("wk_get_veil_snippet", |d, _| {
        let mut text = null();
        unsafe { wk_get_veil_snippet(d.whole() as u32, &mut text) }.into()
    }),
    ("wk_get_ground_snippet", |d, _| {
        let mut text = null();
        unsafe { wk_get_ground_snippet(d.whole() as u32, &mut text) }.into()
    }),
    ("wk_get_cloud_shadow_snippet", |d, _| {
        let mut text = null();
        unsafe { wk_get_cloud_shadow_snippet(d.whole() as u32, &mut text) }.into()
    }),
    ("wk_surface_create", |d, w| {
        let (device, mut out) = (handle(d, &w.devices), null_mut());
        let mut window = Struct::random(d, "wk_window", 4);
        // An address that is not a window would be the host's own error.
        window.set("display", 0_u64);
        window.set("handle", 0_u64);
        unsafe { wk_surface_create(device, window.ptr().cast(), &mut out) }.into()
    }),
    ("wk_surface_destroy", |d, _| unsafe { wk_surface_destroy(handle(d, &[])) }.into()),
    ("wk_surface_configure", |d, _| {
        set_one(d, "wk_surface_config", |p| unsafe { wk_surface_configure(null_mut(), p.cast()) })
    }),
    ("wk_surface_acquire", |d, _| unsafe { wk_surface_acquire(handle(d, &[])) }.into()),
    ("wk_surface_present", |d, _| unsafe { wk_surface_present(handle(d, &[])) }.into()),
    ("wk_view_create", |d, w| {
        let (context, mut out) = (handle(d, &w.contexts), null_mut());
        let mut desc = Struct::random(d, "wk_view_desc", 10);
        let status = unsafe { wk_view_create(context, desc.ptr().cast(), &mut out) };
        made(status, out, &mut w.views, 3, |x| _ = unsafe { wk_view_destroy(x) })
    }),
    ("wk_view_destroy", |d, w| destroy(d, &mut w.views, |x| unsafe { wk_view_destroy(x) })),
    ("wk_view_record", |d, w| {
        let (mut frame, view) = (frame(d, w), handle(d, &w.views));
        let stages = if d.one_in(3) {
            1 << d.below(8)
        } else if d.one_in(20) {
            d.whole() as u32
        } else {
            WK_STAGE_ALL
        };
        unsafe { wk_view_record(view, frame.ptr().cast(), stages) }.into()
    }),
    ("wk_view_get_environment", |d, w| {
        let view = handle(d, &w.views);
        get("wk_environment", |p| unsafe { wk_view_get_environment(view, p.cast()) })
    }),
    ("wk_view_get_cloud_shadows", |d, w| {
        let view = handle(d, &w.views);
        get("wk_cloud_shadows", |p| unsafe { wk_view_get_cloud_shadows(view, p.cast()) })
    }),
    ("wk_view_get_frame_textures", |d, w| {
        let view = handle(d, &w.views);
        get("wk_frame_textures", |p| unsafe { wk_view_get_frame_textures(view, p.cast()) })
    }),
    ("wk_view_get_report", |d, w| {
        let view = handle(d, &w.views);
        get("wk_report", |p| unsafe { wk_view_get_report(view, p.cast()) })
    }),
    ("wk_view_get_costs", |d, w| {
        let (mut costs, mut count) = (room(unsafe { std::mem::zeroed::<wk_effect_cost>() }), 0);
        let (most, size) = (d.below(65) as u32, size_of_element::<wk_effect_cost>(d));
        unsafe { wk_view_get_costs(handle(d, &w.views), costs.as_mut_ptr(), most, size, &mut count) }.into()
    }),
    ("wk_view_set_rain", |d, w| {
        let view = handle(d, &w.views);
        set_one(d, "wk_rain", |p| unsafe { wk_view_set_rain(view, p.cast()) })
    }),
    ("wk_view_set_snow", |d, w| {
        let view = handle(d, &w.views);
        set_one(d, "wk_snow", |p| unsafe { wk_view_set_snow(view, p.cast()) })
    }),
    ("wk_view_set_clouds", |d, w| {
        let view = handle(d, &w.views);
        set_one(d, "wk_clouds", |p| unsafe { wk_view_set_clouds(view, p.cast()) })
    }),
    ("wk_view_set_budget", |d, w| {
        let mut budget = Struct::random(d, "wk_budget", 6);
        if d.one_in(2) {
            let (wishes, count) = Struct::random_list(d, "wk_part_wish", 5);
            budget.set("wish_count", count);
            budget.set("wish_stride", wishes.stride());
            budget.set_struct("wishes", wishes);
        }
        unsafe { wk_view_set_budget(handle(d, &w.views), budget.ptr().cast()) }.into()
    }),
    ("wk_view_report_time", |d, w| unsafe { wk_view_report_time(handle(d, &w.views), d.float()) }.into()),
    ("wk_view_get_plan", |d, w| {
        let view = handle(d, &w.views);
        get("wk_plan", |p| unsafe { wk_view_get_plan(view, p.cast()) })
    }),
    ("wk_view_get_part_plan", |d, w| {
        let (view, part) = (handle(d, &w.views), if d.one_in(8) { d.whole() as u32 } else { d.below(4) as u32 });
        get("wk_part_plan", |p| unsafe { wk_view_get_part_plan(view, part, p.cast()) })
    }),
    ("wk_view_save_plan", |d, w| {
        let (mut buffer, mut size) = (vec![0_u8; if d.one_in(6) { 8 } else { 1 << 14 }], 0);
        let status =
            unsafe { wk_view_save_plan(handle(d, &w.views), buffer.as_mut_ptr().cast(), buffer.len(), &mut size) };
        if status == WK_OK {
            buffer.truncate(size);
            w.plan = buffer;
        }
        status.into()
    }),
    ("wk_view_load_plan", |d, w| {
        let mut plan = w.plan.clone();
        texts::damage(d, &mut plan);
        unsafe { wk_view_load_plan(handle(d, &w.views), plan.as_ptr().cast(), plan.len()) }.into()
    }),
    ("wk_view_set_windscreen", |d, w| {
        let mut screen = Struct::random(d, "wk_windscreen", 10);
        if d.one_in(2) {
            let (arms, count) = Struct::random_list(d, "wk_wiper_arm", 10);
            screen.set("arm_count", count);
            screen.set("arm_stride", arms.stride());
            screen.set_struct("arms", arms);
        }
        let screen = if d.one_in(20) { null() } else { screen.ptr().cast_const().cast() };
        unsafe { wk_view_set_windscreen(handle(d, &w.views), screen) }.into()
    }),
    ("wk_view_get_windscreen_report", |d, w| {
        let view = handle(d, &w.views);
        get("wk_windscreen_report", |p| unsafe { wk_view_get_windscreen_report(view, p.cast()) })
    }),
];

/// Functions without an entry: they return no status of a call, or need a host of their own.
pub const ELSEWHERE: &[&str] = &[
    // Each call draws all moments of its first weathers anew: tests/abi_calls/prepare.rs.
    "wk_view_prepare",
    "wk_status_name",
    "wk_last_error_message",
    "wk_last_error_field",
    "wk_set_log_callback",
    "wk_device_create_for_window",
    "wk_device_create_opengl",
    "wk_device_create_vulkan",
];
