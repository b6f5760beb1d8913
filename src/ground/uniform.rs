//! Uniform block of the shaders of wet ground: `GroundUniform` of `shaders/ground/uniform.wgsl`, and its inputs for a
//! frame.

use std::f64::consts::PI;

use glam::{DMat3, DVec2, DVec3};

use super::{
    class::{CLASSES, SurfaceClass, SurfaceLook},
    hollows::{Hollows, PERIOD_M, WAVES, pattern_axes},
    reference::{WATER_OUTSIDE, fresnel_water, normal_quantile, ring_drops_per_m2_s},
    window::DrawnTerrain,
};
use crate::{
    falling::{
        drops::factor_in,
        sizes::{DropSizes, SMALLEST_MM, Weight},
    },
    moment::Scene,
    numerics::smoothstep,
    surroundings::SnowHere,
    weather::{Falling, SurfaceCover, snow_cover},
};

/// Side of a cell of the rings' grid, m. This constant and the two that follow have the same values in
/// `shaders/ground/hollows.wgsl` (tested).
const RING_CELL_M: f64 = 0.2;
/// Length of a time slot of the rings, s.
const RING_SLOT_S: f64 = 0.6;
/// Number of layers of rings.
const RING_LAYERS: f64 = 4.0;

/// Root mean square slope of a thin film, along one axis. It is large because a thin film hardly fills the grain of
/// asphalt.
const THIN_FILM_SLOPE: f64 = 0.3;
/// Root mean square slope of a closed film, along one axis.
const CLOSED_FILM_SLOPE: f64 = 0.15;
/// Mean square slope of puddles by wind, as a share of that of the open sea (Cox & Munk 1954: 0.00512 per m/s, both
/// axes together). It is small because puddles are only a few metres long.
const PUDDLE_SHARE_OF_SEA: f64 = 0.03;
/// Mean square slope of puddles by the rings of drops, per mm/h of rain up to 50 mm/h.
const RING_SLOPE2_PER_MM_H: f64 = 2e-4;

/// Uniform block `GroundUniform` of `shaders/ground/uniform.wgsl`, whose comments describe each field.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct GroundUniform {
    pub to_lamp: [f32; 3],
    pub soaked: f32,
    pub lamp_lux: [f32; 3],
    pub level: f32,
    pub sky_lux: [f32; 3],
    pub entering: f32,
    pub ground_light: [f32; 3],
    pub film_level: f32,
    pub axis_u: [f32; 3],
    pub place_u: f32,
    pub axis_v: [f32; 3],
    pub place_v: f32,
    pub cell: [u32; 2],
    pub slot: u32,
    pub slot_share: f32,
    pub film_slope: f32,
    pub water_slope: f32,
    pub ring_chance: f32,
    pub most: f32,
    pub pixel: [f32; 2],
    pub depth_step: f32,
    pub depth_ulp: f32,
    pub curvature: f32,
    pub ring_slope2: f32,
    pub disc2: f32,
    pub glaze: f32,
    pub wind: [f32; 3],
    pub fog_depth: f32,
    pub falls: [[f32; 4]; 3],
    pub terrain_x: [f32; 4],
    pub terrain_y: [f32; 4],
    pub terrain_z: [f32; 4],
    pub terrain_last: [f32; 2],
    pub terrain_rim: f32,
    pub terrain_near: f32,
    pub normal_x: [f32; 4],
    pub normal_y: [f32; 4],
    pub normal_z: [f32; 4],
    pub snow: [f32; 4],
    pub sea: [f32; 4],
    pub looks: [SurfaceLook; CLASSES],
    pub phases: [[f32; 4]; WAVES / 4],
}

impl GroundUniform {
    /// Returns whether drops make rings in standing water.
    pub fn has_rings(&self) -> bool {
        self.ring_chance > 0.0 || self.ring_slope2 > 0.0
    }
}

/// Inputs of [`GroundUniform`] for a frame.
pub(crate) struct WetScene<'a> {
    pub scene: &'a Scene,
    /// Wetness and puddles of the ground at the camera.
    pub cover: &'a SurfaceCover,
    /// Snow on level, open ground.
    pub snow: SnowHere,
    /// Whether the terrain's cells have snow of their own; otherwise the snow of level, open ground lies on them.
    pub terrain_has_snow: bool,
    /// Precipitation on the ground.
    pub falling: Falling,
    /// Share of level ground under clear ice.
    pub glaze: f64,
    pub hollows: &'a Hollows,
    /// Position of the camera in the host's world, m.
    pub position: DVec3,
    /// Time of the frame, s.
    pub time_s: f64,
    /// Curvature of the planet, 1/m; 0 for a flat world.
    pub curvature: f64,
    /// Optical depth of the fog straight up.
    pub fog_depth: f64,
    /// Height above the camera of the highest crests of the drawn sea, m; `None` without a drawn sea.
    pub sea_top_m: Option<f64>,
    /// Steps in normalised device coordinates from a pixel to the one on its right and to the one below it.
    pub pixel: [f64; 2],
    /// Rounding error of the host's depth: absolute, and relative to the value.
    pub depth_rounding: [f64; 2],
    /// Limit of the light in a pixel, cd/m^2.
    pub most_cd_m2: f64,
    /// Velocity of the air that carries the rain, (east, north, up), m/s; `None` if there are no shelters and no
    /// occluder maps.
    pub wind_m_s: Option<DVec3>,
    /// Terrain of the host around the camera.
    pub terrain: Option<DrawnTerrain>,
    /// Surface class of ground for which the host gives none.
    pub surface_class: SurfaceClass,
    /// Rotation from the axes of the host's image of normals to east, north, up; and the scale and the offset that
    /// decode the numbers in the image.
    pub normals: (DMat3, [f32; 2]),
}

/// Width, in cells, of the border zone in which a terrain fades into the level, open ground around it. On a small
/// terrain the zone is a quarter of the shorter side.
const TERRAIN_RIM: f64 = 2.0;
/// Largest distance from a terrain at which a surface still belongs to the terrain: a constant part, m, and a share of
/// the cell size.
const NEAR_TERRAIN: [f64; 2] = [0.25, 0.25];

/// Returns the share of soaked pores at this wetness, and the share of the ground that a film covers.
fn look_of(wetness: f64) -> (f64, f64) {
    (smoothstep(0.0, 0.3, wetness), smoothstep(0.3, 1.0, wetness))
}

/// Level that is deeper than any hollow, in units of the root mean square depth. At this level no water stands.
/// `NO_LEVEL` of `shaders/ground/hollows.wgsl` has the same value (tested).
const NO_LEVEL: f32 = 1000.0;

/// Height of the sea's crests above the camera if there is no sea, m: no surface lies as low.
const NO_SEA_M: f32 = -1e9;

/// Returns the level of the water that covers the share `covered` of the ground: the depth that the hollows exceed on
/// this share, in units of their root mean square depth.
fn level_of(covered: f64) -> f32 {
    if covered <= 0.0 { NO_LEVEL } else { normal_quantile(1.0 - covered.min(1.0)) as f32 }
}

/// Cache of values that depend on the drop sizes alone, kept while the precipitation is unchanged: sums over all sizes
/// would cost more than the rest of a frame's recording. The values do not depend on altitude: a rain rate makes
/// equally many rings everywhere, and one factor scales all fall speeds.
#[derive(Default)]
pub(crate) struct DropsKept {
    /// Precipitation and the rate at which it makes rings, 1/(m^2 s).
    rings: Option<(Falling, f64)>,
    /// Precipitation and the fall speeds at sea level, m/s, of the drops in the middle of each twelfth of its water.
    falls: Option<(Falling, [f64; 12])>,
}

impl DropsKept {
    /// Returns the number of rings that drops make per square metre and second ([`ring_drops_per_m2_s`]).
    fn rings_per_m2_s(&mut self, falling: &Falling) -> f64 {
        let kept = self.rings.filter(|(of, _)| of == falling);
        kept.unwrap_or_else(|| *self.rings.insert((*falling, ring_drops_per_m2_s(&DropSizes::new(falling, 1.0))))).1
    }

    /// Returns the fall speeds of the drops in the middle of each twelfth of the falling water; without rain, those of
    /// steady rain of 3 mm/h.
    fn falls_m_s(&mut self, scene: &Scene) -> [[f32; 4]; 3] {
        let c = &scene.conditions;
        let mut falling = c.precipitation;
        if falling.rain_mm_h + falling.drizzle_mm_h <= 0.0 {
            falling.rain_mm_h = 3.0;
        }
        let kept = self.falls.filter(|(of, _)| *of == falling);
        let (_, speeds) = kept.unwrap_or_else(|| {
            let sizes = DropSizes::new(&falling, 1.0);
            let middles = std::array::from_fn::<f64, 12, _>(|i| (i as f64 + 0.5) / 12.0);
            let speeds = sizes.diameters(Weight::Water, SMALLEST_MM, middles).map(|d| sizes.speed_m_s(d));
            *self.falls.insert((falling, speeds))
        });
        let factor = factor_in(&c.air, scene.place.altitude_m);
        std::array::from_fn(|i| std::array::from_fn(|k| (factor * speeds[4 * i + k]) as f32))
    }
}

impl WetScene<'_> {
    /// Computes the block of the ground.
    pub fn uniform(&self, drops: &mut DropsKept) -> GroundUniform {
        let (scene, cover) = (self.scene, self.cover);
        let rain = self.falling.rain_mm_h;
        let lamp = scene.brighter();
        let lamp_lux = if std::ptr::eq(lamp, &scene.sun) { scene.ground.sun_lux } else { scene.ground.moon_lux };
        let (soaked, film) = look_of(cover.wetness);
        let wind2 = 0.5 * 0.00512 * PUDDLE_SHARE_OF_SEA * scene.conditions.wind.speed_m_s();
        let axes = pattern_axes(&scene.world_to_enu);
        let at = DVec2::from(axes.map(|a| a.dot(self.position)));
        let near = at.rem_euclid(DVec2::splat(PERIOD_M));
        let cell = (near / RING_CELL_M).floor();
        let slots = self.time_s / RING_SLOT_S;
        let rings = drops.rings_per_m2_s(&self.falling);
        let [u, v] = axes.map(|a| (scene.world_to_enu * a).as_vec3().to_array());
        let f = |c: [f64; 3]| c.map(|v| v as f32);
        let (rows, last, cell_m) = self.terrain_rows();
        let (turned, decode) = &self.normals;
        let normals =
            [0, 1, 2].map(|i| turned.row(i).extend(decode.get(i).map_or(0.0, |d| f64::from(*d))).as_vec4().to_array());
        GroundUniform {
            to_lamp: lamp.apparent.as_vec3().to_array(),
            soaked: soaked as f32,
            lamp_lux: f(lamp_lux),
            level: level_of(cover.puddles),
            sky_lux: f(scene.ground.sky_lux),
            entering: self.entering(lamp.apparent.z, lamp_lux[1]) as f32,
            ground_light: f([0, 1, 2].map(|i| {
                let light = lamp_lux[i] * lamp.apparent.z.max(0.0) + scene.ground.sky_lux[i];
                0.5 * scene.ground_albedo[i] * light / PI
            })),
            film_level: level_of(film),
            axis_u: u,
            place_u: (near.x - cell.x * RING_CELL_M) as f32,
            axis_v: v,
            place_v: (near.y - cell.y * RING_CELL_M) as f32,
            cell: [cell.x as u32, cell.y as u32],
            slot: slots.floor().rem_euclid(f64::from(1u32 << 28)) as u32,
            slot_share: (slots - slots.floor()) as f32,
            film_slope: (THIN_FILM_SLOPE + (CLOSED_FILM_SLOPE - THIN_FILM_SLOPE) * film) as f32,
            water_slope: wind2.sqrt() as f32,
            ring_chance: (rings * RING_CELL_M * RING_CELL_M * RING_SLOT_S / RING_LAYERS).min(1.0) as f32,
            pixel: self.pixel.map(|v| v as f32),
            depth_step: self.depth_rounding[0] as f32,
            depth_ulp: self.depth_rounding[1] as f32,
            most: self.most_cd_m2 as f32,
            curvature: self.curvature as f32,
            ring_slope2: (RING_SLOPE2_PER_MM_H * rain.min(50.0)) as f32,
            disc2: (lamp.angular_radius / 4.0).powi(2) as f32,
            glaze: self.glaze as f32,
            wind: self.wind_m_s.map_or([0.0; 3], |w| w.as_vec3().to_array()),
            fog_depth: self.fog_depth as f32,
            falls: self.wind_m_s.map_or([[0.0; 4]; 3], |_| drops.falls_m_s(scene)),
            terrain_x: rows[0],
            terrain_y: rows[1],
            terrain_z: rows[2],
            terrain_last: last.map(|v| v as f32),
            terrain_rim: (0.25 * last[0].min(last[1])).min(TERRAIN_RIM) as f32,
            terrain_near: (NEAR_TERRAIN[0] + NEAR_TERRAIN[1] * cell_m) as f32,
            normal_x: normals[0],
            normal_y: normals[1],
            normal_z: normals[2],
            snow: {
                let own = if self.terrain_has_snow { self.snow.depth_m as f32 } else { -1.0 };
                let level = level_of(snow_cover(self.snow.depth_m));
                [level, self.snow.wetness as f32, self.snow.albedo as f32, own]
            },
            sea: [self.sea_top_m.map_or(NO_SEA_M, |top| top as f32), 0.0, 0.0, 0.0],
            looks: self.looks(),
            phases: self.hollows.seen_from(at),
        }
    }

    /// Returns the look of each class. The first entry is the context's default class with a `level` of 0: ground that
    /// the host has not classified may be a hill.
    fn looks(&self) -> [SurfaceLook; CLASSES] {
        let mut looks = SurfaceClass::ALL.map(SurfaceClass::surface_look);
        looks[0] = SurfaceLook { level: 0.0, ..self.surface_class.surface_look() };
        looks
    }

    /// Returns the block's rows of the terrain, the indices of the terrain's last node, and the size of a cell.
    fn terrain_rows(&self) -> ([[f32; 4]; 3], [f64; 2], f64) {
        let Some(grid) = &self.terrain else { return ([[0.0; 4]; 3], [1.0; 2], 1.0) };
        let turned = grid.to_enu * self.scene.world_to_enu.transpose();
        let eye = grid.to_enu * (self.position - grid.origin);
        let row = |i: usize, unit: f64| (turned.row(i).extend(eye[i]) / unit).as_vec4().to_array();
        let last = grid.nodes.map(|n| f64::from(n - 1));
        ([row(0, grid.cell_m), row(1, grid.cell_m), row(2, 1.0)], last, grid.cell_m)
    }

    /// Returns the share of the light on level ground that enters a water surface.
    fn entering(&self, lamp_z: f64, lamp_lux: f64) -> f64 {
        let (lamp, sky) = (lamp_lux * lamp_z.max(0.0), self.scene.ground.sky_lux[1].max(1e-9));
        let kept = lamp * fresnel_water(lamp_z.clamp(0.0, 1.0)) + sky * WATER_OUTSIDE;
        1.0 - kept / (lamp + sky)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::shader;

    #[test]
    fn offsets_agree_with_the_shader() {
        shader::assert_layout!(
            "ground/uniform.wgsl",
            "GroundUniform",
            GroundUniform,
            [
                to_lamp,
                soaked,
                lamp_lux,
                level,
                sky_lux,
                entering,
                ground_light,
                film_level,
                axis_u,
                place_u,
                axis_v,
                place_v,
                cell,
                slot,
                slot_share,
                film_slope,
                water_slope,
                ring_chance,
                most,
                pixel,
                depth_step,
                depth_ulp,
                curvature,
                ring_slope2,
                disc2,
                wind,
                sea,
                fog_depth,
                falls,
                phases,
                glaze,
                terrain_x,
                terrain_y,
                terrain_z,
                terrain_last,
                terrain_rim,
                terrain_near,
                normal_x,
                normal_y,
                normal_z,
                snow,
                looks
            ]
        );
    }

    #[test]
    fn constants_agree_with_the_shader() {
        let text = shader::assemble("ground/surface.wgsl").unwrap();
        let cells = (PERIOD_M / RING_CELL_M) as u32;
        let look = SurfaceClass::Vegetation.surface_look();
        let numbers: [f32; 8] = bytemuck::cast(look);
        let plants =
            format!("const PLANTS: SurfaceLook = SurfaceLook({});", numbers.map(|v| format!("{v:?}")).join(", "));
        for line in [
            format!("const SURFACE_CLASSES: u32 = {CLASSES}u;"),
            plants,
            format!("const RING_CELL: f32 = {RING_CELL_M};"),
            format!("const RING_CELLS: u32 = {cells}u;"),
            format!("const RING_SLOT: f32 = {RING_SLOT_S};"),
            format!("const NO_LEVEL: f32 = {NO_LEVEL:?};"),
            format!("const RING_LAYERS: u32 = {RING_LAYERS}u;"),
            format!("const THIN_FILM_SLOPE: f32 = {THIN_FILM_SLOPE};"),
            format!("const CLOSED_FILM_SLOPE: f32 = {CLOSED_FILM_SLOPE};"),
        ] {
            assert!(text.contains(&line), "{line}");
        }
    }
}
