//! Uniform block and instances of the drawn terrain, as `shaders/land/` reads them.

use glam::{DMat3, DMat4, DVec3};

use super::{
    eye::LandEye,
    light::LandLight,
    materials::{CLASS_MATERIALS, MATERIALS, Material, OCTAVES, Octave, octaves},
    relief::LEVELS,
    selection::LevelDistances,
};

/// Number of shadow maps.
pub(super) const CASCADES: usize = 4;

/// Constants of a shadow map. `shaders/land/uniform.wgsl` has their meaning.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub(super) struct CascadeUniform {
    pub u: [f32; 4],
    pub v: [f32; 4],
    pub depth: [f32; 4],
    pub size: [f32; 4],
    pub texel: [f32; 4],
}

/// Constants of the shadows. `shaders/land/uniform.wgsl` has their meaning.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub(super) struct LandShadowUniform {
    pub cascades: [CascadeUniform; CASCADES],
    pub shaded: [f32; 4],
}

/// Constants of a picture. `shaders/land/uniform.wgsl` has the units.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub(super) struct LandUniform {
    pub clip: [f32; 16],
    pub to_local: [[f32; 4]; 3],
    pub eye: [f32; 4],
    pub cell_m: f32,
    pub above: f32,
    pub spread: f32,
    pub altitude: f32,
    pub curvature: f32,
    pub has_dug: u32,
    pub pad: [f32; 2],
    pub levels: [[f32; 4]; LEVELS],
    pub sun: [f32; 4],
    pub sun_lux: [f32; 4],
    pub moon: [f32; 4],
    pub moon_lux: [f32; 4],
    pub sky_lux: [f32; 4],
    pub bounce_lux: [f32; 4],
    pub materials: [Material; MATERIALS],
    pub octaves: [Octave; OCTAVES],
    pub shadow: LandShadowUniform,
}

/// One patch of a picture.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub(super) struct PatchInstance {
    /// South-western corner, in cells from the cell below the eye.
    pub low: [i32; 2],
    /// Slot of the page.
    pub slot: u32,
    /// Level in bits 0 to 7, quarter of the node in bits 8 and 9, whether the page has holes in bit 10.
    pub kind: u32,
}

/// Camera, light and settings of a picture whose patches and pages are ready.
pub(super) struct LandPicture {
    pub eye: LandEye,
    pub detail: LevelDistances,
    pub cell_m: f64,
    /// Rotation from the lattice's axes to east, north, up at the camera.
    pub to_local: DMat3,
    /// Curvature of the planet, 1/m; 0 in a flat world.
    pub curvature: f64,
    /// Altitude of the terrain's origin above the sea, m.
    pub altitude_m: f64,
    /// Whether the pages have colours of dug soil.
    pub has_dug: bool,
    pub light: LandLight,
    /// Distance up to which the ground has shadows, m; 0 for none.
    pub shadows_to_m: f64,
}

fn four(v: DVec3) -> [f32; 4] {
    [v.x as f32, v.y as f32, v.z as f32, 0.0]
}

fn lux(v: [f64; 3]) -> [f32; 4] {
    [v[0] as f32, v[1] as f32, v[2] as f32, 0.0]
}

impl LandPicture {
    /// Returns the constants for a draw, without those of the shadow maps. `clip` is the matrix from camera-relative
    /// east, north, up to clip space, `top` the level of the largest nodes.
    pub fn uniform(&self, clip: DMat4, top: u8) -> LandUniform {
        let metres = self.eye_m();
        LandUniform {
            clip: (clip * DMat4::from_mat3(self.to_local)).as_mat4().to_cols_array(),
            to_local: [0, 1, 2].map(|i| four(self.to_local.col(i))),
            eye: self.eye.uniform(),
            cell_m: self.cell_m as f32,
            above: self.detail.above as f32,
            spread: self.detail.spread as f32,
            altitude: self.altitude_m as f32,
            curvature: self.curvature as f32,
            has_dug: self.has_dug.into(),
            pad: [0.0; 2],
            levels: std::array::from_fn(|level| self.level(level, top)),
            sun: four(self.light.sun),
            sun_lux: lux(self.light.sun_lux),
            moon: four(self.light.moon),
            moon_lux: lux(self.light.moon_lux),
            sky_lux: lux(self.light.sky_lux),
            bounce_lux: lux(self.light.bounce_lux),
            materials: CLASS_MATERIALS,
            octaves: octaves(metres),
            shadow: LandShadowUniform::default(),
        }
    }

    /// Distance from the eye, cells, at which the vertices of a level begin to move, and 1 over the distance over which
    /// they move. The second value is 0 for the largest nodes, whose vertices do not move.
    fn level(&self, level: usize, top: u8) -> [f32; 4] {
        let [start, end] = self.detail.morph(level);
        let moves = level < usize::from(top);
        [start as f32, if moves { (1.0 / (end - start)) as f32 } else { 0.0 }, 0.0, 0.0]
    }

    /// Place of the eye along the lattice's axes from its origin, m.
    pub fn eye_m(&self) -> DVec3 {
        let place = self.eye.place;
        DVec3::new(place.x * self.cell_m, place.y * self.cell_m, place.z)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::shader;

    #[test]
    fn offsets_agree_with_the_shader() {
        shader::assert_layout!(
            "land/land.wgsl",
            "LandUniform",
            LandUniform,
            [
                clip, to_local, eye, cell_m, above, spread, altitude, curvature, has_dug, levels, sun, sun_lux, moon,
                moon_lux, sky_lux, bounce_lux, materials, octaves, shadow
            ]
        );
        shader::assert_layout!("land/land.wgsl", "Material", Material, [albedo, fine, broad]);
        shader::assert_layout!("land/land.wgsl", "LandShadow", LandShadowUniform, [cascades, shaded]);
        shader::assert_layout!("land/land.wgsl", "Cascade", CascadeUniform, [u, v, depth, size, texel]);
        shader::assert_layout!("land/land.wgsl", "Octave", Octave, [cell, place, turn]);
    }
}
