//! Projection of the clouds' shadow map around a camera, and the ageing of a map as the clouds change.

use glam::{DVec2, DVec3};

use crate::{
    clouds::{drawn::uniforms::ShadowUniform, field::layers::CloudLayers, light::shadow::LOWEST},
    moment::{Scene, SceneMoment},
    numerics::smoothstep,
    stage::{Frame, FrameFlags},
};

/// Side of the map, texels.
pub(super) const TEXELS: u32 = 512;
/// Size of a texel, m.
const TEXEL_M: f64 = 40.0;
/// Height above the base of the lowest clouds over which shadows blend to the mean share, m; a place at that height is
/// in the clouds. Shaders and snippets have the same number.
const ENDS_M: f64 = 100.0;
/// Sines of the light's elevation between which shadows fade in.
const FADE_SINES: [f64; 2] = [LOWEST, 0.07];
/// Changes between two frames after which nothing of the map is kept: time, s; turn of the light, rad; change of
/// [`ShadowInputs::threshold_sum`].
const LEAPS: (f64, f64, f64) = (10.0, 0.01, 0.05);

/// Distance, m, that the layer with which the map moves may go between two frames. A longer one means that another
/// layer is the lowest now; nothing of the map is kept then. The hash of the cells over rain areas has the same limit.
const LEAP_OF_DRIFT_M: f64 = 1500.0;
/// Changes that make the whole map old:
/// - time, s, in which clouds change by some thousandths of their life;
/// - turn of the light, rad, by which the shadow of a cloud 4 km up moves by a quarter of a texel;
/// - smallest change of a layer's threshold that is visible;
/// - distance that the camera moves, m. It is less than the margin between where the map repeats and where its shadows
///   fade in. The hash of the cells over rain areas has the same limit.
const AGES: (f64, f64, f64, f64) = (4.0, 0.0025, 0.004, 600.0);

/// History of earlier frames that a frame may use.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum HistoryUse {
    /// History of earlier frames, if the view has it.
    Kept,
    /// No history; later frames may use this one.
    Cut,
    /// No history: the frame is a pure function of view and time.
    None,
}

impl HistoryUse {
    /// Returns the use that a frame makes of history, by its flags.
    pub fn of(frame: &Frame<'_>) -> Self {
        match frame.flags {
            flags if flags.has(FrameFlags::NO_HISTORY) => Self::None,
            flags if flags.has(FrameFlags::CUT) => Self::Cut,
            _ => Self::Kept,
        }
    }
}

/// Inputs of the map in a frame, to detect changes.
#[derive(Clone, Copy, PartialEq)]
pub(crate) struct ShadowInputs {
    /// Simulation time, s.
    pub time_s: f64,
    /// Unit vector towards the light (east, north, up).
    pub to_light: DVec3,
    /// Sum over the layers of the threshold plus the base in km.
    pub threshold_sum: f64,
    /// Distance that the lowest layer, with which the map moves, has drifted, m east and north.
    pub drift_m: DVec2,
    /// Position of the camera, m east and north of the world's origin.
    pub camera_m: DVec2,
    /// Fingerprint of the local cover (`field::placed`): a hash of the cells over areas, and a number that differs for
    /// another map.
    pub placed: (f64, usize),
}

/// Projection of the map around a camera.
#[derive(Clone, Copy)]
pub(crate) struct ShadowProjection {
    /// Inputs from which the projection was created.
    pub inputs: ShadowInputs,
    /// Unit vector towards the light, never level.
    pub to_light: DVec3,
    /// Altitude of the map's plane, m.
    plane_m: f64,
    /// Position of the camera in the map, in periods.
    pub camera: DVec2,
    /// Height of the camera above the plane, m.
    pub eye_m: f64,
    /// Period of the map, m.
    pub period_m: f64,
    /// Mean share of the direct light over all places, 0 to 1.
    mean: f64,
    /// Weight of the map against the mean share, 0 to 1.
    pub map_weight: f64,
    /// Height above the plane, m, at and above which the mean share holds.
    pub top_m: f64,
    /// Extinction of the air at the camera's height, 1/m, and its scale height, m.
    haze: [f64; 2],
}

/// Returns the extinction of the air for green light at a scene's height, 1/m, and the scale height of this extinction
/// there, m.
fn haze(scene: &Scene) -> [f64; 2] {
    let (planet, h) = (&scene.planet, scene.place.altitude_m.max(0.0));
    let of = |extinction: f64, height_m: f64| (extinction * libm::exp(-h / height_m), height_m);
    let parts = [
        of(planet.rayleigh.scattering_per_m[1], planet.rayleigh.scale_height_m),
        of(planet.mie.extinction_per_m[1], planet.mie.scale_height_m),
    ];
    let sum = parts.iter().map(|(extinction, _)| extinction).sum::<f64>().max(1e-9);
    [sum, sum / parts.iter().map(|(extinction, height_m)| extinction / height_m).sum::<f64>().max(1e-12)]
}

impl ShadowProjection {
    /// Creates the projection for a moment's camera, light and clouds.
    pub fn new(now: &SceneMoment<'_>, overhead: &CloudLayers) -> Self {
        let shapes = overhead.layers().iter().map(|layer| &layer.shape);
        let scene = &now.scene;
        let plane_m = scene.conditions.air.station_altitude_m;
        let light = scene.brighter();
        let drift_m = shapes.clone().next().map_or(DVec2::ZERO, |s| s.drift_m);
        let period_m = TEXEL_M * f64::from(TEXELS);
        let camera = (DVec2::from_array(scene.map_m) - drift_m) / period_m;
        let lowest_m = shapes.clone().map(|s| s.base_m).fold(f64::INFINITY, f64::min);
        Self {
            inputs: ShadowInputs {
                time_s: now.time_s,
                to_light: light.direction,
                threshold_sum: shapes.map(|s| s.threshold + s.base_m / 1000.0).sum(),
                camera_m: DVec2::from_array(scene.map_m),
                drift_m,
                placed: overhead.fingerprint(),
            },
            to_light: light.direction.with_z(light.direction.z.max(LOWEST)),
            plane_m,
            camera: DVec2::new(camera.x.rem_euclid(1.0), camera.y.rem_euclid(1.0)),
            eye_m: scene.place.altitude_m - plane_m,
            period_m,
            mean: light.direct_share,
            map_weight: smoothstep(FADE_SINES[0], FADE_SINES[1], light.direction.z),
            top_m: (lowest_m - plane_m).max(0.0) + ENDS_M,
            haze: haze(scene),
        }
    }

    /// Returns the block that shaders read.
    pub fn uniform(&self) -> ShadowUniform {
        ShadowUniform {
            to_light: self.to_light.as_vec3().to_array(),
            plane: self.plane_m as f32,
            camera: self.camera.as_vec2().to_array(),
            period: self.period_m as f32,
            eye: self.eye_m as f32,
            mean: self.mean as f32,
            map_weight: self.map_weight as f32,
            top: self.top_m as f32,
            haze: self.haze[0] as f32,
            haze_height: self.haze[1] as f32,
            pad: [0.0; 3],
        }
    }
}

impl ShadowInputs {
    /// Whether a map drawn from `earlier` is wholly out of date.
    pub fn leaps_from(&self, earlier: &Self) -> bool {
        let (time_s, turn, threshold) = LEAPS;
        (self.time_s - earlier.time_s).abs() > time_s
            || self.to_light.dot(earlier.to_light) < turn.cos()
            || (self.threshold_sum - earlier.threshold_sum).abs() > threshold
            || self.drift_m.distance(earlier.drift_m) > LEAP_OF_DRIFT_M
            || self.placed.1 != earlier.placed.1
            || (self.placed.0 - earlier.placed.0).abs() > LEAP_OF_DRIFT_M
            || self.camera_m.distance(earlier.camera_m) > 0.1 * TEXEL_M * f64::from(TEXELS)
    }

    /// Returns the share of a map's rows that the change since `earlier` makes old.
    pub fn aged_since(&self, earlier: &Self) -> f64 {
        let (time_s, turn, threshold, way_m) = AGES;
        let shares = [
            (self.time_s - earlier.time_s).abs() / time_s,
            self.to_light.distance(earlier.to_light) / turn,
            (self.threshold_sum - earlier.threshold_sum).abs() / threshold,
            self.camera_m.distance(earlier.camera_m) / way_m,
            (self.placed.0 - earlier.placed.0).abs() / way_m,
        ];
        shares.into_iter().fold(0.0, f64::max)
    }
}
