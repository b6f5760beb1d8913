//! Finished tables of one planet, shared by all that show it.

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

/// Tables of one planet, and the bind groups with which observers and fades read them.
pub(crate) struct TableSet {
    pub planet: Planet,
    pub detail: Detail,
    /// Number that is unique to each set.
    pub id: u64,
    /// Ids of the two sets that this set mixes, and the share of the second. `None` unless this set was made by
    /// [`Kit::mixed`](super::kit::Kit::mixed).
    pub mixes: Option<(u64, (u64, f32))>,
    /// Air at each triple of wavelengths.
    pub airs: Vec<wgpu::Buffer>,
    /// Group 0 of the observers' passes.
    pub observer_group: wgpu::BindGroup,
    /// Bind group of the light, for a fade.
    pub light_group: wgpu::BindGroup,
    pub(super) results: Vec<(Name, SkyTable)>,
    /// Light on the CPU, once it has been requested.
    pub(super) light: OnceLock<Arc<LightTable>>,
}

impl TableSet {
    /// Table of one of the [`Name::RESULTS`].
    pub fn result(&self, name: Name) -> &SkyTable {
        find(&self.results, name)
    }

    /// All tables of the set.
    pub fn tables(&self) -> std::slice::Iter<'_, (Name, SkyTable)> {
        self.results.iter()
    }

    /// Fills the tables with bytes from a cache file, in the order of [`Name::RESULTS`].
    pub fn fill(&self, device: &Device, tables: &[Vec<u8>]) {
        for (name, bytes) in Name::RESULTS.iter().zip(tables) {
            let texture = &self.result(*name).texture;
            let layout = wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(texture.width() * 8),
                rows_per_image: None,
            };
            device.write_texture(texture.as_image_copy(), bytes, layout, texture.size());
        }
    }

    /// Light on the CPU, in the sizes of `settings`. The first call reads it back, which waits for the GPU.
    pub fn read_light(&self, device: &Device, settings: &SkySettings) -> Result<Arc<LightTable>> {
        if let Some(known) = self.light.get() {
            return Ok(known.clone());
        }
        let read = LightTable::read(device, self.result(Name::Lights), AirUniform::of(&self.planet))?;
        let sized = Arc::new(read.resized(settings.suns as usize, settings.altitudes as usize));
        Ok(self.light.get_or_init(|| sized).clone())
    }
}

/// Finds the table `name` among the results. Returns the first table for a name that is not among them, which never
/// happens.
pub(super) fn find(results: &[(Name, SkyTable)], name: Name) -> &SkyTable {
    &results.iter().find(|(n, _)| *n == name).unwrap_or(&results[0]).1
}
