//! Noise that clouds are cut out of, for the host's queries, with caches of the light in clouds and of layers under
//! maps.

use std::sync::{Arc, Mutex};

use glam::DVec3;

use crate::{
    clouds::{
        field::{extinction::Field, layer_map::LayerMaps, layers::CloudLayers, map::Map, solid::Solid},
        light::{media::SUN_MOVED, sources::Sources, transport::Transport},
    },
    error::Result,
};

/// Noise that clouds are cut out of, with the light that was last asked for.
pub(crate) struct CloudNoise {
    pub map: Map,
    pub solid: Solid,
    /// Light for each medium.
    lit: [Mutex<Option<LitMedium>>; 2],
    pub maps: Mutex<LayerMaps>,
}

/// Light in a medium under a sun.
struct LitMedium {
    medium: Arc<Transport>,
    sources: Arc<Sources>,
}

impl CloudNoise {
    /// Creates the noise of a seed.
    ///
    /// # Errors
    /// As [`Solid::new`].
    pub fn new(seed: u64) -> Result<Self> {
        Ok(Self { map: Map::new(seed), solid: Solid::new(seed)?, lit: Default::default(), maps: Mutex::default() })
    }

    /// Returns the clouds of the layer with an index in [`CloudLayers::all`].
    pub fn field(&self, overhead: &CloudLayers, layer: usize) -> Field<'_> {
        let placed = overhead.placed(layer);
        Field { shape: overhead.all()[layer].shape, map: &self.map, solid: &self.solid, placed }
    }

    /// Returns the tables of light in one of the two media under a sun.
    pub fn sources(&self, which: usize, medium: &Arc<Transport>, to_sun: DVec3) -> Arc<Sources> {
        // The light stays valid after a panic in another thread.
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
