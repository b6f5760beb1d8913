//! Clouds as slabs of water, and the light that they let through.

use super::blend::smoothstep;
use super::conditions::{CloudSlab, Conditions, WindProfile};
use super::kinds::{CloudKind, PrecipitationKind};
use super::model::{CloudLayer, MAX_CLOUD_LAYERS, Weather};

/// What a kind of cloud is made of, as means over its depth, and how it looks.
struct Substance {
    thickness_m: f64,
    water_g_m3: f64,
    droplet_radius_um: f64,
    convection: f64,
    ice_fraction: f64,
    /// Distance from cloud to cloud over the thickness, for a layer of that thickness and near it.
    spacing: f64,
    cellular: f64,
    fibre: f64,
}

/// Water and droplets of stratus and cumulus from Diem (1948) and aufm Kampe and Weickmann (1957) as commonly tabulated
/// (stratus 0.2 g/m^3, 7 um; fair cumulus 0.5, 4). Towering cumulus fills half of its layer with the 2.5 g/m^3 of its core; a
/// cumulonimbus is diluted by entrainment; ice from Heymsfield (2003). Thicknesses are typical of temperate latitudes (WMO cloud
/// atlas). Cells of stratocumulus are some three to five times as wide as deep, elements of altocumulus 1 to 5 degrees wide (WMO
/// cloud atlas).
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

/// How far from its kind's thickness a layer's clouds still grow wider or narrower with it.
const WIDER: f64 = 3.0;

/// Bases at which low, middle and high clouds divide, m (WMO levels of temperate latitudes).
const MIDDLE_FROM_M: f64 = 2000.0;
const HIGH_FROM_M: f64 = 6000.0;

/// The kind of a layer whose kind nobody named: by level, by cover (more than half is a sheet), and by what falls from it
/// (`raining` is more than drizzle, which falls from stratus).
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

/// Optical depth of water of `water_path_kg_m2` in droplets of `radius_um`: tau = 3 W / (2 rho r) (Stephens 1978), rho that of
/// water or ice.
pub fn cloud_optical_depth(water_path_kg_m2: f64, radius_um: f64, ice_fraction: f64) -> f64 {
    let density = 1000.0 + (917.0 - 1000.0) * ice_fraction;
    1.5 * water_path_kg_m2 / (density * radius_um * 1e-6)
}

/// Water that a cloud must hold for the rate it lets fall, kg/m^2: the rate over the pace at which cloud water turns into rain
/// (Kessler 1969), 1e-3 1/s by drops growing together and 2.2 q^0.875 1/s by falling rain sweeping droplets up. q, rain water
/// in air (kg/kg, density 1.2 kg/m^3), follows the rate by Marshall and Palmer's 0.072 R^0.88 g/m^3.
pub fn water_path_for_rate_kg_m2(rate_mm_h: f64) -> f64 {
    if rate_mm_h <= 0.0 {
        return 0.0;
    }
    let rain_water = 0.072e-3 * libm::pow(rate_mm_h, 0.88) / 1.2;
    rate_mm_h / 3600.0 / (1e-3 + 2.2 * libm::pow(rain_water, 0.875))
}

/// One layer as a slab, with `least_water_kg_m2` of water at least where there is cloud.
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

/// The wind that carries a layer: its own, or the weather's at its middle.
fn carrying_wind(layer: &CloudLayer, thickness_m: f64, wind: &WindProfile) -> [f64; 2] {
    let Some(own) = layer.wind else { return wind.mean_at_height_m_s(layer.base_m + 0.5 * thickness_m) };
    let (sine, cosine) = libm::sincos(own.from_deg.to_radians());
    [-own.speed_m_s * sine, -own.speed_m_s * cosine]
}

/// Index of the layer from which rain falls: the lowest that covers half the sky, else the one that covers most.
fn rain_layer(layers: &[CloudLayer]) -> Option<usize> {
    let low = |a: &&(usize, &CloudLayer), b: &&(usize, &CloudLayer)| a.1.base_m.total_cmp(&b.1.base_m);
    let most = |a: &&(usize, &CloudLayer), b: &&(usize, &CloudLayer)| a.1.cover.total_cmp(&b.1.cover);
    let all: Vec<(usize, &CloudLayer)> = layers.iter().enumerate().filter(|(_, l)| l.cover > 0.0).collect();
    let tower = |k| matches!(k, CloudKind::Cumulonimbus | CloudKind::ToweringCumulus | CloudKind::Nimbostratus);
    all.iter()
        .find(|(_, l)| tower(l.kind))
        .or_else(|| all.iter().filter(|(_, l)| l.cover >= 0.5).min_by(low))
        .or_else(|| all.iter().max_by(most))
        .map(|(i, _)| *i)
}

/// The slabs of the weather, each in the slot of its level so that a blend pairs low with low and high with high.
///
/// Rain needs cloud: the layer it falls from holds [`water_path_for_rate_kg_m2`] at least, and where the host named no cloud
/// at all an overcast of nimbostratus at 600 m is there (`rain_needs_cloud` false switches both off). Ice crystals fall from
/// a clear sky.
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

/// Puts slabs, lowest first, into the slots of their level; where one has more than slots, the others make room. Slots are then
/// in the order of heights, which is how light goes through them ([`Conditions::cloud_light`]).
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

/// Height by which a slab comes over a place that it was below, m: from so much above its base on, the place is in it.
const WITHIN_BASE_M: f64 = 150.0;

/// Least part of the sky that counts for a mean over layers, beside what there is of them: [`over_layers`].
const LEAST_COVER: f64 = 1e-6;

/// Mean of `f` over layers by the part of the sky in which each is the first to be met, in the order of `layers` (cover, layer);
/// `without` where there are none. Continuous where a layer comes or goes.
fn over_layers<'a>(
    layers: impl Iterator<Item = (f64, &'a CloudSlab)>,
    without: f64,
    f: impl Fn(&CloudSlab) -> f64,
) -> f64 {
    let (mut open, mut met, mut sum) = (1.0, LEAST_COVER, LEAST_COVER * without);
    for (cover, slab) in layers {
        (met, sum) = (met + open * cover, sum + open * cover * f(slab));
        open *= 1.0 - cover;
    }
    sum / met
}

/// Reflectance of a slab without absorption under a parallel beam: the two-stream solution of Meador and Weaver (1980, eq. 24)
/// with Eddington's coefficients after the delta scaling of Joseph, Wiscombe and Weinman (1976). Transmittance, direct and
/// diffuse together, is 1 minus this. Against discrete ordinates (Henyey-Greenstein, g = 0.85, depths 1 to 64) it errs by at most
/// 0.0044 with the sun overhead and 0.029 at 60 degrees (tested); of five two-stream closures tried it is the nearest.
pub fn slab_reflectance(optical_depth: f64, asymmetry: f64, cos_zenith: f64) -> f64 {
    let mu = cos_zenith.clamp(0.01, 1.0);
    let tau = optical_depth * (1.0 - asymmetry * asymmetry);
    let g = asymmetry / (1.0 + asymmetry);
    let gamma1 = 0.75 * (1.0 - g);
    let gamma3 = 0.25 * (2.0 - 3.0 * g * mu);
    let beam = -libm::expm1(-tau / mu);
    ((gamma1 * tau + (gamma3 - gamma1 * mu) * beam) / (1.0 + gamma1 * tau)).clamp(0.0, 1.0)
}

/// Reflectance of the same slab for light from all sides: gamma1 tau / (1 + gamma1 tau) (Meador and Weaver 1980).
pub fn slab_diffuse_reflectance(optical_depth: f64, asymmetry: f64) -> f64 {
    let tau = optical_depth * (1.0 - asymmetry * asymmetry);
    let x = 0.75 * (1.0 - asymmetry / (1.0 + asymmetry)) * tau;
    x / (1.0 + x)
}

/// What clouds leave of the light, each as a part of what there is above them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CloudLight {
    /// Of the sun's beam, what arrives as a beam (mean over the place: a hole counts by its chance).
    pub direct: f64,
    /// Of the sun's beam on a horizontal surface, what arrives diffuse from the clouds, light thrown back and forth between
    /// ground and cloud included.
    pub diffuse: f64,
    /// Of the clear sky's diffuse light, what arrives.
    pub sky: f64,
}

impl Conditions {
    /// The weather with one layer more, which lies anywhere beside the others; as it is if there is no room.
    pub(crate) fn with_layer(mut self, slab: CloudSlab) -> Self {
        if let Some(free) = self.clouds.iter_mut().find(|s| s.cover <= 0.0) {
            self.clear_sky *= 1.0 - slab.cover;
            *free = slab;
            self.clouds.sort_unstable_by(|a, b| a.base_m.total_cmp(&b.base_m));
        }
        self
    }

    /// What the clouds leave of sun and sky: horizontal irradiance = sun (direct + diffuse) + sky light x sky.
    ///
    /// `cos_sun_zenith`: cosine of the sun's zenith distance, held above 0.01. `ground_albedo`: 0 to 1, default of most land
    /// 0.2. Layers are combined from the top by adding (van de Hulst 1980), each a mixture of cover and holes; the host's
    /// [`super::CloudLightOverride`] is blended in last.
    pub fn cloud_light(&self, cos_sun_zenith: f64, ground_albedo: f64) -> CloudLight {
        self.cloud_light_at(cos_sun_zenith, ground_albedo, f64::NEG_INFINITY)
    }

    /// Layers that a place at `altitude_m` above the sea lies below, from the top, each with the part of the sky that it covers
    /// there: less of it while the place comes up through its base.
    fn layers_above(&self, altitude_m: f64) -> impl Iterator<Item = (f64, &CloudSlab)> {
        let height_m = altitude_m - self.air.station_altitude_m;
        let above = move |s: &CloudSlab| smoothstep(-WITHIN_BASE_M, WITHIN_BASE_M, s.base_m - height_m);
        self.clouds.iter().rev().filter(|s| s.cover > 0.0).map(move |s| (s.cover * above(s), s))
    }

    /// Height above the sea on whose light clouds over a place feed: the tops of the layers that light meets first, on the mean.
    pub(crate) fn lit_top_m(&self, altitude_m: f64) -> f64 {
        let station_m = self.air.station_altitude_m;
        over_layers(self.layers_above(altitude_m), altitude_m, |s| s.top_m() + station_m).max(altitude_m)
    }

    /// Height above the sea at which what falls begins: the bases of the layers that one meets first from below, on the mean, at
    /// least 100 m above the station; 2 km if no cloud is known.
    pub(crate) fn falling_top_m(&self) -> f64 {
        let layers = self.cloud_slabs().map(|s| (s.cover, s));
        self.air.station_altitude_m + over_layers(layers, 2000.0, |s| s.base_m.max(100.0))
    }

    /// Part of the sky over a place hidden by cloud that one cannot see through: a thin layer counts for what it takes of the
    /// light.
    pub(crate) fn opaque_cover(&self, altitude_m: f64) -> f64 {
        let hidden = |(cover, s): (f64, &CloudSlab)| -cover * libm::expm1(-0.25 * s.optical_depth);
        let clear = self.layers_above(altitude_m).map(hidden).fold(1.0, |clear, hidden| clear * (1.0 - hidden));
        (self.gathered() * (1.0 - clear)).min(1.0)
    }

    /// As [`Conditions::cloud_light`] at a height above the sea: of the clouds that are above it.
    pub(crate) fn cloud_light_at(&self, cos_sun_zenith: f64, ground_albedo: f64, altitude_m: f64) -> CloudLight {
        let mu = cos_sun_zenith.clamp(0.01, 1.0);
        let (mut direct, mut diffuse, mut sky, mut above) = (1.0, 0.0, 1.0, 0.0);
        // Of the direct light, what met no cloud, and what came through one.
        let (mut clear, mut through) = (1.0, 0.0);
        // Of what met no cloud, what would have met one if the place were below all layers. As a sum of what each layer adds: the
        // difference of two products that are nearly equal would be their rounding errors, light where there is none.
        let (mut clear_of_all, mut only_here) = (1.0, 0.0);
        for (cover, s) in self.layers_above(altitude_m) {
            let passed = cover * libm::exp(-s.optical_depth / mu);
            let beam = 1.0 - cover + passed;
            let back_beam = cover * slab_reflectance(s.optical_depth, s.asymmetry, mu);
            let back = cover * slab_diffuse_reflectance(s.optical_depth, s.asymmetry);
            let bounce = 1.0 / (1.0 - above * back);
            let between = (diffuse + above * back_beam * direct) * bounce;
            diffuse = (1.0 - back) * between + direct * (1.0 - back_beam - beam).max(0.0);
            sky *= (1.0 - back) * bounce;
            above = back + (1.0 - back) * (1.0 - back) * above * bounce;
            (clear, through) = (clear * (1.0 - cover), through * beam + clear * passed);
            only_here = only_here * (1.0 - cover) + clear_of_all * (s.cover - cover);
            clear_of_all *= 1.0 - s.cover;
            direct = clear + through;
        }
        let albedo = ground_albedo.clamp(0.0, 1.0);
        let bounce = 1.0 / (1.0 - albedo * above).max(1e-6);
        diffuse = (diffuse + above * albedo * direct) * bounce;
        sky *= bounce;
        // Where layers lie beside one another, there is more of what is under cloud, and less of what lies between.
        let gathered = self.gathered();
        let left_clear = self.clear_sky() + only_here * gathered;
        direct = left_clear + through * gathered;
        (diffuse, sky) = (diffuse * gathered, left_clear + (sky - clear).max(0.0) * gathered);
        // The host's figures hold below the clouds, wherever he has any.
        let o = &self.cloud_light;
        let height_m = altitude_m - self.air.station_altitude_m;
        let below = |s: &CloudSlab| smoothstep(-WITHIN_BASE_M, WITHIN_BASE_M, s.base_m - height_m);
        let weight = o.weight * over_layers(self.cloud_slabs().map(|s| (s.cover, s)), 1.0, below);
        let host = |computed: f64, said: f64| computed + (said - computed) * weight;
        CloudLight { direct: host(direct, o.direct), diffuse: host(diffuse, o.diffuse), sky: host(sky, o.diffuse) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_stream_holds_to_discrete_ordinates() {
        // Reflectance of a conservative Henyey-Greenstein slab, g = 0.85, by PythonicDISORT.
        let table =
            [(1.0, 0.04232, 0.16488), (4.0, 0.19092, 0.41602), (16.0, 0.55721, 0.69740), (64.0, 0.84628, 0.89497)];
        for (tau, high, low) in table {
            let (a, b) = (slab_reflectance(tau, 0.85, 1.0), slab_reflectance(tau, 0.85, 0.5));
            assert!((a - high).abs() < 0.0045, "tau {tau}, mu 1: {a} against {high}");
            assert!((b - low).abs() < 0.03, "tau {tau}, mu .5: {b} against {low}");
        }
        assert_eq!(slab_reflectance(0.0, 0.85, 1.0), 0.0);
        assert!(slab_reflectance(1e9, 0.85, 0.5) <= 1.0);
    }

    fn under(slabs: &[CloudSlab]) -> Conditions {
        let mut c = super::super::derive(&Weather::default()).unwrap();
        c.clouds[..slabs.len()].copy_from_slice(slabs);
        c
    }

    fn sheet(optical_depth: f64, base_m: f64) -> CloudSlab {
        CloudSlab { cover: 1.0, base_m, optical_depth, ..CloudSlab::NONE }
    }

    #[test]
    fn light_is_conserved_and_falls_with_cover() {
        assert_eq!(under(&[]).cloud_light(0.7, 0.2), CloudLight { direct: 1.0, diffuse: 0.0, sky: 1.0 });
        let one = under(&[sheet(16.0, 900.0)]).cloud_light(1.0, 0.0);
        assert!((one.direct + one.diffuse - (1.0 - slab_reflectance(16.0, 0.85, 1.0))).abs() < 1e-9);
        // Two sheets of 8 are one of 16, nearly: adding treats what lies between as diffuse.
        let two = under(&[sheet(8.0, 900.0), sheet(8.0, 3000.0)]).cloud_light(1.0, 0.0);
        assert!((two.diffuse / one.diffuse - 1.0).abs() < 0.12, "{two:?} {one:?}");
        let mut last = f64::INFINITY;
        for i in 0..=10 {
            let slab = CloudSlab { cover: f64::from(i) / 10.0, ..sheet(20.0, 900.0) };
            let l = under(&[slab]).cloud_light(0.6, 0.2);
            assert!(l.direct + l.diffuse < last, "cover must darken");
            last = l.direct + l.diffuse;
        }
    }

    /// Under one overcast that comes for another, the product of the holes in all layers is no light, in whatever order it is taken.
    #[test]
    fn no_light_comes_from_the_rounding_of_holes() {
        let part = |cover, optical_depth, base_m| CloudSlab { cover, ..sheet(optical_depth, base_m) };
        for i in 0..1000 {
            let t = f64::from(i) / 1000.0;
            let layers =
                [part(0.3 + 0.3 * t, 94.0, 307.0), part(0.9 - 0.3 * t, 563.0, 762.0), part(1.0 - t, 200.0, 2743.0)];
            let c = Conditions { clear_sky: 0.0, ..under(&layers) };
            let below = c.cloud_light_at(0.01, 0.2, 2.0).direct;
            assert!(below < 1e-200, "{layers:?}: {below}");
        }
    }

    #[test]
    fn a_place_among_layers_has_the_light_of_those_above_it() {
        let c =
            under(&[CloudSlab { cover: 0.4, ..sheet(1e4, 500.0) }, CloudSlab { cover: 0.25, ..sheet(1e4, 3000.0) }]);
        for (altitude_m, direct) in
            [(0.0, 0.6 * 0.75), (500.0, 0.8 * 0.75), (1500.0, 0.75), (3000.0, 0.875), (5000.0, 1.0)]
        {
            let light = c.cloud_light_at(0.5, 0.0, altitude_m);
            assert!((light.direct - direct).abs() < 1e-15, "{altitude_m} m: {light:?}");
        }
    }

    #[test]
    fn snow_under_cloud_is_brighter_than_soil() {
        let c = under(&[sheet(20.0, 600.0)]);
        assert!(c.cloud_light(0.5, 0.8).diffuse > 1.5 * c.cloud_light(0.5, 0.1).diffuse);
    }

    #[test]
    fn override_replaces_the_slabs_light() {
        let mut c = under(&[sheet(20.0, 600.0)]);
        c.cloud_light = super::super::CloudLightOverride { weight: 1.0, direct: 0.25, diffuse: 0.5 };
        assert_eq!(c.cloud_light(0.5, 0.2), CloudLight { direct: 0.25, diffuse: 0.5, sky: 0.5 });
    }

    #[test]
    fn published_extinctions_of_three_clouds() {
        // 3 LWC / (2 rho r): congestus 2.5 g/m^3 in 10 um droplets is 0.375 1/m.
        assert!((cloud_optical_depth(2.5e-3, 10.0, 0.0) - 0.375).abs() < 1e-12);
        assert!((cloud_optical_depth(0.2e-3, 7.0, 0.0) - 0.042_857).abs() < 1e-6);
    }

    #[test]
    fn rain_clouds_hold_about_a_kilogram_a_square_metre() {
        // The order that microwave radiometers retrieve in rain: 0.2 kg/m^2 in light to about 1.5 in heavy rain.
        let paths = [0.1, 1.0, 5.0, 20.0, 100.0].map(water_path_for_rate_kg_m2);
        assert!(paths.windows(2).all(|p| p[1] > p[0]), "{paths:?}");
        assert!((0.1..0.3).contains(&paths[1]) && (0.7..1.5).contains(&paths[3]) && paths[4] < 3.0, "{paths:?}");
        assert_eq!(water_path_for_rate_kg_m2(0.0), 0.0);
    }

    #[test]
    fn slots_keep_levels_apart_and_take_sixteen() {
        let slabs: Vec<CloudSlab> = (0..16).map(|i| sheet(1.0, 100.0 * f64::from(i))).collect();
        assert_eq!(into_slots(slabs).iter().filter(|s| s.cover > 0.0).count(), 16);
        let slots = into_slots(vec![sheet(1.0, 9000.0), sheet(1.0, 500.0), sheet(1.0, 3000.0)]);
        assert_eq!([slots[0].base_m, slots[7].base_m, slots[11].base_m], [500.0, 3000.0, 9000.0]);
    }
}
