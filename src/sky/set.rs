//! The finished tables of one planet, which all that show it share.

use std::sync::{Arc, OnceLock};

use super::Planet;
use super::level::Detail;
use super::light::LightTable;
use super::passes::SkyTable;
use super::recipe::Name;
use super::settings::SkySettings;
use super::uniforms::AirUniform;
use crate::error::Result;
use crate::gpu::Device;

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
    pub(super) results: Vec<(Name, SkyTable)>,
    /// Its light on the CPU, once it was asked for.
    pub(super) light: OnceLock<Arc<LightTable>>,
}

impl TableSet {
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
pub(super) fn find(results: &[(Name, SkyTable)], name: Name) -> &SkyTable {
    &results.iter().find(|(n, _)| *n == name).unwrap_or(&results[0]).1
}
