//! Look-up tables of clouds for shaders: the map of where clouds grow, the solid noise, light that is scattered more
//! than once, and hosts' cover maps.

use std::{sync::Arc, time::Instant};

use half::f16;

use crate::{
    clouds::{
        field::{
            layer_map::LayerMap,
            map::{MAP_SIZE, Map},
            solid::{SOLID_SIZE, solid_settings},
        },
        light::{
            media::{SUN_MOVED, droplets, media},
            transport::{DEPTHS, LEAKS, Table, Transport},
        },
    },
    error::Result,
    gpu::{Device, bind, counts::DeviceWork},
    noise::NoiseTexture,
};

/// Format of the tables of light and of hosts' cover maps.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
/// Format of the map's sheets.
const SHEET: wgpu::TextureFormat = wgpu::TextureFormat::Rg16Float;

/// Counters of the work on these tables: number of updates, and their time.
const COUNTED: [DeviceWork; 2] = [DeviceWork::CloudTables, DeviceWork::CloudTableTime];

/// Creates a texture that shaders read and the CPU fills.
fn texture(
    device: &Device,
    label: &str,
    dimension: wgpu::TextureDimension,
    [width, height, depth_or_array_layers]: [u32; 3],
    (format, mip_level_count): (wgpu::TextureFormat, u32),
) -> wgpu::Texture {
    device.device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width, height, depth_or_array_layers },
        mip_level_count,
        sample_count: 1,
        dimension,
        format,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    })
}

/// Writes numbers as half floats into one mip level of a texture, into the box that begins at `x` and `y`.
fn write_halves(
    device: &Device,
    (texture, mip_level): (&wgpu::Texture, u32),
    (x, y): (u32, u32),
    [width, height, depth_or_array_layers]: [u32; 3],
    numbers: impl Iterator<Item = f32>,
) {
    let halves: Vec<u16> = numbers.map(|v| f16::from_f32(v).to_bits()).collect();
    let texel = 2 * u32::from(texture.format().components());
    device.write_texture(
        wgpu::TexelCopyTextureInfo { mip_level, origin: wgpu::Origin3d { x, y, z: 0 }, ..texture.as_image_copy() },
        bytemuck::cast_slice(&halves),
        wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(texel * width), rows_per_image: Some(height) },
        wgpu::Extent3d { width, height, depth_or_array_layers },
    );
}

/// Creates the texture of the map. It has two layers, one for each sheet that
/// [`crate::clouds::field::extinction::Field`] reads. A texel has the gradient noise and the cellular noise of its
/// sheet, all that one look-up needs.
fn sheets(device: &Device, map: &Map) -> wgpu::TextureView {
    let levels = map.levels();
    let size = |level: usize| [(MAP_SIZE >> level) as u32, (MAP_SIZE >> level) as u32, 2];
    let made = texture(device, "cloud map", wgpu::TextureDimension::D2, size(0), (SHEET, levels.len() as u32));
    for (level, texels) in levels.iter().enumerate() {
        let sheet = |i: usize| texels.iter().flat_map(move |texel| [texel[i], texel[i + 2]]);
        write_halves(device, (&made, level as u32), (0, 0), size(level), sheet(0).chain(sheet(1)));
    }
    bind::as_layers(&made)
}

/// Creates the texture that holds the hosts' cover maps, one below the other.
fn placed(device: &Device, label: &str, (width, height): (u32, u32)) -> wgpu::TextureView {
    texture(device, label, wgpu::TextureDimension::D2, [width, height, 1], (FORMAT, 1)).create_view(&Default::default())
}

/// Creates a sampler that interpolates linearly.
pub(crate) fn sampler(device: &Device, address: wgpu::AddressMode) -> wgpu::Sampler {
    device.device.create_sampler(&wgpu::SamplerDescriptor {
        address_mode_u: address,
        address_mode_v: address,
        address_mode_w: address,
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        mipmap_filter: wgpu::MipmapFilterMode::Linear,
        ..Default::default()
    })
}

/// Tables of light in two media, by depth above, depth below and leak rate. Each medium has three tables side by side:
/// under the beam on the top of a box of cloud, under the beam on its side, and under the sky. The media lie one below
/// the other.
pub(crate) struct LightTables {
    /// Texture with all tables.
    texture: wgpu::Texture,
    /// Media of the tables: droplets (0) and ice (1).
    pub media: [Arc<Transport>; 2],
    /// Cosine of the sun's zenith angle for which the tables hold; `None` if the next update has to compute all of
    /// them.
    under: Option<f64>,
}

impl LightTables {
    /// Creates empty tables for two media: droplets and ice.
    pub fn new(device: &Device, media: [Arc<Transport>; 2]) -> Self {
        let size = [3 * DEPTHS as u32, 2 * DEPTHS as u32, LEAKS as u32];
        let texture = texture(device, "light in clouds", wgpu::TextureDimension::D3, size, (FORMAT, 1));
        Self { texture, media, under: None }
    }

    /// Returns a view of all of the texture.
    pub fn view(&self) -> wgpu::TextureView {
        self.texture.create_view(&Default::default())
    }

    /// Replaces the medium with index `which` (0 droplets, 1 ice). The next update computes all tables again.
    fn replace(&mut self, which: usize, medium: Arc<Transport>) {
        self.media[which] = medium;
        self.under = None;
    }

    /// Updates the tables for a sun with this cosine of its zenith angle, if the cosine has changed by `SUN_MOVED` or
    /// more.
    pub fn update(&mut self, device: &Device, cosine: f64) {
        let cosine = cosine.clamp(-1.0, 1.0);
        if self.under.is_some_and(|c| (c - cosine).abs() < SUN_MOVED) {
            return;
        }
        let begun = Instant::now();
        let across = DEPTHS as u32;
        for (i, medium) in self.media.iter().enumerate() {
            let put = |column: u32, table: &Table| {
                let (at, size) = ((column * across, i as u32 * across), [across, across, LEAKS as u32]);
                write_halves(device, (&self.texture, 0), at, size, table.iter().flatten().copied());
            };
            put(0, &medium.under_beam(cosine.abs()));
            put(1, &medium.under_beam((1.0 - cosine * cosine).sqrt()));
            if self.under.is_none() {
                put(2, &medium.under_sky());
            }
        }
        self.under = Some(cosine);
        device.counts.add_timed(COUNTED, begun);
    }
}

/// Look-up tables of clouds, with the samplers that read them: map, solid noise, light, and hosts' cover maps.
pub(crate) struct CloudTables {
    /// Map of where clouds grow.
    pub map: wgpu::TextureView,
    /// Solid noise that frays the edges of clouds.
    pub solid: NoiseTexture,
    /// Tables of light scattered more than once.
    pub light: LightTables,
    /// Linear sampler that repeats.
    pub repeating: wgpu::Sampler,
    /// Linear sampler that clamps to the edge.
    pub clamping: wgpu::Sampler,
    /// Diameter of the droplets for which `light` holds, um.
    liquid_um: f64,
    /// Texture with the hosts' cover maps, one below the other.
    pub placed: wgpu::TextureView,
    /// Maps that `placed` holds, from top to bottom.
    in_placed: Vec<Arc<LayerMap>>,
}

impl CloudTables {
    pub fn new(device: &Arc<Device>, seed: u64) -> Result<Self> {
        let begun = Instant::now();
        let liquid_um = 20.0;
        let media = media(liquid_um);
        let tables = Self {
            map: sheets(device, &Map::new(seed)),
            solid: NoiseTexture::new(device, [SOLID_SIZE; 3], &[solid_settings(seed)])?,
            repeating: sampler(device, wgpu::AddressMode::Repeat),
            clamping: sampler(device, wgpu::AddressMode::ClampToEdge),
            liquid_um,
            light: LightTables::new(device, media),
            placed: placed(device, "no maps of layers of cloud", (1, 1)),
            in_placed: Vec::new(),
        };
        device.counts.add_timed(COUNTED, begun);
        Ok(tables)
    }

    /// Draws the solid noise if it is missing. Updates the tables for a sun with this cosine of its zenith angle and
    /// for droplets of this diameter, um.
    pub fn update(&mut self, device: &Device, encoder: &mut wgpu::CommandEncoder, cosine: f64, liquid_um: f64) {
        // Draws all of the noise at once: if clouds' edges frayed only later, the clouds would jump.
        self.solid.step(encoder, u32::MAX);
        if liquid_um != self.liquid_um {
            let begun = Instant::now();
            self.liquid_um = liquid_um;
            self.light.replace(0, droplets(liquid_um));
            device.counts.add_timed(COUNTED, begun);
        }
        self.light.update(device, cosine);
    }

    /// Writes hosts' cover maps into the texture if it does not hold them yet. Returns whether the texture had to be
    /// created again.
    pub fn place<'a>(&mut self, device: &Device, maps: impl Iterator<Item = &'a Arc<LayerMap>> + Clone) -> bool {
        let is_same = |(a, b): (&Arc<LayerMap>, &Arc<LayerMap>)| Arc::ptr_eq(a, b);
        if maps.clone().count() == self.in_placed.len() && maps.clone().zip(&self.in_placed).all(is_same) {
            return false;
        }
        let sizes = maps.clone().map(|made| made.map.cells);
        let size = sizes.fold((1, 0), |(width, height): (u32, u32), [x, y]| (width.max(x), height + y));
        let before = self.placed.texture().size();
        let is_other = (before.width, before.height) != (size.0, size.1.max(1));
        if is_other {
            self.placed = placed(device, "maps of layers of cloud", (size.0, size.1.max(1)));
        }
        let mut row = 0;
        for made in maps.clone() {
            let ([width, height], numbers) = (made.map.cells, made.texels.iter().flatten().copied());
            write_halves(device, (self.placed.texture(), 0), (0, row), [width, height, 1], numbers);
            row += height;
        }
        self.in_placed.clear();
        self.in_placed.extend(maps.cloned());
        is_other
    }

    /// Returns the bytes of GPU memory in use.
    pub fn bytes(&self) -> u64 {
        let (map, light) = (8 * MAP_SIZE * MAP_SIZE * 4 / 3, 8 * 6 * LEAKS * DEPTHS * DEPTHS);
        let placed = self.placed.texture().size();
        (map + light) as u64 + (SOLID_SIZE as u64).pow(3) + 8 * u64::from(placed.width) * u64::from(placed.height)
    }
}
