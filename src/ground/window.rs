//! Textures of a window of a tiled terrain: for the surface pass around a camera, and for the host's own shaders around
//! a place that the host names. [`super::texture`] does the same for a grid.
//!
//! A window has 512 x 512 cells around the place and moves in steps of 64 cells. A texel is a cell, so with cells of 1
//! m the window reaches 224 to 288 m from the camera; beyond the window the ground is drawn as level and open. Only
//! changed parts are filled and uploaded: everything if the window moves; otherwise the rectangles in which the ground
//! changed, all water if the water has changed, and all snow if the snow has.

use glam::{DMat3, DVec3};
use half::f16;

use super::{grid::GroundGrid, tiled::TiledWater, water::GroundWater};
use crate::{
    gpu::Device,
    surroundings::LyingSnow,
    terrain::{CellRect, Terrain},
};

/// Cells along a side of a window.
const WINDOW: i32 = 512;
/// Step by which a window moves, cells.
const STEP: i32 = 64;
/// Height stored for a hole, m: so high that no surface of the host lies near it.
const NOWHERE_M: f32 = 1e6;
/// Value of standing water, mm, for a cell that has none on it or beside it.
const BARE_MM: f64 = -50.0;

/// Grid of nodes that a frame draws: a whole grid, or a window of a tiled terrain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct DrawnTerrain {
    /// Position of the first node in the host's world, at the level from which heights are measured.
    pub origin: DVec3,
    /// Rotation from the host's axes to east, north, up at the origin of the terrain.
    pub to_enu: DMat3,
    /// Side of a cell, m.
    pub cell_m: f64,
    /// Numbers of nodes east and north.
    pub nodes: [u32; 2],
}

impl DrawnTerrain {
    /// Creates the window that covers a whole grid.
    pub fn of_grid(grid: &GroundGrid, to_enu: DMat3) -> Self {
        Self { origin: grid.origin, to_enu, cell_m: grid.cell_m, nodes: grid.nodes }
    }

    /// Creates the window around a camera; `None` if no tile reaches into it.
    pub fn window(terrain: &Terrain, eye: DVec3) -> Option<Self> {
        let low = window(terrain, eye)?.low;
        let plan = DVec3::new(f64::from(low[0]), f64::from(low[1]), 0.0) * terrain.desc.cell_m;
        let origin = terrain.desc.origin + terrain.to_enu.transpose() * plan;
        Some(Self { origin, to_enu: terrain.to_enu, cell_m: terrain.desc.cell_m, nodes: [WINDOW as u32; 2] })
    }
}

/// Returns the cells of the window around a camera; `None` if no tile reaches into it.
fn window(terrain: &Terrain, eye: DVec3) -> Option<CellRect> {
    let (cells, _) = terrain.cells_at(eye);
    if !cells.is_finite() || cells.abs().max_element() > f64::from(1 << 29) {
        return None;
    }
    let low = [cells.x, cells.y].map(|v| (v / f64::from(STEP)).floor() as i32 * STEP + STEP / 2 - WINDOW / 2);
    let rect = CellRect { low, high: low.map(|v| v + WINDOW) };
    terrain.keys_within(rect).any(|key| terrain.slot(key).is_some()).then_some(rect)
}

/// Data from which a window is filled.
#[derive(Clone, Copy)]
pub(super) struct Shown<'a> {
    pub terrain: &'a Terrain,
    pub water: &'a TiledWater,
    /// Water of level ground, for tiles without water of their own.
    pub even: GroundWater,
    /// Share of the ground under ice.
    pub ice: f32,
    /// Snow on the tiles, where it is simulated.
    pub snow: Option<&'a LyingSnow>,
}

/// Inputs from which the textures were filled; a part is filled again if its inputs change.
#[derive(Clone, Copy, Debug, PartialEq)]
struct WindowContents {
    /// Cells of the window.
    rect: CellRect,
    /// Identity of the terrain.
    id: u64,
    /// Revision of the terrain.
    revision: u64,
    /// Version of the water ([`TiledWater::version`]).
    water: (u64, u64),
    /// Water of level ground.
    even: GroundWater,
    /// Share of the ground under ice.
    ice: f32,
    /// Revision of the snow; 0 before there is any.
    snow: u64,
}

/// Content that a window fills into its textures. `Ground` is surface and water together.
#[derive(Clone, Copy)]
enum WindowPart {
    Ground,
    Surface,
    Water,
    Snow,
}

/// Textures of a window. For drawing these are the water, and the surface together with its snow. For a host they are
/// the water and the snow.
#[derive(Default)]
pub(crate) struct TerrainWindow {
    /// Whether the textures are for the host's own shaders.
    is_for_host: bool,
    /// Number of writes to the textures.
    pub(super) writes: u64,
    /// Textures of water and surface, or of water and snow for a host, and their views.
    textures: Option<([wgpu::Texture; 2], [wgpu::TextureView; 2])>,
    /// Inputs from which the textures were filled last.
    filled: Option<WindowContents>,
    /// Scratch space for texels of the water, or of the snow for a host.
    water: Vec<[u16; 4]>,
    /// Scratch space for texels of the surface or, if not for a host, of the snow. The texture of the surface has the
    /// snow in the rows after the surface.
    surface: Vec<[f32; 4]>,
}

impl TerrainWindow {
    /// Creates a window for the host's own shaders.
    pub fn for_host() -> Self {
        Self { is_for_host: true, ..Self::default() }
    }

    /// Returns the textures of water and snow, for a host.
    pub(super) fn textures(&self) -> Option<&[wgpu::Texture; 2]> {
        self.textures.as_ref().map(|(textures, _)| textures)
    }

    /// Returns the up-to-date views of the window's two textures around a camera or place; `None` if no tile reaches
    /// into the window.
    pub(super) fn views(&mut self, device: &Device, eye: DVec3, shown: &Shown<'_>) -> [Option<wgpu::TextureView>; 2] {
        let Some(rect) = window(shown.terrain, eye) else { return [None, None] };
        let terrain = shown.terrain;
        let now = WindowContents {
            rect,
            id: terrain.id,
            revision: terrain.revision,
            water: shown.water.version(),
            even: shown.even,
            ice: shown.ice,
            snow: shown.snow.map_or(0, |snow| snow.revision),
        };
        let before = self.filled.filter(|f| f.rect == rect && f.id == now.id);
        let changed: Option<Vec<CellRect>> =
            before.and_then(|f| Some(terrain.recent.since(f.revision, now.revision)?.collect()));
        let is_wet_anew = before.is_none_or(|f| (f.water, f.even, f.ice) != (now.water, now.even, now.ice));
        match changed {
            Some(changed) => {
                changed.iter().for_each(|c| self.fill(device, shown, (rect, c.grown(1)), WindowPart::Ground))
            }
            None => self.fill(device, shown, (rect, rect), WindowPart::Surface),
        }
        if is_wet_anew {
            self.fill(device, shown, (rect, rect), WindowPart::Water);
        }
        // Fills the snow anew if it has changed. A new texture is empty, as the snow is at revision 0.
        if before.map_or(0, |f| f.snow) != now.snow {
            self.fill(device, shown, (rect, rect), WindowPart::Snow);
        }
        self.filled = Some(now);
        self.textures.as_ref().map_or([None, None], |t| t.1.clone().map(Some))
    }

    /// Fills and uploads a part of a window: the surface, the water, both, or the snow.
    fn fill(&mut self, device: &Device, shown: &Shown<'_>, (window, part): (CellRect, CellRect), what: WindowPart) {
        let Some(part) = window.meets(part) else { return };
        let is_snow = matches!(what, WindowPart::Snow);
        match what {
            WindowPart::Snow => self.read_snow(shown, part),
            WindowPart::Surface if self.is_for_host => return,
            WindowPart::Ground if self.is_for_host => self.read(shown, part, WindowPart::Water),
            _ => self.read(shown, part, what),
        }
        self.writes += 1;
        let is_for_host = self.is_for_host;
        let (textures, _) = self.textures.get_or_insert_with(|| made(device, is_for_host));
        let extent = [0, 1].map(|i| (part.high[i] - part.low[i]) as u32);
        let below = if is_snow && !is_for_host { WINDOW as u32 } else { 0 };
        let at = [0, 1].map(|i| (part.low[i] - window.low[i]) as u32);
        let write = |texture: &wgpu::Texture, bytes: &[u8], texel: u32| {
            let to = wgpu::TexelCopyTextureInfo {
                origin: wgpu::Origin3d { x: at[0], y: at[1] + below, z: 0 },
                ..texture.as_image_copy()
            };
            let rows =
                wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(texel * extent[0]), rows_per_image: None };
            let size = wgpu::Extent3d { width: extent[0], height: extent[1], depth_or_array_layers: 1 };
            device.write_texture(to, bytes, rows, size);
        };
        if !self.surface.is_empty() {
            write(&textures[1], bytemuck::cast_slice(&self.surface), 16);
        }
        if !self.water.is_empty() {
            write(&textures[usize::from(is_snow)], bytemuck::cast_slice(&self.water), 8);
        }
    }

    /// Reads the snow of a part of the terrain, by rows.
    fn read_snow(&mut self, shown: &Shown<'_>, part: CellRect) {
        let width = (part.high[0] - part.low[0]) as usize;
        let count = width * (part.high[1] - part.low[1]) as usize;
        self.water.clear();
        self.surface.clear();
        if self.is_for_host {
            self.water.resize(count, [0; 4]);
        } else {
            self.surface.resize(count, [0.0; 4]);
        }
        let (terrain, Some(snow)) = (shown.terrain, shown.snow) else { return };
        for key in terrain.keys_within(part) {
            let Some(tile) = snow.tiles.get(&[key.east, key.north]) else { continue };
            let Some(own) = terrain.rect(key).meets(part).filter(|_| terrain.slot(key).is_some()) else { continue };
            for y in own.low[1]..own.high[1] {
                let from = terrain.in_tile([own.low[0], y]);
                let to = (y - part.low[1]) as usize * width + (own.low[0] - part.low[0]) as usize;
                let count = (own.high[0] - own.low[0]) as usize;
                let Some(cells) = tile.cells.get(from..from + count) else { continue };
                if self.is_for_host {
                    self.water[to..to + count].copy_from_slice(cells);
                    continue;
                }
                let texel = |c: &[u16; 4]| c.map(|v| f16::from_bits(v).to_f32());
                self.surface[to..to + count].iter_mut().zip(cells).for_each(|(to, c)| *to = texel(c));
            }
        }
    }

    /// Reads the texels of the surface, of the water or of both in a part of the terrain, by rows.
    fn read(&mut self, shown: &Shown<'_>, part: CellRect, what: WindowPart) {
        let [surface, water] = [!matches!(what, WindowPart::Water), !matches!(what, WindowPart::Surface)];
        let width = (part.high[0] - part.low[0]) as usize;
        let count = width * (part.high[1] - part.low[1]) as usize;
        self.surface.clear();
        self.water.clear();
        if surface {
            self.surface.resize(count, [0.0, 0.0, NOWHERE_M, 0.0]);
        }
        if water {
            self.water.resize(count, half4([0.0, 0.0, BARE_MM as f32, 0.0]));
        }
        let terrain = shown.terrain;
        for key in terrain.keys_within(part) {
            let (Some(slot), Some(own)) = (terrain.slot(key), terrain.rect(key).meets(part)) else { continue };
            let tile = terrain.tile(slot);
            for place in own.cells() {
                let cell = terrain.in_tile(place);
                if !tile.has_ground(cell) {
                    continue;
                }
                let to = (place[1] - part.low[1]) as usize * width + (place[0] - part.low[0]) as usize;
                if surface {
                    let [east, north] = slope(terrain, place, tile.heights_m[cell]);
                    self.surface[to] = [east, north, tile.heights_m[cell], f32::from(tile.class(cell) as u8)];
                }
                if water {
                    let id = terrain.joined(slot, cell);
                    let c = shown.water.cell(terrain, id, &shown.even);
                    let standing = if c.standing_mm > BARE_MM { c.standing_mm } else { shore(shown, id) };
                    self.water[to] = half4([c.film_mm as f32, c.soaked as f32, standing as f32, shown.ice]);
                }
            }
        }
    }
}

/// Returns the highest water level beside a cell minus the cell's height, mm, from [`BARE_MM`] to 0. Interpolation with
/// this value puts the shore where the water's level meets the ground between the two cells.
fn shore(shown: &Shown<'_>, cell: u32) -> f64 {
    if !shown.water.has_lakes_near(shown.terrain, cell) {
        return BARE_MM;
    }
    let own = f64::from(shown.terrain.height(cell)) * 1e3;
    let beside =
        shown.terrain.around(cell).into_iter().flatten().filter_map(|near| shown.water.level_mm(shown.terrain, near));
    beside.fold(BARE_MM, |highest, level| highest.max(level - own)).min(0.0)
}

/// Returns the slope at a cell, rise over run to the east and the north: a central difference, one-sided where a
/// neighbour has no ground.
fn slope(terrain: &Terrain, [x, y]: [i32; 2], own: f32) -> [f32; 2] {
    let height = |at: [i32; 2]| terrain.cell_at(at).map(|cell| terrain.height(cell));
    [[1, 0], [0, 1]].map(|[dx, dy]| {
        let (before, after) = (height([x - dx, y - dy]), height([x + dx, y + dy]));
        let cells = f32::from(u8::from(before.is_some()) + u8::from(after.is_some())).max(1.0);
        (after.unwrap_or(own) - before.unwrap_or(own)) / (cells * terrain.desc.cell_m as f32)
    })
}

/// Converts to half floats. Values outside the range of half floats are clamped.
fn half4(values: [f32; 4]) -> [u16; 4] {
    values.map(|v| f16::from_f32(v.clamp(f16::MIN.to_f32(), f16::MAX.to_f32())).to_bits())
}

/// Creates the empty textures of a window, and their views.
fn made(device: &Device, is_for_host: bool) -> ([wgpu::Texture; 2], [wgpu::TextureView; 2]) {
    use wgpu::{TextureFormat as F, TextureUsages as U};
    let texture = |label, format, height| {
        device.device.create_texture(&wgpu::TextureDescriptor {
            label: Some(label),
            size: wgpu::Extent3d { width: WINDOW as u32, height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: U::TEXTURE_BINDING | U::COPY_DST | U::COPY_SRC,
            view_formats: &[],
        })
    };
    let rows = WINDOW as u32;
    let second = if is_for_host {
        texture("window snow", F::Rgba16Float, rows)
    } else {
        texture("window surface", F::Rgba32Float, 2 * rows)
    };
    let both = [texture("window water", F::Rgba16Float, rows), second];
    let views = [0, 1].map(|i| both[i].create_view(&Default::default()));
    (both, views)
}
