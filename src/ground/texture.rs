//! Texture of the water on the host's terrain. The surface pass reads this texture, and the host can sample it in its
//! own materials.
//!
//! There is one texel per node: rows from south to north, each row from west to east. Texels are half floats, which
//! every graphics API can filter. Film, soaked share and standing water are exact to 1/2048 of their value: 0.05 mm at
//! 100 mm. Standing water is negative at a node above the water's level. Between a node under water and a node above
//! the water, the interpolated value is 0 at the shore, where the water's level meets the ground.

use glam::DVec4;

use super::{
    grid::GroundGrid,
    terrain::{GridTerrain, TerrainWater},
    window::DrawnTerrain,
};
use crate::{gpu::Device, surroundings::LyingSnow};

/// WGSL text of functions that compute the look of the water from a [`GroundTexture`].
pub const SNIPPET_WGSL: &str = include_str!("../../shaders/snippets/welkin_ground.wgsl");
/// GLSL text of the functions in [`SNIPPET_WGSL`], for GLSL 3.30 and GLSL ES 3.00.
pub const SNIPPET_GLSL: &str = include_str!("../../shaders/snippets/welkin_ground.glsl");

/// Water on the host's terrain, on a grid or on tiles, for the host's own shaders: the values of
/// [`GroundCell`](crate::ground::GroundCell), one texel per node.
#[derive(Clone, Debug)]
pub struct GroundTexture {
    /// RGBA half floats: film in mm, soaked share of the pores, standing water in mm, share under ice. Standing water
    /// is negative where none stands: minus the height of the ground above its hollow's water level, or -50 where the
    /// hollow is dry. The texture belongs to the context, and the next call of the function that returned it updates
    /// it. The texture of a grid is also updated by frames with [`Stages::SURFACE`](crate::frame::Stages::SURFACE).
    pub texture: wgpu::Texture,
    /// Incremented whenever `texture` is replaced, which happens when another grid is set or loaded. Always 1 for
    /// tiles.
    pub generation: u64,
    /// Value of [`Context::ground_revision`](crate::context::Context::ground_revision) for the contents of a grid's
    /// texture. For tiles, the number of writes to the textures so far.
    pub revision: u64,
    /// Snow on the same nodes, RGBA half floats: depth in m, density in kg/m^3, wetness, albedo of visible light.
    /// `None` without simulated snow ([`LyingSnowModel`](crate::snowpack::LyingSnowModel)). Replaced and updated
    /// together with `texture`.
    pub snow: Option<wgpu::Texture>,
    /// Rows of the transform from a place (x, y, z) in the host's world, m, to texture coordinates. The dot product of
    /// the first row with (x, y, z, 1) is u, that of the second row is v.
    pub uv_from_world: [DVec4; 2],
}

/// Returns the rows that map the host's world to the coordinates of a texture of these nodes.
pub(crate) fn uv_from_world(drawn: &DrawnTerrain) -> [DVec4; 2] {
    [0, 1].map(|i| {
        let nodes = f64::from(drawn.nodes[i]);
        let row = drawn.to_enu.row(i) / (drawn.cell_m * nodes);
        row.extend(0.5 / nodes - row.dot(drawn.origin))
    })
}

/// GPU textures of a terrain.
#[derive(Clone, Debug)]
pub(crate) struct UploadedTerrain {
    /// Texture of the water ([`TerrainWater::texels`]).
    pub water: wgpu::Texture,
    /// Texture of the surface ([`surface_texels`]), followed by as many rows of the snow: depth in m, density in
    /// kg/m^3, wetness, albedo.
    surface: wgpu::Texture,
    /// Texture views for drawing: of the water and of the surface.
    pub views: [wgpu::TextureView; 2],
    /// Revision of the grid in the textures.
    pub generation: u64,
    /// Revision of the water in the textures.
    pub revision: u64,
    /// Revision of the classes in the textures.
    classes: u64,
    /// Revision of the snow in the textures.
    snow: u64,
    /// Snow texture for the host and the revision of the snow in this texture; `None` until the host asks for one.
    host_snow: Option<(wgpu::Texture, u64)>,
}

/// Terrain textures of a context; created when they are first asked for.
#[derive(Default)]
pub(crate) struct TerrainTextures {
    filled: Option<UploadedTerrain>,
    /// Whether the water or the host's snow was written since the last transition to reading (`hand_over`).
    pub written: bool,
    /// Scratch space for the texels of the water or of the host's snow.
    texels: Vec<[u16; 4]>,
    /// Scratch space for the texels of the surface.
    surface: Vec<[f32; 4]>,
}

impl TerrainTextures {
    /// Returns the textures as they are, which may be out of date.
    pub fn filled(&self) -> Option<&UploadedTerrain> {
        self.filled.as_ref()
    }

    /// Uploads surface and water if the grid was replaced; otherwise uploads each only if it has changed. The last
    /// argument holds the revisions of the grid, of the water and of the classes.
    pub fn upload(
        &mut self,
        device: &Device,
        terrain: &GridTerrain,
        water: &TerrainWater,
        ice: impl Fn(usize) -> f32,
        [generation, revision, classes]: [u64; 3],
    ) {
        let filled = self.filled.take().filter(|f| f.generation == generation);
        let mut filled = filled.unwrap_or_else(|| UploadedTerrain::new(device, &terrain.grid, generation));
        if filled.classes != classes {
            surface_texels(&terrain.grid, &mut self.surface);
            let whole = (wgpu::Origin3d::ZERO, filled.water.size());
            write_at(device, &filled.surface, whole, bytemuck::cast_slice(&self.surface), 16);
            filled.classes = classes;
        }
        if filled.revision != revision {
            water.texels(ice, &mut self.texels);
            let whole = (wgpu::Origin3d::ZERO, filled.water.size());
            write_at(device, &filled.water, whole, bytemuck::cast_slice(&self.texels), 8);
            (filled.revision, self.written) = (revision, true);
        }
        self.filled = Some(filled);
    }

    /// Returns the up-to-date snow texture for the host; `None` without simulated snow.
    pub fn host_snow(&mut self, device: &Device, snow: Option<&LyingSnow>) -> Option<wgpu::Texture> {
        let (filled, snow) = (self.filled.as_mut()?, snow?);
        let [width, height] = [filled.water.width(), filled.water.height()];
        let made = filled.host_snow.take();
        let (texture, held) = made.unwrap_or_else(|| {
            (terrain_texture(device, "terrain snow", wgpu::TextureFormat::Rgba16Float, [width, height]), 0)
        });
        if held != snow.revision {
            self.texels.clear();
            self.texels.extend(snow.cells.iter().map(|c| c.map(|v| half::f16::from_f32(v).to_bits())));
            let whole = (wgpu::Origin3d::ZERO, texture.size());
            write_at(device, &texture, whole, bytemuck::cast_slice(&self.texels), 8);
            self.written = true;
        }
        filled.host_snow = Some((texture.clone(), snow.revision));
        Some(texture)
    }

    /// Uploads the snow on the terrain, if it has changed, into the rows after those of the surface.
    pub fn upload_snow(&mut self, device: &Device, snow: Option<&LyingSnow>) -> Option<&UploadedTerrain> {
        let filled = self.filled.as_mut()?;
        if let Some(snow) = snow.filter(|s| s.revision != filled.snow) {
            let place = wgpu::Origin3d { x: 0, y: filled.water.height(), z: 0 };
            write_at(device, &filled.surface, (place, filled.water.size()), bytemuck::cast_slice(&snow.cells), 16);
            filled.snow = snow.revision;
        }
        Some(filled)
    }
}

impl UploadedTerrain {
    /// Creates the empty textures of a grid.
    fn new(device: &Device, grid: &GroundGrid, generation: u64) -> Self {
        use wgpu::TextureFormat as F;
        let [width, height] = grid.nodes;
        let water = terrain_texture(device, "terrain water", F::Rgba16Float, [width, height]);
        let surface = terrain_texture(device, "terrain surface", F::Rgba32Float, [width, 2 * height]);
        let views = [&water, &surface].map(|t| t.create_view(&Default::default()));
        Self { water, surface, views, generation, revision: u64::MAX, classes: u64::MAX, snow: 0, host_snow: None }
    }
}

/// Creates a texture that is written from the CPU.
fn terrain_texture(
    device: &Device,
    label: &str,
    format: wgpu::TextureFormat,
    [width, height]: [u32; 2],
) -> wgpu::Texture {
    use wgpu::TextureUsages as U;
    device.device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: U::TEXTURE_BINDING | U::COPY_DST | U::COPY_SRC,
        view_formats: &[],
    })
}

/// Fills `texels` with one texel per node, by rows: slopes to the east and the north, height over the grid's origin in
/// m, number of the class.
fn surface_texels(grid: &GroundGrid, texels: &mut Vec<[f32; 4]>) {
    texels.clear();
    texels.extend(grid.heights_m.iter().enumerate().map(|(node, height)| {
        let [east, north] = grid.slope(node);
        [east as f32, north as f32, *height, f32::from(grid.class(node) as u8)]
    }));
}

/// Writes `bytes` to a rectangle of a texture; `texel` is the size of a texel, bytes.
fn write_at(
    device: &Device,
    texture: &wgpu::Texture,
    (origin, size): (wgpu::Origin3d, wgpu::Extent3d),
    bytes: &[u8],
    texel: u32,
) {
    let rows = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(texel * size.width), rows_per_image: None };
    let to = wgpu::TexelCopyTextureInfo { origin, ..texture.as_image_copy() };
    device.write_texture(to, bytes, rows, size);
}

#[cfg(test)]
mod tests {
    use glam::{DMat3, DVec3};

    use super::*;
    use crate::gpu::shader;

    #[test]
    fn nodes_lie_in_the_middle_of_their_texels() {
        let grid = GroundGrid {
            origin: DVec3::new(10.0, -20.0, 3.0),
            cell_m: 2.0,
            nodes: [5, 3],
            heights_m: (0..15).map(|i| i as f32).collect(),
            classes: Vec::new(),
        };
        let turned = DMat3::from_rotation_z(0.7);
        let rows = uv_from_world(&DrawnTerrain::of_grid(&grid, turned));
        for index in [0, 4, 7, 14] {
            let uv = rows.map(|r| r.dot(grid.node(index, &turned).extend(1.0)));
            let wanted = [(index % 5) as f64 + 0.5, (index / 5) as f64 + 0.5];
            assert!((uv[0] * 5.0 - wanted[0]).abs() < 1e-12 && (uv[1] * 3.0 - wanted[1]).abs() < 1e-12, "{uv:?}");
        }
    }

    #[test]
    fn the_snippets_are_valid_and_say_the_same() {
        shader::validate(SNIPPET_WGSL).unwrap();
        let bare = |text: &str, words: &[(&str, &str)]| {
            let code: String = text.lines().filter(|l| !l.starts_with("//")).collect();
            words.iter().fold(code, |code, (from, to)| code.replace(from, to)).replace(' ', "")
        };
        let laws = |code: &str| {
            code.split(['{', '}', ';']).filter(|s| s.contains("0.")).map(str::to_owned).collect::<Vec<_>>()
        };
        let wgsl = bare(
            SNIPPET_WGSL,
            &[("vec2f", "vec2"), ("vec3f", "vec3"), ("vec4f", "vec4"), ("textureDimensions(ground)", "size")],
        );
        let glsl = bare(SNIPPET_GLSL, &[("textureSize(ground, 0)", "size")]);
        let right = |law: &String| law.split_once('=').map_or(law.clone(), |(_, value)| value.to_owned());
        let (wgsl, glsl) = (laws(&wgsl), laws(&glsl));
        assert!(wgsl.len() > 6, "{wgsl:?}");
        // The choice of wetness is written differently in the two.
        let differ: Vec<_> = wgsl.iter().zip(&glsl).filter(|(w, g)| right(w) != right(g)).collect();
        assert!(wgsl.len() == glsl.len() && differ.len() == 1 && differ[0].0.contains("wetness"), "{differ:?}");
    }

    #[test]
    fn the_snippets_constants_are_those_of_what_is_drawn() {
        let text = shader::assemble("ground/surface.wgsl").unwrap();
        for line in ["const WATER_OUTSIDE: f32 = 0.0664;", "const WATER_INSIDE: f32 = 0.4746;"] {
            assert!(text.contains(line), "{line}");
        }
        for line in ["const THIN_FILM_SLOPE: f32 = 0.3;", "const CLOSED_FILM_SLOPE: f32 = 0.15;"] {
            assert!(text.contains(line), "{line}");
        }
    }
}
