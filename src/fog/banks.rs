//! Fog banks: the low layers of weather regions, as a camera sees them.
//!
//! # Model
//! A bank is the layer of fog, mist or dust of a region that has [`WeatherParts::FOG`], with its own heights,
//! extinction and light. At each point of a ray it has the region's share in the fog ([`crate::regions`]); the fog
//! outside all regions has the rest. Banks are laid over the picture from far to near, each with the air and the outer
//! fog in front of it. A camera inside a bank sees out of it.
//!
//! The light in a bank is that in an endless layer with its heights, under the sun and the sky above the camera. The
//! sides of a bank are therefore lit like places inside the layer at the same height. Patches are left out.
//!
//! # Method
//! `shaders/fog/banks.wgsl` finds where a ray enters the shape and its perimeter on a flat plan. Inside the shape the
//! depth is the integral of the layer's density; in the perimeter it is a sum over Gauss points of the share times the
//! density. Banks whose regions overlap are integrated together: the ray is cut at the borders of all these regions,
//! and their shares are worked out together at each point. Polygons that are not convex are sampled at twelve points of
//! the ray's way through a circle about them. The reference for queries ([`SkyBanks`]) integrates the shares on the
//! sphere, as visibility between two points does.
//!
//! # Cost
//! On a software driver, in copies of a picture of 640 x 360 (`cargo bench --bench speed -- banks`), a bank outside the
//! picture costs nothing, a bank across the picture 8, a bank around the camera 11, eight separate banks 6, and eight
//! overlapping banks 18. A software driver runs both sides of every branch, but repeats a loop only as often as some
//! pixel of a group needs. Each pixel therefore loops over the banks whose circle and heights its ray meets.

use std::f64::consts::PI;

use glam::{DMat3, DVec2, DVec3};

use super::{
    of_weather::layer_alone,
    path::layer_path,
    reference::{FogKind, FogModel, FogSample, bank_light, fog_along, fog_beside_banks, fog_reach},
    uniforms::{FogBankUniform, FogVariant, LowAirUniform, MOST_BANKS},
};
use crate::{
    error::Result,
    moment::Scene,
    regions::{HeldRegion, MAX_REGION_CORNERS, MAX_WEATHER_REGIONS, RegionShape, RegionWay, SeenRegion, turns},
    scene::{Camera, WorldFrame},
    stage::FrameContext,
    weather::{GroundLayer, WeatherParts},
};

/// All shapes of banks, as bits: bit k is kind k of the shaders' `FogBank`.
const ALL_SHAPES: u32 = 15;

/// Sine of an elevation, up or down. A camera that shows steeper directions is taken to see all around.
const STEEP: f64 = 0.8;
/// Angle beyond a picture's left and right edges up to which banks are still drawn, rad: for filters and mirrors.
const MARGIN: f64 = 0.05;
/// Length of the longest way along which a query looks for banks, m.
const FARTHEST_WAY_M: f64 = 4e5;

/// Fog bank of a picture.
#[derive(Clone, Debug)]
pub(super) struct FogBank {
    /// Low layer of the region, without patches and precipitation.
    pub model: FogModel,
    axes: [DVec2; 2],
    camera_m: DVec2,
    /// Position of the region's centre, m (east, north) from the camera.
    center_m: DVec2,
    /// Distance from the centre beyond which the region does not act, m.
    reach_m: f64,
    distance_m: f64,
    shape: RegionShape,
    perimeter_m: f64,
    strength: f64,
    merges: bool,
    /// Whether the bank may be in the picture.
    is_seen: bool,
    /// Banks whose regions may overlap that of this bank: bit j for bank j.
    overlaps: u32,
}

/// Fog banks of a picture, in the order of the world's regions.
#[derive(Debug, Default)]
pub(super) struct FogBanks(Vec<FogBank>);

impl FogBank {
    fn new(seen: &SeenRegion<'_>, scene: &Scene, planet_radius_m: f64) -> Result<Self> {
        let (light, view) = (scene.fog_light(), scene.fog_viewpoint(planet_radius_m));
        let mut model = layer_alone(&seen.region.conditions, &light, &view)?;
        // Only inside the bank does the layer take light from the air at the camera.
        model.lit = 1.0 + (model.lit - 1.0) * seen.weight();
        let plan = &seen.region.plan;
        Ok(Self {
            model,
            axes: [seen.right, seen.ahead],
            camera_m: seen.camera_m,
            center_m: seen.center_m(),
            reach_m: seen.reach_m(),
            distance_m: seen.distance_m,
            shape: plan.shape,
            perimeter_m: plan.perimeter_m,
            strength: plan.strength,
            merges: seen.region.merges.has(WeatherParts::FOG),
            is_seen: true,
            overlaps: 0,
        })
    }

    /// Returns the bank in the layout of shaders.
    pub fn uniform(&self) -> FogBankUniform {
        let (mut half, mut corner, mut count) = ([1.0; 2], 0.0, 0);
        let mut corners = [[0.0; 2]; MAX_REGION_CORNERS];
        match &self.shape {
            RegionShape::Rectangle { half_m, corner_radius_m } => (half, corner) = (*half_m, *corner_radius_m),
            RegionShape::Ellipse { half_m } => half = *half_m,
            RegionShape::Polygon { corners_m, count: number } => {
                count = *number;
                corners[..count].copy_from_slice(&corners_m[..count]);
                if turns(&corners[..count]).fold(0.0, |sum, turn| sum + turn) < 0.0 {
                    corners[..count].reverse();
                }
            }
        }
        let [right, ahead] = self.axes;
        let two = |a: [f64; 2], b: [f64; 2]| [a[0], a[1], b[0], b[1]].map(|v| v as f32);
        FogBankUniform {
            fog: self.model.uniform(),
            axes: two(right.to_array(), ahead.to_array()),
            camera: self.camera_m.as_vec2().to_array(),
            half: half.map(|v| v as f32),
            corner: corner as f32,
            perimeter: self.perimeter_m as f32,
            strength: self.strength as f32,
            radius: self.shape.radius_m() as f32,
            kind: self.shape.kind(),
            count: count as u32,
            overlaps: self.overlaps,
            merges: u32::from(self.merges),
            corners: std::array::from_fn(|i| two(corners[2 * i], corners[2 * i + 1])),
        }
    }
}

/// Returns the regions whose banks are drawn, in the order of the world's regions: the nearest [`MOST_BANKS`] of the
/// regions that set the fog ([`WeatherParts::FOG`]). There are none if neither these regions nor the weather outside
/// them have any fog.
fn nearest<'a>(camera: &BankCamera<'a>) -> impl Iterator<Item = SeenRegion<'a>> {
    let seen = |index: usize| {
        let region: &'a HeldRegion = &camera.regions[index];
        region.seen_at(camera.world, camera.eye, &camera.world_to_enu, camera.time_s)
    };
    let (mut near, mut count) = ([(f64::INFINITY, 0); MAX_WEATHER_REGIONS], 0);
    let has_layer =
        |region: &HeldRegion| region.has.has(WeatherParts::FOG) && region.conditions.fog.extinction_per_m > 0.0;
    let any = camera.outer.extinction_per_m > 0.0 || camera.regions.iter().any(has_layer);
    let banks = camera.regions.iter().enumerate().filter(|(_, region)| any && region.has.has(WeatherParts::FOG));
    for (index, _) in banks {
        if let Some(region) = seen(index) {
            near[count] = (region.distance_m - region.region.plan.perimeter_m, index);
            count += 1;
        }
    }
    near[..count].sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let count = count.min(MOST_BANKS);
    near[..count].sort_unstable_by_key(|(_, index)| *index);
    near.into_iter().take(count).filter_map(move |(_, index)| seen(index))
}

/// Camera over weather regions.
struct BankCamera<'a> {
    regions: &'a [HeldRegion],
    world: &'a WorldFrame,
    eye: DVec3,
    world_to_enu: DMat3,
    time_s: f64,
    /// Low layer outside all regions.
    outer: GroundLayer,
}

impl FogBanks {
    /// Creates an empty list with room for all banks.
    pub fn new() -> Self {
        Self(Vec::with_capacity(MOST_BANKS))
    }

    /// Replaces the list by the banks around a camera. The list stays empty if the host's fog law replaces all fog.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the parameter.
    pub fn gather(&mut self, context: &FrameContext<'_>, has_law: bool) -> Result<()> {
        let now = context.now;
        self.0.clear();
        if has_law || now.weather.weather_regions.is_empty() {
            return Ok(());
        }
        let camera = BankCamera {
            regions: now.weather.weather_regions,
            world: now.weather.world,
            eye: now.eye,
            world_to_enu: now.scene.world_to_enu,
            time_s: now.time_s,
            outer: now.outer_fog,
        };
        let bearings = if context.all_around {
            SeenBearings::ALL
        } else {
            SeenBearings::new(&context.frame.camera, &now.scene.world_to_enu)
        };
        for seen in nearest(&camera) {
            let mut bank = FogBank::new(&seen, &now.scene, now.planet_radius_m)?;
            bank.is_seen = bearings.reach(bank.center_m, bank.reach_m);
            self.0.push(bank);
        }
        for k in 0..self.0.len() {
            let meets =
                |other: &FogBank| (other.center_m - self.0[k].center_m).length() < other.reach_m + self.0[k].reach_m;
            let overlaps = self.0.iter().enumerate().filter(|(j, other)| *j != k && meets(other));
            self.0[k].overlaps = overlaps.fold(0, |set, (j, _)| set | 1 << j);
        }
        Ok(())
    }

    /// Returns the banks in the order of the world's regions.
    pub fn list(&self) -> &[FogBank] {
        &self.0
    }

    /// Returns the shapes of the banks, bit k for kind k.
    pub fn shapes(&self) -> u32 {
        self.0.iter().fold(0, |set, bank| set | 1 << bank.shape.kind())
    }

    /// Whether regions of banks overlap.
    pub fn overlap(&self) -> bool {
        self.0.iter().any(|bank| bank.overlaps != 0)
    }

    /// Returns the indices of the banks that the camera may see, from far to near, and their number.
    fn order(&self) -> ([usize; MOST_BANKS], usize) {
        let (mut order, mut count) = ([0; MOST_BANKS], 0);
        for (index, _) in self.0.iter().enumerate().filter(|(_, bank)| bank.is_seen) {
            order[count] = index;
            count += 1;
        }
        order[..count].sort_by(|a, b| self.0[*b].distance_m.total_cmp(&self.0[*a].distance_m));
        (order, count)
    }

    /// Whether the camera may see a bank.
    pub fn any_seen(&self) -> bool {
        self.0.iter().any(|bank| bank.is_seen)
    }
}

/// Directions that a picture shows, by bearing.
#[derive(Clone, Copy, Debug)]
struct SeenBearings {
    /// Bearing of the picture's middle, rad.
    middle: f64,
    /// Largest difference from the middle, rad; pi if every bearing may be seen.
    half: f64,
}

impl SeenBearings {
    /// Bearings of everything around.
    const ALL: Self = Self { middle: 0.0, half: PI };

    /// Returns the bearings of a camera's picture. An orthographic camera is taken to see all around, and so is one
    /// that shows directions steeper than [`STEEP`] or 90 degrees or more from its axis.
    fn new(camera: &Camera, world_to_enu: &DMat3) -> Self {
        let bearing = |d: DVec3| d.x.atan2(d.y);
        let to_enu = *world_to_enu * camera.rotation().transpose();
        let forward = to_enu * DVec3::NEG_Z;
        let inverse = camera.projection.inverse();
        let mut half = 0.0f64;
        for corner in [[-1.0, -1.0], [1.0, -1.0], [-1.0, 1.0], [1.0, 1.0]] {
            let d = to_enu * inverse.project_point3(DVec3::new(corner[0], corner[1], 0.5)).normalize_or(DVec3::NEG_Z);
            if camera.is_orthographic() || d.z.abs().max(forward.z.abs()) > STEEP || d.dot(forward) <= 0.0 {
                return Self::ALL;
            }
            half = half.max(turned(bearing(d), bearing(forward)));
        }
        Self { middle: bearing(forward), half }
    }

    /// Whether a circle at a place, m (east, north) from the camera, may be seen.
    fn reach(&self, center_m: DVec2, radius_m: f64) -> bool {
        let distance = center_m.length();
        let wide = if distance > radius_m { (radius_m / distance).asin() } else { PI };
        turned(center_m.x.atan2(center_m.y), self.middle) <= self.half + wide + MARGIN
    }
}

/// Returns the angle between two bearings, rad.
fn turned(a: f64, b: f64) -> f64 {
    let turn = (a - b).rem_euclid(2.0 * PI);
    turn.min(2.0 * PI - turn)
}

impl FogVariant {
    /// Adds the features that banks need. For a software driver (`software`) these are the shapes and overlaps of the
    /// given banks only, otherwise those of all possible banks.
    pub(super) fn with_banks(self, banks: &FogBanks, software: bool) -> Self {
        if !banks.any_seen() {
            return self;
        }
        let layers = || banks.list().iter().map(|bank| bank.model.variant());
        Self {
            absorbing: self.absorbing || layers().any(|v| v.absorbing),
            neutral: self.neutral && layers().all(|v| v.neutral),
            lifted: self.lifted || layers().any(|v| v.lifted),
            bank_shapes: if software { banks.shapes() } else { ALL_SHAPES },
            banks_overlap: !software || banks.overlap(),
            ..self
        }
    }
}

impl LowAirUniform {
    /// Adds a frame's banks.
    pub(super) fn set_banks(&mut self, banks: &FogBanks) {
        let (order, count) = banks.order();
        self.bank_count = [banks.list().len() as u32, count as u32];
        self.bank_order =
            order[..count].iter().enumerate().fold(0, |packed, (i, index)| packed | (*index as u32) << (4 * i));
        for (uniform, bank) in self.banks.iter_mut().zip(banks.list()) {
            *uniform = bank.uniform();
        }
    }
}

/// Fog and fog banks towards the sky, for queries.
pub(crate) struct SkyBanks<'a> {
    camera: BankCamera<'a>,
    /// Fog outside all regions.
    outer: FogModel,
    /// Banks from far to near, each with its region.
    banks: Vec<(&'a HeldRegion, FogModel)>,
}

/// Effects of the outer fog and of banks along a ray.
pub(crate) struct FogThroughBanks {
    pub outer: FogSample,
    /// Banks from far to near.
    pub banks: Vec<FogSample>,
}

impl<'a> SkyBanks<'a> {
    /// Returns the fog at a scene's place. `fog` creates the fog of a frame without banks from a scene. If there are
    /// banks, this scene has the fog outside all regions, otherwise the fog at the place.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the parameter.
    pub fn new(
        regions: &'a [HeldRegion],
        world: &'a WorldFrame,
        (scene, eye): (&Scene, DVec3),
        time_s: f64,
        outer: GroundLayer,
        fog: impl FnOnce(&Scene) -> Result<FogModel>,
    ) -> Result<Self> {
        let camera = BankCamera { regions, world, eye, world_to_enu: scene.world_to_enu, time_s, outer };
        let mut near: Vec<SeenRegion<'a>> = nearest(&camera).collect();
        near.sort_by(|a, b| b.distance_m.total_cmp(&a.distance_m));
        let radius_m = scene.planet.bottom_radius_m;
        let bank = |seen: &SeenRegion<'a>| Ok((seen.region, FogBank::new(seen, scene, radius_m)?.model));
        let banks = near.iter().map(bank).collect::<Result<Vec<_>>>()?;
        let outer = fog(&if banks.is_empty() { *scene } else { scene.with_fog(outer) })?;
        Ok(Self { camera, outer, banks })
    }

    /// Returns the unit vector towards the sun or moon that lights the fog.
    pub fn to_sun(&self) -> DVec3 {
        self.outer.to_sun
    }

    /// Returns the effects up to `range` metres along a unit vector (east, north, up).
    ///
    /// # Errors
    /// As [`SkyBanks::new`].
    pub fn along(&self, direction: DVec3, range: f64) -> Result<FogThroughBanks> {
        if self.banks.is_empty() {
            let outer = fog_along(&self.outer, DVec3::ZERO, direction, range, range);
            return Ok(FogThroughBanks { outer, banks: Vec::new() });
        }
        let mu = direction.z.clamp(-1.0, 1.0);
        let [h0, end_m] = fog_reach(&self.outer, DVec3::ZERO, direction, range);
        let models = || std::iter::once(&self.outer).chain(self.banks.iter().map(|(_, model)| model));
        let length_m = models().map(|m| layer_path(m, h0, mu, end_m).last).fold(0.0, f64::max).min(FARTHEST_WAY_M);
        // Depth and ends of each bank on the ray, and the depth of the outer fog that they replace.
        let mut met = vec![([f64::INFINITY, 0.0], 0.0); self.banks.len()];
        let mut replaced = 0.0;
        if length_m > 0.0 {
            let camera = &self.camera;
            let world_direction = camera.world_to_enu.transpose() * direction;
            let way =
                RegionWay::new(camera.regions, camera.world, camera.eye, world_direction, length_m, camera.time_s);
            way.pieces(|[start_m, stop_m], here| {
                let shares = here.shares(WeatherParts::FOG);
                let depth = |m: &FogModel| {
                    let up_to = |s: f64| if s > 0.0 { layer_path(m, h0, mu, s).depth } else { 0.0 };
                    up_to(stop_m) - up_to(start_m)
                };
                if self.outer.kind == FogKind::Slab {
                    replaced += (1.0 - shares.base) * depth(&self.outer);
                }
                for (_, region, share) in here.with_shares(shares) {
                    let Some(k) = self.banks.iter().position(|(bank, _)| std::ptr::eq(*bank, region)) else { continue };
                    let more = share * depth(&self.banks[k].1);
                    if more > 0.0 {
                        let ([first, last], sum) = met[k];
                        let path = layer_path(&self.banks[k].1, h0, mu, stop_m);
                        met[k] = ([first.min(start_m.max(path.first)), last.max(path.last)], sum + more);
                    }
                }
                Ok(())
            })?;
        }
        let outer = fog_beside_banks(&self.outer, direction, range, replaced);
        let seen = self.banks.iter().zip(met).filter(|(_, (_, depth))| *depth > 0.0);
        let banks = seen.map(|((_, model), (ends, depth))| bank_light(model, direction, range, ends, depth)).collect();
        Ok(FogThroughBanks { outer, banks })
    }
}
