//! Shadows of clouds: the share of the direct light that clouds let through to a place, in f64.
//! `shaders/clouds/shadow.wgsl` draws it as a map.
//!
//! # Model
//! The light goes straight through each layer above the place and is attenuated by the cloud on its path (Beer's law).
//! Over the length of a ray through the clouds the planet counts as flat.
//!
//! # Error
//! The map of pictures is compared with this function by `cargo test --test clouds shadow -- --nocapture`.

use glam::DVec3;

use crate::{clouds::field::extinction::Field, moment::Scene};

/// Steps along the path through a layer.
const STEPS: usize = 32;
/// Sine of the lowest elevation for which shadows are traced. Below it, rays leave the range within which single clouds
/// can be told apart.
pub const LOWEST: f64 = 0.03;

/// Returns the optical depth of a layer on the path of light to `place_m` (m east, north and above the sea). `to_light`
/// is the unit vector towards the light.
pub(super) fn depth(field: &Field<'_>, place_m: DVec3, to_light: DVec3) -> f64 {
    let s = &field.shape;
    let (from, to) = ((s.base_m - place_m.z).max(0.0), s.base_m + s.thickness_m - place_m.z);
    if to <= from {
        return 0.0;
    }
    let step = (to - from) / STEPS as f64;
    // The path leads upwards even to a light below the horizon.
    let to_light = to_light.with_z(to_light.z.max(LOWEST));
    let slant = to_light / to_light.z;
    let at = |i: usize| field.extinction_per_m(place_m + slant * (from + (i as f64 + 0.5) * step));
    (0..STEPS).map(at).sum::<f64>() * step / to_light.z
}

/// Returns the share of the direct light of the brighter of sun and moon that clouds let through to a scene's place, 0
/// to 1.
pub fn sun_share<'a>(fields: impl Iterator<Item = Field<'a>>, scene: &Scene) -> f64 {
    let place_m = DVec3::new(scene.map_m[0], scene.map_m[1], scene.place.altitude_m);
    let to_light = scene.brighter().direction;
    (-fields.map(|field| depth(&field, place_m, to_light)).sum::<f64>()).exp()
}
