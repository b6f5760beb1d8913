//! Noise that gives clouds their shapes, for the host's queries, with caches of the light in clouds and of layers under
//! cover maps.

use std::sync::{Arc, Mutex};

use glam::DVec3;

use crate::{
    clouds::{
        field::{extinction::Field, layer_map::LayerMaps, layers::CloudLayers, map::Map, solid::Solid},
        light::{media::SUN_MOVED, sources::Sources, transport::Transport},
    },
    error::Result,
};

/// Noise that gives clouds their shapes, and caches.
pub(crate) struct CloudNoise {
    /// Map of where clouds grow.
    pub map: Map,
    /// Solid noise that frays the edges of clouds.
    pub solid: Solid,
    /// Light that was last computed for droplets, and for ice.
    lit: [Mutex<Option<LitMedium>>; 2],
    /// Cache of the last used layers under cover maps.
    pub maps: Mutex<LayerMaps>,
}

/// Light in a medium under a sun.
struct LitMedium {
    /// Medium for which `sources` was computed.
    medium: Arc<Transport>,
    /// Tables for this medium, and the sun for which they were computed.
    sources: Arc<Sources>,
}

impl CloudNoise {
    /// Creates the noise of a seed.
    ///
    /// # Errors
    /// [`crate::Status::OutOfMemory`] if there is no memory for the noise.
    pub fn new(seed: u64) -> Result<Self> {
        Ok(Self { map: Map::new(seed), solid: Solid::new(seed)?, lit: Default::default(), maps: Mutex::default() })
    }

    /// Returns the clouds of the layer with index `layer` in [`CloudLayers::all`].
    pub fn field(&self, overhead: &CloudLayers, layer: usize) -> Field<'_> {
        let placed = overhead.placed(layer);
        Field { shape: overhead.all()[layer].shape, map: &self.map, solid: &self.solid, placed }
    }

    /// Returns the tables of light in a medium (0 droplets, 1 ice) under a sun in the direction `to_sun` (east, north,
    /// up). Cached tables serve as long as the sun is within [`SUN_MOVED`] (as a distance of unit vectors) of theirs.
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
