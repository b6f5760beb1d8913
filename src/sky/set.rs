//! The finished tables of one planet, which all that show it share.

use std::sync::{
    Arc, OnceLock,
    atomic::{AtomicU64, Ordering},
};

use bytemuck::{bytes_of, cast_slice};

use super::Planet;
use super::kit::Kit;
use super::level::Detail;
use super::light::LightTable;
use super::passes::{SkyTable, uniform_buffer};
use super::recipe::Name;
use super::settings::{MOST_WAVELENGTHS, SkySettings};
use super::uniforms::AirUniform;
use crate::error::Result;
use crate::gpu::Device;
use crate::planet::spectral::parts;

/// One planet's tables, and how observers and fades read them.
pub(crate) struct TableSet {
    pub planet: Planet,
    pub detail: Detail,
    /// Unique to each set.
    pub id: u64,
    /// The air at each triple of wavelengths.
    pub airs: Vec<wgpu::Buffer>,
    /// Group 0 of the observers' passes.
    pub observer_group: wgpu::BindGroup,
    /// The light, for a fade.
    pub light_group: wgpu::BindGroup,
    results: Vec<(Name, SkyTable)>,
    /// Its light on the CPU, once it was asked for.
    light: OnceLock<Arc<LightTable>>,
}

impl TableSet {
    /// Empty tables.
    ///
    /// # Errors
    /// For a planet whose wavelengths are no set.
    pub fn new(kit: &Kit, planet: &Planet, detail: Detail) -> Result<Self> {
        static SETS: AtomicU64 = AtomicU64::new(0);
        let device = &kit.device;
        let level = kit.level(detail);
        let table = |n: &Name| (*n, SkyTable::new(device, &format!("sky {n:?}"), n.result_size(&level.settings)));
        let results: Vec<_> = Name::RESULTS.iter().map(table).collect();
        let air = uniform_buffer(device, "sky air", bytes_of(&AirUniform::of(planet)));
        let mut each = AirUniform::of_parts(&parts(planet, kit.settings.wavelengths)?);
        // A build has one triple's sources before it at a time.
        let alone = |a: &AirUniform| AirUniform { layer: 0.0, layers: 1.0, ..*a };
        let buffer = |a| uniform_buffer(device, "sky air of a triple", bytes_of(&alone(a)));
        let airs = each.iter().map(buffer).collect();
        each.resize(MOST_WAVELENGTHS as usize / 3, AirUniform::of(planet));
        let all = uniform_buffer(device, "sky airs", cast_slice(&each));
        let of = |name: Name| &find(&results, name).view;
        let sources = [of(Name::Sources), of(Name::OnceGas), of(Name::OnceHaze)];
        Ok(Self {
            planet: *planet,
            detail,
            id: SETS.fetch_add(1, Ordering::Relaxed),
            observer_group: kit.observer_layouts.planet_group(
                device,
                [&air, &level.blocks.dims, &all],
                &kit.builder.sampler,
                sources,
            ),
            light_group: kit.fades.group(device, of(Name::Lights)),
            airs,
            results,
            light: OnceLock::new(),
        })
    }

    /// One of [`Name::RESULTS`].
    pub fn result(&self, name: Name) -> &SkyTable {
        find(&self.results, name)
    }

    /// All of them.
    pub fn tables(&self) -> std::slice::Iter<'_, (Name, SkyTable)> {
        self.results.iter()
    }

    /// Fills them with a cache's bytes, in the order of [`Name::RESULTS`].
    pub fn fill(&self, device: &Device, tables: &[Vec<u8>]) {
        for (name, bytes) in Name::RESULTS.iter().zip(tables) {
            let texture = &self.result(*name).texture;
            let layout = wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(texture.width() * 8),
                rows_per_image: None,
            };
            device.queue.write_texture(texture.as_image_copy(), bytes, layout, texture.size());
        }
    }

    /// The light on the CPU, of the size that `settings` say; read back when it is first asked for, which waits for the
    /// GPU.
    pub fn read_light(&self, device: &Device, settings: &SkySettings) -> Result<Arc<LightTable>> {
        if let Some(known) = self.light.get() {
            return Ok(known.clone());
        }
        let read = LightTable::read(device, self.result(Name::Lights), AirUniform::of(&self.planet))?;
        let sized = Arc::new(read.resized(settings.suns as usize, settings.altitudes as usize));
        Ok(self.light.get_or_init(|| sized).clone())
    }
}

/// Made of exactly these names; the first stands in for one that cannot be asked for.
fn find(results: &[(Name, SkyTable)], name: Name) -> &SkyTable {
    &results.iter().find(|(n, _)| *n == name).unwrap_or(&results[0]).1
}
