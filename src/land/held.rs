//! Drawn terrain of a context: its settings.

use super::settings::TerrainDrawing;
use crate::{terrain::SurfaceClass, world::HeldEffect};

/// Settings of the drawn terrain, which all views share. They are the host's, and are not saved.
#[derive(Default)]
pub(crate) struct HeldLand {
    /// `None` where the host draws its terrain itself.
    pub drawing: Option<TerrainDrawing>,
    /// Class of cells for which the host gives none; the same as the ground's default class.
    pub surface_class: SurfaceClass,
}

impl HeldEffect for HeldLand {}
