//! Soil that shows in a cell: its colour, and the share of the cell that it covers.
//!
//! Loose soil has the mean colour of its kinds by mass, a cut or pressed bank that of the layer at its surface. A thin
//! layer does not hide what grows there, so the share grows with the depth up to [`COVERS_M`].

use std::sync::LazyLock;

use super::{
    material::{DEPTH_UNITS, SoilMaterials},
    patch::SoilPatch,
};
use crate::{light::tone::srgb_encode, terrain::DugColor};

/// Depth of loose soil that hides everything below it, and depth of a cut that removes all that grew there, m: about
/// that of turf.
const COVERS_M: f64 = 0.03;
/// Number of steps of the table [`CODES`].
const STEPS: usize = 1024;
/// Codes of sRGB by the square root of the linear value, in [`STEPS`] steps, within 0.2 of a code. It is a table
/// because many cells change in a step of digging.
static CODES: LazyLock<[u8; STEPS + 1]> =
    LazyLock::new(|| std::array::from_fn(|i| (255.0 * srgb_encode((i as f64 / STEPS as f64).powi(2))).round() as u8));

/// Soil that shows in a cell.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct ShownSoil {
    /// Linear Rec. 709 albedo.
    pub albedo: [f64; 3],
    /// Share of the cell that the soil covers, 0 to 1.
    pub share: f64,
}

impl ShownSoil {
    /// Soil that shows in a cell of a patch.
    pub fn of(patch: &SoilPatch, cell: usize, materials: &SoilMaterials) -> Self {
        let bank = materials.kinds[materials.bank_kind(patch.cut[cell])].kind.albedo;
        if patch.loose[cell] == 0 && !patch.is_disturbed(cell) {
            return Self { albedo: bank, share: 0.0 };
        }
        let covered = |depth: i64| (depth as f64 / (COVERS_M * DEPTH_UNITS)).clamp(0.0, 1.0);
        let (loose, bare) = (covered(patch.loose[cell]), covered(patch.cut[cell] + patch.press(cell).sunk));
        let below = bare * (1.0 - loose);
        let share = loose + below;
        let (mut heap, mut mass) = ([0.0; 3], 0.0);
        for (kind, own) in patch.loose_masses(cell) {
            let albedo = materials.kinds[kind].kind.albedo;
            heap.iter_mut().zip(albedo).for_each(|(sum, albedo)| *sum += own as f64 * albedo);
            mass += own as f64;
        }
        let lying = |i: usize| if mass > 0.0 { heap[i] / mass } else { bank[i] };
        Self { albedo: [0, 1, 2].map(|i| (loose * lying(i) + below * bank[i]) / share.max(1e-9)), share }
    }

    /// Soil below the undug surface.
    pub fn of_surface(materials: &SoilMaterials) -> Self {
        Self { albedo: materials.kinds[materials.bank_kind(0)].kind.albedo, share: 1.0 }
    }

    /// Returns the colour for the tiles of a terrain.
    pub fn color(&self) -> DugColor {
        let code = |v: f64| CODES[(v.clamp(0.0, 1.0).sqrt() * STEPS as f64).round() as usize];
        let share = (255.0 * self.share).round() as u8;
        DugColor { albedo: self.albedo.map(|albedo| code(albedo * self.share)), share }
    }
}
