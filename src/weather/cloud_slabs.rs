//! Cloud layers of a host or a report converted to slabs of water. [`super::cloud_light`] computes their light.

use super::conditions::{CloudSlab, WindProfile};
use super::kinds::{CloudKind, PrecipitationKind};
use super::model::{CloudLayer, MAX_CLOUD_LAYERS, Weather};

/// Composition of a kind of cloud, as means over its depth, and its shape.
struct Substance {
    thickness_m: f64,
    water_g_m3: f64,
    droplet_radius_um: f64,
    convection: f64,
    ice_fraction: f64,
    /// Ratio of the distance from cloud to cloud to the thickness, for layers near the kind's own thickness.
    spacing: f64,
    cellular: f64,
    fibre: f64,
}

/// Returns the composition of a kind of cloud. Water and droplets of stratus and cumulus are those of Diem (1948) and
/// aufm Kampe and Weickmann (1957) as commonly tabulated (stratus 0.2 g/m^3, 7 um; fair-weather cumulus 0.5, 4).
/// Towering cumulus fills half of its layer with the 2.5 g/m^3 of its core; a cumulonimbus is diluted by entrainment.
/// Water and crystal radii of ice clouds follow Heymsfield (2003). Thicknesses are typical of temperate latitudes (WMO
/// cloud atlas). Cells of stratocumulus are some three to five times as wide as deep.
fn substance(kind: CloudKind) -> Substance {
    let s = |[thickness_m, water_g_m3, droplet_radius_um]: [f64; 3],
             convection,
             ice_fraction,
             [spacing, cellular, fibre]: [f64; 3]| Substance {
        thickness_m,
        water_g_m3,
        droplet_radius_um,
        convection,
        ice_fraction,
        spacing,
        cellular,
        fibre,
    };
    match kind {
        CloudKind::Stratus | CloudKind::Unknown => s([300.0, 0.2, 7.0], 0.0, 0.0, [8.0, 0.0, 0.0]),
        CloudKind::Stratocumulus => s([400.0, 0.3, 8.0], 0.2, 0.0, [3.5, 0.7, 0.0]),
        CloudKind::Cumulus => s([500.0, 0.5, 4.0], 0.5, 0.0, [2.0, 0.0, 0.0]),
        CloudKind::ToweringCumulus => s([3000.0, 1.2, 10.0], 0.8, 0.1, [1.5, 0.0, 0.0]),
        CloudKind::Cumulonimbus => s([9000.0, 0.6, 15.0], 1.0, 0.5, [1.5, 0.0, 0.0]),
        CloudKind::Nimbostratus => s([3000.0, 0.3, 10.0], 0.0, 0.3, [3.0, 0.0, 0.0]),
        CloudKind::Altocumulus => s([400.0, 0.1, 8.0], 0.3, 0.0, [1.8, 1.0, 0.0]),
        CloudKind::Altostratus => s([1500.0, 0.05, 10.0], 0.0, 0.5, [4.0, 0.0, 0.2]),
        CloudKind::Cirrus => s([1000.0, 0.005, 30.0], 0.1, 1.0, [5.0, 0.0, 1.0]),
        CloudKind::Cirrostratus => s([1500.0, 0.01, 30.0], 0.0, 1.0, [10.0, 0.0, 0.4]),
        CloudKind::Cirrocumulus => s([300.0, 0.01, 20.0], 0.3, 1.0, [1.2, 1.0, 0.2]),
    }
}

/// Factor by which a layer may be thicker or thinner than is usual for its kind while the distance between its clouds
/// is still proportional to its thickness.
const WIDER: f64 = 3.0;

/// Lowest base of middle clouds, m (WMO levels of temperate latitudes).
const MIDDLE_FROM_M: f64 = 2000.0;
/// Lowest base of high clouds, m.
const HIGH_FROM_M: f64 = 6000.0;

/// Chooses the kind of a layer of unknown kind: by level, by cover (more than half is a sheet), and by its
/// precipitation. `raining` is whether more than drizzle falls from the layer: drizzle does not change the kind.
fn likely_kind(layer: &CloudLayer, raining: bool, showers: bool) -> CloudKind {
    let sheet = layer.cover > 0.5;
    match (layer.base_m, sheet) {
        (b, true) if b < MIDDLE_FROM_M && raining && !showers => CloudKind::Nimbostratus,
        (b, _) if b < MIDDLE_FROM_M && raining && showers => CloudKind::ToweringCumulus,
        (b, true) if b < 450.0 => CloudKind::Stratus,
        (b, true) if b < MIDDLE_FROM_M => CloudKind::Stratocumulus,
        (b, false) if b < 150.0 => CloudKind::Stratus,
        (b, false) if b < MIDDLE_FROM_M => CloudKind::Cumulus,
        (b, true) if b < HIGH_FROM_M => CloudKind::Altostratus,
        (b, false) if b < HIGH_FROM_M => CloudKind::Altocumulus,
        (_, true) => CloudKind::Cirrostratus,
        (_, false) => CloudKind::Cirrus,
    }
}

/// Returns the optical depth of water of `water_path_kg_m2` in droplets of `radius_um`: tau = 3 W / (2 rho r) (Stephens
/// 1978), with the water path W, the radius r and the density rho of water or ice.
pub fn cloud_optical_depth(water_path_kg_m2: f64, radius_um: f64, ice_fraction: f64) -> f64 {
    let density = 1000.0 + (917.0 - 1000.0) * ice_fraction;
    1.5 * water_path_kg_m2 / (density * radius_um * 1e-6)
}

/// Returns the water that a cloud must hold to give a rate of rain, kg/m^2: the rate divided by the rate at which cloud
/// water turns into rain (Kessler 1969). The latter is 1e-3 1/s by coalescence of droplets, plus 2.2 q^0.875 1/s by
/// falling rain that collects droplets. The rain water in the air, q, kg/kg, follows from the rain rate R by Marshall
/// and Palmer's 0.072 R^0.88 g/m^3 with an air density of 1.2 kg/m^3.
pub fn water_path_for_rate_kg_m2(rate_mm_h: f64) -> f64 {
    if rate_mm_h <= 0.0 {
        return 0.0;
    }
    let rain_water = 0.072e-3 * libm::pow(rate_mm_h, 0.88) / 1.2;
    rate_mm_h / 3600.0 / (1e-3 + 2.2 * libm::pow(rain_water, 0.875))
}

/// Converts one layer to a slab, with at least `least_water_kg_m2` of water where there is cloud.
fn slab(layer: &CloudLayer, kind: CloudKind, least_water_kg_m2: f64, wind: &WindProfile) -> CloudSlab {
    let s = substance(kind);
    let thickness = layer.thickness_m.unwrap_or(s.thickness_m);
    let radius = layer.droplet_radius_um.unwrap_or(s.droplet_radius_um);
    let water = (layer.water_g_m3.unwrap_or(s.water_g_m3) * 1e-3 * thickness).max(least_water_kg_m2);
    CloudSlab {
        cover: layer.cover,
        base_m: layer.base_m,
        thickness_m: thickness,
        optical_depth: cloud_optical_depth(water, radius, s.ice_fraction),
        droplet_radius_um: radius,
        asymmetry: 0.85 + (0.77 - 0.85) * s.ice_fraction,
        convection: s.convection,
        ice_fraction: s.ice_fraction,
        scale_m: layer
            .spacing_m
            .unwrap_or_else(|| s.spacing * thickness.clamp(s.thickness_m / WIDER, s.thickness_m * WIDER)),
        cellular: s.cellular,
        fibre: s.fibre,
        wind_m_s: carrying_wind(layer, thickness, wind),
        life_s: layer.life_s.unwrap_or(CloudSlab::NONE.life_s),
    }
}

/// Returns the wind that carries a layer, m/s towards east and north: its own, or the weather's at its middle.
fn carrying_wind(layer: &CloudLayer, thickness_m: f64, wind: &WindProfile) -> [f64; 2] {
    let Some(own) = layer.wind else { return wind.mean_at_height_m_s(layer.base_m + 0.5 * thickness_m) };
    let (sine, cosine) = libm::sincos(own.from_deg.to_radians());
    [-own.speed_m_s * sine, -own.speed_m_s * cosine]
}

/// Returns the index of the layer from which rain falls: the lowest that the host names as cumulonimbus, towering
/// cumulus or nimbostratus; else the lowest that covers at least half the sky; else the one that covers most.
fn rain_layer(layers: &[CloudLayer]) -> Option<usize> {
    let most = |a: &&(usize, &CloudLayer), b: &&(usize, &CloudLayer)| a.1.cover.total_cmp(&b.1.cover);
    let mut all: Vec<(usize, &CloudLayer)> = layers.iter().enumerate().filter(|(_, l)| l.cover > 0.0).collect();
    // Hosts list their layers in any order.
    all.sort_by(|a, b| a.1.base_m.total_cmp(&b.1.base_m));
    let tower = |k| matches!(k, CloudKind::Cumulonimbus | CloudKind::ToweringCumulus | CloudKind::Nimbostratus);
    all.iter()
        .find(|(_, l)| tower(l.kind))
        .or_else(|| all.iter().find(|(_, l)| l.cover >= 0.5))
        .or_else(|| all.iter().max_by(most))
        .map(|(i, _)| *i)
}

/// Converts a weather's layers to slabs, each in a slot of its level, so that a blend pairs low with low and high with
/// high.
///
/// Precipitation, snow included, needs cloud; only ice crystals fall from a clear sky. The layer from which
/// precipitation falls holds at least [`water_path_for_rate_kg_m2`]. If the host named no cloud at all, an overcast at
/// 600 m is added: stratocumulus in drizzle, else towering cumulus in showers, else nimbostratus. Both rules hold only
/// if `rain_needs_cloud` is true.
pub(super) fn cloud_slabs(w: &Weather, wind: &WindProfile, rain_needs_cloud: bool) -> [CloudSlab; MAX_CLOUD_LAYERS] {
    let p = &w.precipitation;
    let raining = p.rate_mm_h > 0.0 && p.kind != PrecipitationKind::IceCrystals;
    let showers = p.showers || p.thunderstorm;
    let drizzle = matches!(p.kind, PrecipitationKind::Drizzle | PrecipitationKind::FreezingDrizzle);
    let mut layers = w.clouds.clone();
    if raining && rain_needs_cloud && layers.iter().all(|l| l.cover <= 0.0) {
        layers.clear();
        layers.push(CloudLayer::new(1.0, 600.0));
    }
    let source = if raining { rain_layer(&layers) } else { None };
    let mut made: Vec<CloudSlab> = Vec::with_capacity(layers.len());
    for (i, layer) in layers.iter().enumerate().filter(|(_, l)| l.cover > 0.0) {
        let rains = source == Some(i);
        let known =
            if layer.kind == CloudKind::Unknown { likely_kind(layer, rains && !drizzle, showers) } else { layer.kind };
        let water = if rains && rain_needs_cloud { water_path_for_rate_kg_m2(p.rate_mm_h) } else { 0.0 };
        made.push(slab(layer, known, water, wind));
    }
    into_slots(made)
}

/// First slots of low, middle and high clouds.
const LEVEL_SLOTS: [usize; 3] = [0, 7, 11];

/// Puts slabs, lowest first, into the slots of their level. If a level has more slabs than slots, the other levels give
/// up slots. In either case the bases ascend from slot to slot, and [`Conditions::cloud_light`] goes through the slots
/// from the top.
fn into_slots(mut slabs: Vec<CloudSlab>) -> [CloudSlab; MAX_CLOUD_LAYERS] {
    slabs.sort_by(|a, b| a.base_m.total_cmp(&b.base_m));
    let below = |limit_m: f64| slabs.partition_point(|s| s.base_m < limit_m);
    let (middle, high) = (below(MIDDLE_FROM_M), below(HIGH_FROM_M));
    let first_high =
        (LEVEL_SLOTS[1].max(middle) + high - middle).max(LEVEL_SLOTS[2]).min(MAX_CLOUD_LAYERS - (slabs.len() - high));
    let first_middle = LEVEL_SLOTS[1].max(middle).min(first_high - (high - middle));
    let mut slots = [CloudSlab::NONE; MAX_CLOUD_LAYERS];
    for (i, s) in slabs.into_iter().enumerate() {
        let first = if i < middle {
            0
        } else if i < high {
            first_middle - middle
        } else {
            first_high - high
        };
        slots[first + i] = s;
    }
    slots
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sheet(optical_depth: f64, base_m: f64) -> CloudSlab {
        CloudSlab { cover: 1.0, base_m, optical_depth, ..CloudSlab::NONE }
    }

    #[test]
    fn published_extinctions_of_three_clouds() {
        // 3 LWC / (2 rho r): congestus 2.5 g/m^3 in 10 um droplets is 0.375 1/m.
        assert!((cloud_optical_depth(2.5e-3, 10.0, 0.0) - 0.375).abs() < 1e-12);
        assert!((cloud_optical_depth(0.2e-3, 7.0, 0.0) - 0.042_857).abs() < 1e-6);
    }

    #[test]
    fn rain_clouds_hold_about_a_kilogram_a_square_metre() {
        // Microwave radiometers retrieve values of this order in rain: 0.2 kg/m^2 in light to about 1.5 in heavy rain.
        let paths = [0.1, 1.0, 5.0, 20.0, 100.0].map(water_path_for_rate_kg_m2);
        assert!(paths.windows(2).all(|p| p[1] > p[0]), "{paths:?}");
        assert!((0.1..0.3).contains(&paths[1]) && (0.7..1.5).contains(&paths[3]) && paths[4] < 3.0, "{paths:?}");
        assert_eq!(water_path_for_rate_kg_m2(0.0), 0.0);
    }

    #[test]
    fn rain_falls_from_the_same_layer_in_any_order_of_the_list() {
        use CloudKind::{Cumulonimbus, Cumulus, Nimbostratus, ToweringCumulus, Unknown};
        let layer = CloudLayer::of;
        for (from_low_to_high, wanted_m) in [
            ([layer(Cumulus, 0.4, 500.0), layer(Nimbostratus, 0.8, 900.0), layer(Cumulonimbus, 0.3, 1500.0)], 900.0),
            ([layer(ToweringCumulus, 0.0, 300.0), layer(Cumulonimbus, 0.2, 700.0), layer(Unknown, 1.0, 800.0)], 700.0),
            ([layer(Unknown, 0.3, 400.0), layer(Unknown, 0.6, 900.0), layer(Unknown, 1.0, 3000.0)], 900.0),
            ([layer(Unknown, 0.2, 400.0), layer(Unknown, 0.4, 900.0), layer(Unknown, 0.4, 3000.0)], 3000.0),
        ] {
            for order in [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
                let layers = order.map(|i: usize| from_low_to_high[i]);
                let source = rain_layer(&layers).map(|i| layers[i].base_m);
                assert_eq!(source, Some(wanted_m), "{order:?} of {from_low_to_high:?}");
            }
        }
        assert_eq!(rain_layer(&[layer(Cumulonimbus, 0.0, 700.0)]), None);
    }

    #[test]
    fn sixteen_slabs_fit_and_each_level_has_its_own_slots() {
        let slabs: Vec<CloudSlab> = (0..16).map(|i| sheet(1.0, 100.0 * f64::from(i))).collect();
        assert_eq!(into_slots(slabs).iter().filter(|s| s.cover > 0.0).count(), 16);
        let slots = into_slots(vec![sheet(1.0, 9000.0), sheet(1.0, 500.0), sheet(1.0, 3000.0)]);
        assert_eq!([slots[0].base_m, slots[7].base_m, slots[11].base_m], [500.0, 3000.0, 9000.0]);
    }
}
