//! Resistance of the ground to a tool that cuts it.

use super::{
    field::SoilCell,
    laws::{CuttingForce, CuttingInputs, cohesion_share, cutting_force},
    site::SoilSite,
    tool::SoilToolId,
};
use crate::error::{Error, Result};

/// Blade of a tool, as it meets the soil.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SoilBlade {
    /// Angle of the blade to the horizontal in the direction of motion, radians, in \[0.05, 2.6\]; pi/2 is upright.
    pub rake: f64,
    /// Friction angle between soil and blade, radians, in \[0, 1.2\]; steel on soil has about 0.4.
    pub soil_metal: f64,
    /// Adhesion of the soil to the blade, kPa, in \[0, 10 000\].
    pub adhesion_kpa: f64,
    /// Load on the surface in front of the blade, kPa, in \[0, 10 000\].
    pub surcharge_kpa: f64,
}

impl SoilSite {
    /// Returns the force on the edge of a tool, for the depth of the cut and the kind of soil of the tool's last step.
    /// The cohesion is that which the water in the soil leaves.
    ///
    /// # Errors
    /// [`crate::error::Status::InvalidArgument`] for an unknown tool, or naming a field of `blade` that
    /// [`cutting_force`] does not accept for this soil.
    pub fn resistance(&self, tool: SoilToolId, blade: &SoilBlade) -> Result<CuttingForce> {
        let report = self.report(tool)?;
        let pose = self.tool_pose(tool).ok_or_else(|| Error::range("tool", "a tool of this site", tool.0))?;
        let middle = 0.5 * (pose.edge[0] + pose.edge[1]) / self.desc().cell_m;
        let found = self.field.find([middle.x.round() as i32, middle.y.round() as i32]);
        let water = found.map_or(self.field.water, |SoilCell { slot, .. }| self.field.patch(slot).water);
        let kind = self.field.materials.kinds[report.cut_kind.index()].kind;
        cutting_force(&CuttingInputs {
            rake: blade.rake,
            soil_metal: blade.soil_metal,
            friction: kind.friction_deg.to_radians(),
            density_kg_m3: kind.density_kg_m3,
            cohesion_kpa: kind.cohesion_kpa * cohesion_share(water.saturation),
            adhesion_kpa: blade.adhesion_kpa,
            surcharge_kpa: blade.surcharge_kpa,
            width_m: (pose.edge[1] - pose.edge[0]).length(),
            depth_m: report.cut_depth_m,
        })
        .map_err(|e| e.map_field(|field| format!("blade.{field}")))
    }
}
