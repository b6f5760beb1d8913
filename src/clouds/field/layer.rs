//! Layer of cloud over a place, and how much of it is drawn as a volume.

use super::shape::Shape;
use crate::weather::CloudSlab;

/// Number of the medium that is ice.
pub(crate) const ICE: usize = 1;

/// A layer of cloud, and how much of it is drawn as a volume: the rest is drawn as a deck.
#[derive(Clone, Copy)]
pub(crate) struct OverheadLayer {
    pub shape: Shape,
    pub slab: CloudSlab,
    /// Its slot among those of the conditions.
    pub slot: usize,
    pub share: f64,
}

impl OverheadLayer {
    /// Returns the index of its medium: droplets, or ice.
    pub fn medium(&self) -> usize {
        if self.slab.ice_fraction > 0.5 { ICE } else { 0 }
    }
}
