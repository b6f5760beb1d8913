//! Uniform blocks of the shelters, occluder maps and lamps around a camera: one bind group, of index 2, for all
//! shaders. The blocks are uploaded before each draw that reads them. While there is no shelter, map or lamp, nothing
//! is uploaded, apart from one upload after the last of them was removed.

use glam::{DMat3, DVec3};

use super::{
    OccluderMaps, Shelter,
    occluder::{MAX_OCCLUDER_MAPS, OccluderUniform},
    shelter::{MAX_PLANES, MAX_SHELTERS},
};
use crate::{
    gpu::{
        Device,
        bind::{self, Slot},
    },
    scene::{FlashLamp, HostLight, LightUniform, MAX_LIGHTS},
};

/// Bytes of a box: its rows, its velocity, and the indices of the planes that cut it.
const BOX_BYTES: usize = 80;
/// Byte offset of the planes in the block of shelters.
const CUTS_AT: usize = 16 + MAX_SHELTERS * BOX_BYTES;
/// Bytes of the block of shelters: two counts, the boxes, and the planes.
const SHELTER_BYTES: usize = CUTS_AT + MAX_SHELTERS * MAX_PLANES * 16;
/// Bytes of the block of maps: a count, the place of the cells in the table ([`OccluderMaps::cells_at`]), and the maps.
const MAP_BYTES: usize = 16 + MAX_OCCLUDER_MAPS * size_of::<OccluderUniform>();
/// Bytes of the block of lamps: a count, and the lamps.
const LIGHT_BYTES: usize = 16 + MAX_LIGHTS * size_of::<LightUniform>();
/// Byte offset of each block, and the end of the last.
const STARTS: [usize; 4] = {
    let maps = SHELTER_BYTES.next_multiple_of(256);
    let lights = maps + MAP_BYTES.next_multiple_of(256);
    [0, maps, lights, lights + LIGHT_BYTES.next_multiple_of(256)]
};

/// Uniform blocks and bind group of one view.
pub(crate) struct SurroundingsBlock {
    layout: wgpu::BindGroupLayout,
    buffer: wgpu::Buffer,
    /// Bytes of the blocks, before they are uploaded.
    staged: Vec<u8>,
    /// Whether the last upload contained any surroundings.
    holds_any: bool,
    /// Whether there is a map, or a box that may keep rain off near the camera.
    sheltered: bool,
    /// Placeholder for the table of maps (the texture of all occluder maps) while there is none.
    none: wgpu::TextureView,
    /// Table of maps in the bind group, and the bind group itself.
    bound: (Option<wgpu::Texture>, wgpu::BindGroup),
}

/// Presence of surroundings, which selects the shader variant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub(crate) struct HasSurroundings {
    /// Whether there are boxes or maps, which keep rain off.
    pub shelter: bool,
    /// Whether there are occluder maps.
    pub maps: bool,
    /// Whether there are lamps.
    pub lamps: bool,
}

/// Fall speed and largest distance of the drops and flakes around a camera, from which the shelters near the camera are
/// chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ShelterReach {
    /// Fall speed of the slowest particles, m/s.
    pub slowest_m_s: f64,
    /// Largest distance at which particles are drawn, m.
    pub reach_m: f64,
}

impl ShelterReach {
    /// Reach without any particles.
    pub const NONE: Self = Self { slowest_m_s: 1.0, reach_m: 0.0 };

    /// Returns the reach within which shelters matter to `self` or to `other`.
    pub fn with(self, other: Self) -> Self {
        Self { slowest_m_s: self.slowest_m_s.min(other.slowest_m_s), reach_m: self.reach_m.max(other.reach_m) }
    }
}

/// Shelters, occluder maps and lamps of the host, and the camera for which they are prepared.
pub(crate) struct HostSurroundings<'a> {
    pub shelters: &'a [Shelter],
    pub maps: Option<&'a OccluderMaps>,
    pub lights: &'a [HostLight],
    /// Lightning flashes. They take the places that the host's lamps leave free in the block of lamps.
    pub flash: &'a [FlashLamp],
    /// Position of the camera in the host's world, m.
    pub eye: DVec3,
    /// Rotation from the host's axes to east, north, up at the camera.
    pub to_enu: DMat3,
    /// Time of the frame, s.
    pub time_s: f64,
    /// Velocity of the air, (east, north, up), m/s.
    pub wind_m_s: DVec3,
    pub near: ShelterReach,
    /// Exposure of the picture, display units per cd/m^2. The lamps' light is multiplied by it.
    pub exposure: f64,
}

impl HostSurroundings<'_> {
    /// Returns which surroundings there are.
    pub fn present(&self) -> HasSurroundings {
        let maps = self.maps.is_some_and(|m| m.ranges().is_some());
        HasSurroundings {
            shelter: maps || !self.shelters.is_empty(),
            maps,
            lamps: !(self.lights.is_empty() && self.flash.is_empty()),
        }
    }
}

/// Creates the layout of bind group 2, for every shader that reads the blocks.
pub(crate) fn layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let all = wgpu::ShaderStages::VERTEX_FRAGMENT | wgpu::ShaderStages::COMPUTE;
    let slots = [
        (0, Slot::Uniform(SHELTER_BYTES)),
        (1, Slot::Uniform(MAP_BYTES)),
        (2, Slot::Words),
        (3, Slot::Uniform(LIGHT_BYTES)),
    ];
    bind::layout(device, "around", all, &slots)
}

impl SurroundingsBlock {
    pub fn new(device: &wgpu::Device) -> Self {
        let none = bind::nothing(device, wgpu::TextureFormat::R8Uint);
        let buffer = crate::gpu::bind::block(device, "around", STARTS[3]);
        let layout = layout(device);
        let bound = (None, group(device, &layout, &buffer, &none));
        Self { layout, buffer, staged: vec![0; STARTS[3]], holds_any: false, sheltered: false, none, bound }
    }

    /// Updates the blocks for a frame.
    pub fn update(&mut self, device: &Device, host: &HostSurroundings<'_>) {
        let present = host.present();
        self.sheltered = false;
        if present != HasSurroundings::default() || self.holds_any {
            let end = self.stage(host);
            device.write_buffer(&self.buffer, 0, &self.staged[..end]);
        }
        self.holds_any = present != HasSurroundings::default();
        let ranges = host.maps.and_then(|m| m.ranges());
        if self.bound.0.as_ref() != ranges {
            let view = ranges.map(|t| t.create_view(&Default::default()));
            let view = view.as_ref().unwrap_or(&self.none);
            self.bound = (ranges.cloned(), group(&device.device, &self.layout, &self.buffer, view));
        }
    }

    /// Writes the blocks into the staging buffer and returns the number of bytes up to the end of the last lamp.
    fn stage(&mut self, host: &HostSurroundings<'_>) -> usize {
        let staged = &mut self.staged;
        let mut put = |at: usize, bytes: &[u8]| staged[at..at + bytes.len()].copy_from_slice(bytes);
        let matters =
            |s: &Shelter| s.matters(host.eye, host.to_enu, host.wind_m_s, host.near.slowest_m_s, host.near.reach_m);
        let boxes = &host.shelters[..host.shelters.len().min(MAX_SHELTERS)];
        let (mut i, mut cuts) = (0, 0);
        let mut near = 0u32;
        for first in [true, false] {
            for shelter in boxes.iter().filter(|s| matters(s) == first) {
                let at = STARTS[0] + 16 + BOX_BYTES * i;
                put(at, bytemuck::cast_slice(&shelter.rows(host.eye, host.to_enu)));
                let begin = cuts;
                for plane in shelter.cuts() {
                    put(STARTS[0] + CUTS_AT + 16 * cuts, bytemuck::cast_slice(&plane));
                    cuts += 1;
                }
                put(at + 64, bytemuck::cast_slice(&[begin as u32, cuts as u32]));
                i += 1;
            }
            near = if first { i as u32 } else { near };
        }
        put(STARTS[0], bytemuck::cast_slice(&[near, i as u32]));
        let mut maps = 0u32;
        if let Some(m) = host.maps {
            for uniform in m.uniforms(host.eye, host.to_enu, host.time_s) {
                put(STARTS[1] + 16 + maps as usize * size_of::<OccluderUniform>(), bytemuck::bytes_of(&uniform));
                maps += 1;
            }
            put(STARTS[1] + 8, bytemuck::cast_slice(&m.cells_at()));
        }
        put(STARTS[1], &maps.to_ne_bytes());
        self.sheltered = near + maps > 0;
        let lights = &host.lights[..host.lights.len().min(MAX_LIGHTS)];
        let own = lights.iter().map(|light| light.uniform(host.eye, host.to_enu, host.exposure));
        let all = own.chain(host.flash.iter().map(|lamp| lamp.uniform(host.exposure))).take(MAX_LIGHTS);
        let mut count = 0;
        for uniform in all {
            put(STARTS[2] + 16 + count * size_of::<LightUniform>(), bytemuck::bytes_of(&uniform));
            count += 1;
        }
        put(STARTS[2], &(count as u32).to_ne_bytes());
        // The rest is not uploaded: shaders do not read beyond the last lamp.
        STARTS[2] + 16 + size_of::<LightUniform>() * count
    }

    /// Returns whether there is a map, or a box that may keep rain off near the camera.
    pub fn shelters(&self) -> bool {
        self.sheltered
    }

    /// Returns the bind group.
    pub fn bind_group(&self) -> &wgpu::BindGroup {
        &self.bound.1
    }
}

fn group(
    device: &wgpu::Device,
    layout: &wgpu::BindGroupLayout,
    buffer: &wgpu::Buffer,
    table: &wgpu::TextureView,
) -> wgpu::BindGroup {
    let block = |binding, at: usize, size: usize| bind::part(binding, buffer, at..at + size);
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("around"),
        layout,
        entries: &[
            block(0, STARTS[0], SHELTER_BYTES),
            block(1, STARTS[1], MAP_BYTES),
            bind::view(2, table),
            block(3, STARTS[2], LIGHT_BYTES),
        ],
    })
}
