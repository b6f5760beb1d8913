//! Environment of a view for the host's own shaders: the cube map, handed out and filled.

use super::{environment_map::EnvironmentMap, view::View};
use crate::{
    error::Result,
    stage::{Composition, CostItem, DrawContext, Recording, Sampling, Stages},
};

/// Cube map of what stands around the camera, for the host's own shaders; valid until the view is destroyed.
#[derive(Clone, Debug)]
pub struct Environment {
    /// Six faces of RGBA half floats with levels down to one texel, in the order and axes of cube maps (+X -X +Y -Y +Z
    /// -Z), where X, Y and Z are the axes of the host's world. Level m is what a mirror of roughness m over the number
    /// of the last level shows.
    pub texture: wgpu::Texture,
    /// Multiply texels by this to have cd/m^2; 0 before the first frame.
    pub cd_m2_per_unit: f64,
    /// Multiply texels by this to have units of the last frame's colour: of a scene-linear host; for others display
    /// values before the tone curve.
    pub light_scale: f64,
}

impl View {
    /// A cube map of what stands around the camera, for reflections in the host's own things: drawn by the first call
    /// of every frame that has [`Stages::BACKGROUND`] or [`Stages::MEDIUM`], from the first call of this function on.
    ///
    /// # Errors
    /// [`crate::Status::DeviceLost`], or a GPU fault.
    pub fn environment(&mut self) -> Result<Environment> {
        let device = self.device.clone();
        let _entered = device.enter()?;
        let map = match &self.cache.environment {
            Some(map) => map,
            None => {
                let map = EnvironmentMap::new(&device)?;
                device.check_made()?;
                self.cache.environment.insert(Box::new(map))
            }
        };
        let (cd_m2_per_unit, light_scale) = (map.cd_m2_per_unit, map.light_scale);
        Ok(Environment { texture: map.texture.clone(), cd_m2_per_unit, light_scale })
    }

    /// Draws what is due of the cube map, if the host has asked for it.
    pub(super) fn fill_environment(
        &mut self,
        context: &DrawContext<'_>,
        composition: &Composition,
        recording: &mut Recording<'_>,
    ) -> Result<()> {
        let (Some(map), Some((_, group)), Some((_, tables))) =
            (&mut self.cache.environment, &self.cache.bound, &composition.tables())
        else {
            return Ok(());
        };
        let is_seen = composition.stages().has(Stages::BACKGROUND.with(Stages::MEDIUM));
        if !is_seen || map.frame_id == Some(context.frame.frame_id) {
            return Ok(());
        }
        let faces = map.faces_due(context);
        let sampling = Sampling::of(context.picture(), context.frame.depth);
        let composite = self.cache.composite.lock()?;
        let groups = [group, tables, self.cache.surroundings.bind_group()];
        map.draw(recording, faces, (sampling, composition.whole().between), &composite.layouts(sampling), &groups)?;
        recording.ends(CostItem::Veil, true)
    }
}
