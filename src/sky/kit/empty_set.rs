//! Creation of a planet's tables: empty ones for a build, and mixes of two sets.

use std::sync::{
    Arc, OnceLock,
    atomic::{AtomicU64, Ordering},
};

use bytemuck::{bytes_of, cast_slice};

use super::Kit;
use crate::error::Result;
use crate::planet::{Planet, spectral::parts};
use crate::sky::level::Detail;
use crate::sky::passes::{SkyTable, uniform_buffer};
use crate::sky::recipe::Name;
use crate::sky::set::{TableSet, find};
use crate::sky::settings::MOST_WAVELENGTHS;
use crate::sky::uniforms::AirUniform;
use crate::sky::way::{LightWay, between};

impl Kit {
    /// Creates the tables of a planet, empty.
    ///
    /// # Errors
    /// Fails if the number of wavelengths in the settings is out of range.
    pub(super) fn empty_set(&self, planet: &Planet, detail: Detail) -> Result<TableSet> {
        static SETS: AtomicU64 = AtomicU64::new(0);
        let device = &self.device;
        let level = self.level(detail);
        let table = |n: &Name| (*n, SkyTable::new(device, &format!("sky {n:?}"), n.result_size(&level.settings)));
        let results: Vec<_> = Name::RESULTS.iter().map(table).collect();
        let air = uniform_buffer(device, "sky air", bytes_of(&AirUniform::of(planet)));
        let mut each = AirUniform::of_parts(&parts(planet, self.settings.wavelengths)?);
        // A build reads the sources of one triple at a time.
        let alone = |a: &AirUniform| AirUniform { layer: 0.0, layers: 1.0, ..*a };
        let buffer = |a| uniform_buffer(device, "sky air of a triple", bytes_of(&alone(a)));
        let airs = each.iter().map(buffer).collect();
        each.resize(MOST_WAVELENGTHS as usize / 3, AirUniform::of(planet));
        let all = uniform_buffer(device, "sky airs", cast_slice(&each));
        let of = |name: Name| &find(&results, name).view;
        let sources = [of(Name::Sources), of(Name::OnceGas), of(Name::OnceHaze)];
        Ok(TableSet {
            planet: *planet,
            detail,
            id: SETS.fetch_add(1, Ordering::Relaxed),
            mixes: None,
            observer_group: self.observer_layouts.planet_group(
                device,
                [&air, &level.blocks.dims, &all],
                &self.builder.sampler,
                sources,
            ),
            light_group: self.fades.group(device, of(Name::Lights)),
            airs,
            results,
            light: OnceLock::new(),
        })
    }

    /// Returns tables that mix two sets of the same detail; `weight` is the weight of the second set. The mix is used
    /// for an air between the airs of both sets.
    ///
    /// # Errors
    /// As [`Kit::empty_set`].
    pub fn mixed(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        [first, second]: [&TableSet; 2],
        weight: f32,
    ) -> Result<Arc<TableSet>> {
        let share = LightWay::new(&first.planet, &second.planet).share(f64::from(weight));
        let planet = between(&first.planet, &second.planet, share);
        let mut set = self.empty_set(&planet, first.detail)?;
        for name in Name::RESULTS {
            let group = |from: &TableSet| self.fades.group(&self.device, &from.result(name).view);
            self.fades.between(encoder, &set.result(name).view, [&group(first), &group(second)], weight);
        }
        set.mixes = Some((first.id, (second.id, weight)));
        Ok(Arc::new(set))
    }
}
