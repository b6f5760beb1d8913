//! A layer of cloud over a place, and the share of it that is drawn as a volume.

use super::shape::Shape;
use crate::weather::CloudSlab;

/// Index of the medium of ice.
pub(crate) const ICE: usize = 1;

/// A layer of cloud over a place. `share` of it is drawn as a volume, the rest as a deck.
#[derive(Clone, Copy)]
pub(crate) struct OverheadLayer {
    /// Shape of the clouds, from `slab` and the air.
    pub shape: Shape,
    /// Slab from which the layer comes: one of the weather's, or that of the cells over rain areas.
    pub slab: CloudSlab,
    /// Slot of the layer in `Conditions::clouds`; for the cells over rain areas, a slot without cover.
    pub slot: usize,
    /// Share of the layer that is drawn as a volume, 0 to 1.
    pub share: f64,
}

impl OverheadLayer {
    /// Returns the index of the layer's medium: 0 for droplets, [`ICE`] for ice.
    pub fn medium(&self) -> usize {
        if self.slab.ice_fraction > 0.5 { ICE } else { 0 }
    }
}
