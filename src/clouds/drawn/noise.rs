//! Noise that clouds are cut out of, for questions, with the light in them and the maps of layers that were asked for
//! last.

use std::sync::{Arc, Mutex};

use glam::DVec3;

use crate::{
    clouds::{
        field::{extinction::Field, layer_map::LayerMaps, layers::CloudLayers, map::Map, solid::Solid},
        light::{media::SUN_MOVED, sources::Sources, transport::Transport},
    },
    error::Result,
};

/// Noise that clouds are cut out of, and the light in them that was asked for last.
pub(crate) struct CloudNoise {
    pub map: Map,
    pub solid: Solid,
    /// By medium.
    lit: [Mutex<Option<LitMedium>>; 2],
    pub maps: Mutex<LayerMaps>,
}

/// Light in a medium under a sun.
struct LitMedium {
    medium: Arc<Transport>,
    sources: Arc<Sources>,
}

impl CloudNoise {
    /// Grows the noise of a seed.
    ///
    /// # Errors
    /// As [`Solid::new`].
    pub fn new(seed: u64) -> Result<Self> {
        Ok(Self { map: Map::new(seed), solid: Solid::new(seed)?, lit: Default::default(), maps: Mutex::default() })
    }

    /// The clouds of one of all layers over a place.
    pub fn field(&self, overhead: &CloudLayers, layer: usize) -> Field<'_> {
        let placed = overhead.placed(layer);
        Field { shape: overhead.all()[layer].shape, map: &self.map, solid: &self.solid, placed }
    }

    /// Light in one of the two media, under a sun.
    pub fn sources(&self, which: usize, medium: &Arc<Transport>, to_sun: DVec3) -> Arc<Sources> {
        // After a panic elsewhere the light is made anew.
        let mut lit = self.lit[which].lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        let holds = |of: &&LitMedium| Arc::ptr_eq(&of.medium, medium) && of.sources.to_sun.distance(to_sun) < SUN_MOVED;
        if let Some(of) = lit.as_ref().filter(holds) {
            return of.sources.clone();
        }
        let sources = Arc::new(Sources::new(medium, to_sun));
        *lit = Some(LitMedium { medium: medium.clone(), sources: sources.clone() });
        sources
    }
}
