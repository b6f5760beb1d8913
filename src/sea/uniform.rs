//! Uniform block of the sea's shaders: `SeaUniform` of `shaders/sea/uniform.wgsl`, whose comments describe each field.

use std::f64::consts::PI;

use glam::{DMat4, DVec2, DVec3};

use super::{
    drawn::{DrawnSums, TileUniform},
    foam::FoamLaw,
    foam_uniform::FoamUniform,
    mesh::MeshEye,
    model::SeaStatistics,
    slopes::cox_munk,
    tiles::TILES,
    water::{body_reflectance, fresnel_reflectance},
};
use crate::{
    moment::{Light, Scene},
    world::World,
};

/// Block of a frame.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub(super) struct SeaUniform {
    pub clip: [f32; 16],
    pub foot: [f32; 3],
    pub height: f32,
    pub east: [f32; 3],
    pub waves: u32,
    pub north: [f32; 3],
    pub pixel: f32,
    pub bend_xx: [f32; 3],
    pub foam_from: f32,
    pub bend_xy: [f32; 3],
    pub compression: f32,
    pub bend_yy: [f32; 3],
    pub fog_depth: f32,
    pub eye: [f32; 2],
    pub most: f32,
    pub disc2: f32,
    pub to_lamp: [f32; 3],
    pub index: f32,
    pub lamp_lux: [f32; 3],
    pub seen_per_octave: f32,
    pub sky_lux: [f32; 3],
    pub squeeze: f32,
    pub body: [f32; 3],
    pub pad_c: f32,
    pub white: [f32; 3],
    pub pad_d: f32,
    pub slopes: [f32; 4],
    pub tiles: [TileUniform; TILES],
    pub foam: FoamUniform,
}

/// Map around a camera: the camera-relative place (east, north, up) of the sea's level as a function of the place on
/// the map, by a Taylor series of second order. In a curved world its error is 0.03 mm at 1 km and 3 m at 50 km.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SeaChart {
    /// Place of the sea's level below the camera.
    pub foot: DVec3,
    /// Derivatives to the east and to the north.
    pub east: DVec3,
    pub north: DVec3,
    /// Second derivatives: half of that by east and east, that by east and north, half of that by north and north.
    pub bend: [DVec3; 3],
}

/// Step of the derivatives, m.
const CHART_STEP_M: f64 = 2000.0;

impl SeaChart {
    /// Finds the chart around a camera that is at `eye` of the host's world, and at `place_m` of the map.
    pub fn new(world: &World, scene: &Scene, eye: DVec3, (place_m, level_m): (DVec2, f64)) -> Self {
        let at = |x: f64, y: f64| {
            let place = place_m + CHART_STEP_M * DVec2::new(x, y);
            scene.world_to_enu * (world.position_on_map(place, level_m) - eye)
        };
        let foot = at(0.0, 0.0);
        let [e, w, n, s] = [at(1.0, 0.0), at(-1.0, 0.0), at(0.0, 1.0), at(0.0, -1.0)];
        let corners = at(1.0, 1.0) + at(-1.0, -1.0) - at(1.0, -1.0) - at(-1.0, 1.0);
        let square = CHART_STEP_M * CHART_STEP_M;
        Self {
            foot,
            east: (e - w) / (2.0 * CHART_STEP_M),
            north: (n - s) / (2.0 * CHART_STEP_M),
            bend: [
                (e + w - 2.0 * foot) / (2.0 * square),
                corners / (4.0 * square),
                (n + s - 2.0 * foot) / (2.0 * square),
            ],
        }
    }

    /// Returns the camera-relative place of a place on the map. `m` is its offset in metres from the camera's place on
    /// the map.
    pub fn at(&self, m: DVec2) -> DVec3 {
        let [xx, xy, yy] = self.bend;
        self.foot + self.east * m.x + self.north * m.y + xx * (m.x * m.x) + xy * (m.x * m.y) + yy * (m.y * m.y)
    }
}

/// Inputs of the block.
pub(super) struct DrawnSea<'a> {
    pub scene: &'a Scene,
    pub chart: SeaChart,
    pub eye: MeshEye,
    pub statistics: SeaStatistics,
    pub tiles: [TileUniform; TILES],
    pub sums: DrawnSums,
    /// Number of single waves.
    pub waves: usize,
    pub foam: FoamLaw,
    pub fog_depth: f64,
}

fn f(v: DVec3) -> [f32; 3] {
    v.as_vec3().to_array()
}

fn f3(v: [f64; 3]) -> [f32; 3] {
    v.map(|v| v as f32)
}

impl DrawnSea<'_> {
    /// Returns the block, except for the fields of a picture ([`SeaUniform::set_picture`]).
    pub fn uniform(&self) -> SeaUniform {
        let (scene, stats) = (self.scene, &self.statistics);
        let lamp = scene.brighter();
        let lamp_lux = if std::ptr::eq(lamp, &scene.sun) { scene.ground.sun_lux } else { scene.ground.moon_lux };
        let (water, white) = self.diffuse(lamp, lamp_lux);
        let [xx, xy, yy] = self.chart.bend;
        SeaUniform {
            foot: f(self.chart.foot),
            height: self.eye.height_m as f32,
            east: f(self.chart.east),
            waves: self.waves as u32,
            north: f(self.chart.north),
            bend_xx: f(xx),
            foam_from: self.foam.from.min(1e3) as f32,
            bend_xy: f(xy),
            compression: self.foam.variance as f32,
            bend_yy: f(yy),
            fog_depth: self.fog_depth as f32,
            eye: (self.eye.place_m - self.eye.anchor_m()).as_vec2().to_array(),
            disc2: (lamp.angular_radius / 4.0).powi(2) as f32,
            to_lamp: f(lamp.apparent),
            index: stats.refractive_index as f32,
            lamp_lux: f3(lamp_lux),
            seen_per_octave: (1.0 / libm::log2((self.eye.reach_m / self.eye.height_m).max(2.0))) as f32,
            sky_lux: f3(scene.ground.sky_lux),
            squeeze: (self.sums.compression / (self.sums.slopes[0] + self.sums.slopes[2]).max(1e-12)) as f32,
            body: f3(water),
            white: f3(white),
            slopes: self.slopes(),
            tiles: self.tiles,
            foam: FoamUniform::new(&self.foam, self.eye.anchor_m(), self.wind_m_s(), stats.mean_from_deg),
            ..SeaUniform::default()
        }
    }

    /// Returns the covariances of all slopes, and the variance of those that are drawn. Ripples that are too short to
    /// be drawn have the rest of the sea's mean square slope, in the proportions of Cox and Munk (1954) along and
    /// across the wind.
    fn slopes(&self) -> [f32; 4] {
        let [xx, xy, yy] = self.sums.slopes;
        let drawn = xx + yy;
        let rest = (self.statistics.mean_square_slope - drawn).max(0.0);
        let v = cox_munk(self.wind_m_s());
        let upwind = if v.total() > 0.0 { rest * v.upwind / v.total() } else { 0.5 * rest };
        let across = rest - upwind;
        let (sin, cos) = libm::sincos(self.statistics.mean_from_deg.to_radians());
        let along = upwind - across;
        [xx + across + along * sin * sin, xy + along * sin * cos, yy + across + along * cos * cos, drawn]
            .map(|v| v as f32)
    }

    /// Returns the wind that gives the sea's mean square slope, m/s (Cox and Munk 1954).
    fn wind_m_s(&self) -> f64 {
        (self.statistics.mean_square_slope - 0.003).max(0.0) / 0.005_12
    }

    /// Returns the luminance of the light out of the water, seen from above, and that of a white surface, cd/m^2.
    fn diffuse(&self, lamp: &Light, lamp_lux: [f64; 3]) -> ([f64; 3], [f64; 3]) {
        let index = self.statistics.refractive_index;
        let up = lamp.apparent.z.max(0.0);
        let body = body_reflectance(self.statistics.attenuation_per_m, index);
        let entering = 1.0 - fresnel_reflectance(up, index);
        let sky = self.scene.ground.sky_lux;
        let light = [0, 1, 2].map(|i| {
            // Colours run from blue to red in the water's laws.
            let direct = lamp_lux[i] * up;
            (body[2 - i] * (entering * direct + 0.934 * sky[i]) / PI, (direct + sky[i]) / PI)
        });
        (light.map(|l| l.0), light.map(|l| l.1))
    }
}

impl SeaUniform {
    /// Sets the fields of a picture: its clip space, the angle of a pixel, and its largest luminance, cd/m^2.
    pub fn set_picture(&mut self, clip: &DMat4, pixel_angle: f64, most_cd_m2: f64) {
        self.clip = clip.as_mat4().to_cols_array();
        (self.pixel, self.most) = (pixel_angle as f32, most_cd_m2 as f32);
    }
}

#[cfg(test)]
mod tests {
    use super::{
        super::{
            drawn::{MOST_WAVES, WaveUniform},
            fft::SIDE,
            hull::MAX_SEA_HULLS,
            mesh::{CELLS, CELLS_TO_DISTANCE, FINEST_M, MORPH},
            outline::MAX_OUTLINE_CORNERS,
            regions::MAX_SEA_REGIONS,
            seen::{FLAT_MIP, LEAST_CELLS, MOST_LENGTHENED, PIXEL_DEVIATION, SEEN_SIDES, SMOOTH_CELLS, SeaBand},
            seen_regions::{RegionUniform, SHELTERED_REGION},
            seen_wakes::{MOST_TRACK_STATES, StateUniform, WakeUniform},
            track::MOST_NODES,
        },
        *,
    };
    use crate::gpu::shader;

    #[test]
    fn offsets_agree_with_the_shader() {
        shader::assert_layout!(
            "sea/uniform.wgsl",
            "SeaUniform",
            SeaUniform,
            [
                clip,
                foot,
                height,
                east,
                waves,
                north,
                pixel,
                bend_xx,
                foam_from,
                bend_xy,
                compression,
                bend_yy,
                fog_depth,
                eye,
                most,
                disc2,
                to_lamp,
                index,
                lamp_lux,
                seen_per_octave,
                sky_lux,
                squeeze,
                body,
                white,
                slopes,
                tiles,
                foam
            ]
        );
        shader::assert_layout!(
            "sea/uniform.wgsl",
            "SeaTile",
            TileUniform,
            [anchor, turn, length, lowering, is_there, octaves]
        );
        shader::assert_layout!(
            "sea/uniform.wgsl",
            "SeaWave",
            WaveUniform,
            [turns, phase, height, turns_per_m, length, shift, age_step]
        );
        shader::assert_layout!("sea/uniform.wgsl", "SeaFoam", FoamUniform, [kept, lace, streaks, second, gathered]);
        shader::assert_layout!("sea/uniform.wgsl", "SeaBand", SeaBand, [first, last, regions, is_open, wakes]);
        shader::assert_layout!("sea/uniform.wgsl", "HullState", StateUniform, [place, velocity, age, turn, ahead]);
        shader::assert_layout!(
            "sea/uniform.wgsl",
            "SeaWake",
            WakeUniform,
            [middle, reach2, states, length, beam, draught, newest, oldest, least_turns, first]
        );
        shader::assert_layout!(
            "sea/uniform.wgsl",
            "SeaRegion",
            RegionUniform,
            [anchor, reach2, kind, turn, corners, wave_share, rim]
        );
    }

    #[test]
    fn shaders_have_the_constants_of_the_mesh() {
        let text = shader::assemble("sea/surface.wgsl").unwrap();
        for (name, value) in [
            ("SEA_TILES: u32", format!("{TILES}u")),
            ("SEA_SIDE: f32", format!("{SIDE}.0")),
            ("MOST_SEA_WAVES: u32", format!("{MOST_WAVES}u")),
            ("MOST_SEA_REGIONS: u32", format!("{MAX_SEA_REGIONS}u")),
            ("MOST_OUTLINE_CORNERS: u32", format!("{MAX_OUTLINE_CORNERS}u")),
            ("MOST_SEA_HULLS: u32", format!("{MAX_SEA_HULLS}u")),
            ("MOST_TRACK_STATES: u32", format!("{MOST_TRACK_STATES}u")),
            ("MOST_WAKE_STATES: u32", format!("{MOST_NODES}u")),
            ("SHELTERED_REGION: u32", format!("{SHELTERED_REGION}u")),
            ("SEA_FINEST: f32", FINEST_M.to_string()),
            ("SEA_CELLS: u32", format!("{CELLS}u")),
            ("SEA_MORPH_FROM: f32", MORPH[0].to_string()),
            ("SEA_MORPH_UNTIL: f32", MORPH[1].to_string()),
            ("SEA_CELLS_TO_DISTANCE: f32", format!("{CELLS_TO_DISTANCE:?}")),
            ("SEA_LEAST_CELLS: f32", format!("{LEAST_CELLS:?}")),
            ("SEA_FLAT_MIP: f32", format!("{FLAT_MIP:?}")),
            ("SEA_SMOOTH_CELLS: f32", format!("{SMOOTH_CELLS:?}")),
            ("SEA_PIXEL_DEVIATION: f32", format!("{PIXEL_DEVIATION:?}")),
            ("SEA_MOST_LENGTHENED: f32", format!("{MOST_LENGTHENED:?}")),
            ("SEA_SEEN: vec2f", format!("vec2f({:?}, {:?})", SEEN_SIDES[0] as f32, SEEN_SIDES[1] as f32)),
        ] {
            let line = format!("const {name} = {value};");
            assert!(text.contains(&line), "{line}");
        }
    }
}
