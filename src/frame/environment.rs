//! Environment of a view for the host's own shaders: the call that hands out the cube map, and the one that fills it.

use super::{environment_map::EnvironmentMap, view::View};
use crate::{
    error::Result,
    stage::{Composition, CostItem, DrawContext, Recording, Sampling, Stages},
};

/// Cube map of the surroundings of the camera, for the host's own shaders; valid until the view is destroyed.
#[derive(Clone, Debug)]
pub struct Environment {
    /// Six faces of RGBA half floats, with mip levels down to one texel. Order and axes are those of cube maps (+X -X
    /// +Y -Y +Z -Z), where X, Y and Z are the axes of the host's world. Level m is the reflection for a surface of
    /// roughness m / (number of the last level).
    pub texture: wgpu::Texture,
    /// Factor from texels to cd/m^2; 0 before the first frame.
    pub cd_m2_per_unit: f64,
    /// Factor from texels to units of the last frame's colour for a scene-linear host; for other hosts, to display
    /// values before the tone curve. 0 before the first frame.
    pub light_scale: f64,
}

impl View {
    /// Returns a cube map of the surroundings of the camera, for reflections in the host's own objects. Once this
    /// function has been called, each frame draws one face of the map, in the first [`View::record`] of the frame that
    /// draws [`Stages::BACKGROUND`] or [`Stages::MEDIUM`]. All six faces are drawn after a jump of light, weather or
    /// place, and with CUT or NO_HISTORY.
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

    /// Draws those faces of the cube map that are due, if the host has asked for the map.
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
