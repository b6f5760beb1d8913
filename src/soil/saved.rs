//! Saved form of a site as text. Depths and masses are whole numbers. Lists of them are hexadecimal; a run of n equal
//! numbers v is written as "v*n", with n in decimal.

use std::collections::VecDeque;

use serde::{Deserialize, Serialize};

use super::{
    field::SoilField,
    kind::{BUILT_IN, MAX_SOIL_KINDS, SoilHorizon, SoilKind, SoilKindId, SoilSettings},
    laws::SinkageSet,
    material::SoilParcel,
    patch::{BankWater, CELLS, Pressed, SoilPatch, UndugGround},
    site::{SoilSite, SoilSiteDesc},
    tool::{SoilToolPose, SoilToolShape},
    work::{PassedCell, SoilTool, ToolWork},
};
use crate::{
    chance::mixed,
    error::{Error, Result, Status, toml_fault},
    world::{values, words},
};

/// Largest number of patches of a saved site.
const MOST_PATCHES: usize = 1 << 20;
/// Largest cut, loose depth and mass of a kind on a cell: far more than a site can reach, and safe to add.
const MOST_CUT: i64 = 1 << 28;
const MOST_LOOSE: i64 = 1 << 40;
const MOST_MASS: i64 = 1 << 58;
/// Largest number of steps: more than there are until the latest time, 1e10 s.
const MOST_STEPS: i64 = 1 << 40;
/// Largest freezing index, K s: that of a century of the hardest winters.
const MOST_FREEZING_K_S: f64 = 1e12;

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SavedSite {
    pub cell_m: f64,
    /// Saturation without rain and sun; saturation of ground that was not dug, and the wet share of its surface.
    saturation: [f64; 3],
    /// Freezing index, K s.
    freezing_k_s: f64,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    own_kinds: Vec<SavedKind>,
    horizons: Vec<(f64, u8)>,
    steps: i64,
    idle: u32,
    revision: u64,
    next_id: u32,
    /// Mass that left and that came, in whole micrograms; text, because it may be more than an integer of TOML can
    /// hold.
    taken: String,
    brought: String,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    tools: Vec<SavedTool>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    patches: Vec<SavedPatch>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct SavedKind {
    bulk: [f64; 3],
    strength: [f64; 2],
    #[serde(default, skip_serializing_if = "Option::is_none")]
    sinkage: Option<[f64; 3]>,
    /// Colour; absent in states of older formats, whose kinds get the colour of loam.
    #[serde(default = "default_albedo")]
    albedo: [f64; 3],
}

fn default_albedo() -> [f64; 3] {
    BUILT_IN[SoilKindId::LOAM.index()].albedo
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct SavedTool {
    id: u32,
    shape: String,
    sizes: [f64; 2],
    is_ended: bool,
    depth: i64,
    masses: String,
    /// Time, edge, upper edge, facing and load of the present pose and of those that wait.
    poses: Vec<[f64; 17]>,
    passed: Vec<([i32; 2], [f64; 2])>,
    saturation: f64,
    /// Cut volume, area and sinkage of the last step; the kind that was cut, whether the sinkage was limited, and
    /// whether frost stopped the edge.
    work: ([f64; 3], u8, [bool; 2]),
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct SavedPatch {
    key: [i32; 2],
    revision: u64,
    /// Whether the patch is awake, has changed since the last sweep, and has unchecked walls.
    flags: [bool; 3],
    /// Saturation, and wet share of the surface.
    water: [f64; 2],
    /// Depths cut. In a state that is only hashed, the text is the hash of this list and of all lists that follow.
    cut: String,
    loose: String,
    masses: Vec<(u8, String)>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pressed: Option<[String; 3]>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    broken: Option<String>,
}

fn pose_numbers(pose: &SoilToolPose) -> [f64; 17] {
    let mut numbers = [0.0; 17];
    numbers[0] = pose.time_s;
    let points = [pose.edge[0], pose.edge[1], pose.upper[0], pose.upper[1], pose.facing];
    points.iter().zip(numbers[1..16].chunks_mut(3)).for_each(|(point, to)| to.copy_from_slice(&point.to_array()));
    numbers[16] = pose.load_n;
    numbers
}

fn pose_of(numbers: &[f64; 17]) -> SoilToolPose {
    let point = |i: usize| glam::DVec3::new(numbers[3 * i + 1], numbers[3 * i + 2], numbers[3 * i + 3]);
    SoilToolPose {
        time_s: numbers[0],
        edge: [point(0), point(1)],
        upper: [point(2), point(3)],
        facing: point(4),
        load_n: numbers[16],
    }
}

fn shape_numbers(shape: &SoilToolShape) -> (&'static str, [f64; 2]) {
    match *shape {
        SoilToolShape::Bucket { struck_m3, heap_rise } => ("bucket", [struck_m3, heap_rise]),
        SoilToolShape::Blade => ("blade", [0.0; 2]),
        SoilToolShape::Bed { struck_m3, heap_rise } => ("bed", [struck_m3, heap_rise]),
        SoilToolShape::Wheel { diameter_m } => ("wheel", [diameter_m, 0.0]),
        SoilToolShape::Track { contact_m } => ("track", [contact_m, 0.0]),
    }
}

fn shape_of(name: &str, [first, heap_rise]: [f64; 2]) -> Option<SoilToolShape> {
    Some(match name {
        "bucket" => SoilToolShape::Bucket { struck_m3: first, heap_rise },
        "blade" => SoilToolShape::Blade,
        "bed" => SoilToolShape::Bed { struck_m3: first, heap_rise },
        "wheel" => SoilToolShape::Wheel { diameter_m: first },
        "track" => SoilToolShape::Track { contact_m: first },
        _ => return None,
    })
}

/// Returns whole numbers as text.
fn text(numbers: impl Iterator<Item = i64>) -> String {
    words(numbers.map(|number| number as u64))
}

/// Returns the `count` numbers of a text; `None` if the text does not have `count` numbers, or if one is outside \[0,
/// `most`\].
fn numbers(text: &str, count: usize, most: i64) -> Option<Vec<i64>> {
    let found: Vec<i64> = values(text, count)?.into_iter().map(|number| number as i64).collect();
    found.iter().all(|number| (0..=most).contains(number)).then_some(found)
}

impl SavedKind {
    fn of(kind: &SoilKind) -> Self {
        Self {
            bulk: [kind.density_kg_m3, kind.swell, kind.repose_deg],
            strength: [kind.cohesion_kpa, kind.friction_deg],
            sinkage: kind.sinkage.map(|set| [set.kc, set.kphi, set.n]),
            albedo: kind.albedo,
        }
    }

    fn kind(&self) -> SoilKind {
        let ([density_kg_m3, swell, repose_deg], [cohesion_kpa, friction_deg]) = (self.bulk, self.strength);
        let sinkage = self.sinkage.map(|[kc, kphi, n]| SinkageSet { kc, kphi, n });
        SoilKind { density_kg_m3, swell, repose_deg, cohesion_kpa, friction_deg, sinkage, albedo: self.albedo }
    }
}

impl SavedTool {
    fn of(tool: &SoilTool) -> Self {
        let (shape, sizes) = shape_numbers(&tool.shape);
        let work = &tool.work;
        Self {
            id: tool.id,
            shape: shape.to_owned(),
            sizes,
            is_ended: tool.is_ended,
            depth: tool.content.depth,
            masses: text(tool.content.masses.into_iter()),
            poses: std::iter::once(&tool.pose).chain(&tool.poses).map(pose_numbers).collect(),
            passed: tool.passed.iter().map(|passed| (passed.place, [passed.share, passed.raised])).collect(),
            saturation: tool.saturation,
            work: ([work.cut_m3, work.area_m2, work.sinkage_m], work.kind as u8, [work.is_clamped, work.is_frozen]),
        }
    }

    fn tool(&self, kinds: usize) -> Option<SoilTool> {
        let shape = shape_of(&self.shape, self.sizes).filter(|shape| shape.validate().is_ok())?;
        let mut poses: VecDeque<SoilToolPose> = self.poses.iter().map(pose_of).collect();
        poses.iter().all(|pose| pose.validate(&shape).is_ok()).then_some(())?;
        poses.iter().is_sorted_by(|a, b| b.validate_after(a).is_ok()).then_some(())?;
        let pose = poses.pop_front()?;
        let masses: [i64; MAX_SOIL_KINDS] = numbers(&self.masses, MAX_SOIL_KINDS, MOST_MASS)?.try_into().ok()?;
        let passed: Vec<PassedCell> = self
            .passed
            .iter()
            .map(|(place, [share, raised])| PassedCell { place: *place, share: *share, raised: *raised })
            .collect();
        let ([cut_m3, area_m2, sinkage_m], kind, [is_clamped, is_frozen]) = self.work;
        let is_sound = (0..=MOST_LOOSE).contains(&self.depth)
            && usize::from(kind) < kinds
            && is_share(self.saturation)
            && masses[kinds..].iter().all(|mass| *mass == 0)
            && passed.is_sorted_by_key(|passed| [passed.place[1], passed.place[0]])
            && passed.iter().all(|passed| (0.0..=1.0).contains(&passed.share) && passed.raised.is_finite());
        is_sound.then_some(SoilTool {
            id: self.id,
            shape,
            pose,
            poses,
            is_ended: self.is_ended,
            content: SoilParcel { depth: self.depth, masses },
            saturation: self.saturation,
            passed,
            work: ToolWork { cut_m3, area_m2, kind: usize::from(kind), sinkage_m, is_clamped, is_frozen },
        })
    }
}

/// Whether a number is a share, from 0 to 1.
fn is_share(number: f64) -> bool {
    (0.0..=1.0).contains(&number)
}

/// Hash of the cut, the loose soil, the compaction and the broken bank of a patch's cells.
fn hash_of(patch: &SoilPatch) -> u64 {
    let kinds =
        patch.masses.iter().flat_map(|(kind, masses)| std::iter::once(i64::from(*kind)).chain(masses.iter().copied()));
    let pressed = patch.pressed.iter().flat_map(|press| [press.packed, press.sunk, press.reached]);
    let broken = patch.broken.iter().map(|broken| i64::from(*broken));
    let numbers = patch.cut.iter().chain(&patch.loose).copied().chain(kinds).chain(pressed).chain(broken);
    numbers.fold(0, |hash, number| mixed(hash ^ number as u64))
}

impl SavedPatch {
    fn of(field: &SoilField, slot: u32, for_hash: bool) -> Self {
        let patch = field.patch(slot);
        let bare = Self {
            key: patch.key,
            revision: patch.revision,
            flags: [field.awake.contains(&slot), field.has_changed(slot), patch.is_unchecked],
            water: [patch.water.saturation, patch.water.soaked],
            cut: String::new(),
            loose: String::new(),
            masses: Vec::new(),
            pressed: None,
            broken: None,
        };
        if for_hash {
            return Self { cut: format!("{:x}", hash_of(patch)), ..bare };
        }
        let pressed = |value: fn(&Pressed) -> i64| text(patch.pressed.iter().map(value));
        Self {
            cut: text(patch.cut.iter().copied()),
            loose: text(patch.loose.iter().copied()),
            masses: patch.masses.iter().map(|(kind, masses)| (*kind, text(masses.iter().copied()))).collect(),
            pressed: (!patch.pressed.is_empty())
                .then(|| [pressed(|p| p.packed), pressed(|p| p.sunk), pressed(|p| p.reached)]),
            broken: patch.broken.contains(&true).then(|| text(patch.broken.iter().map(|broken| i64::from(*broken)))),
            ..bare
        }
    }

    fn patch(&self, kinds: usize, ground: &dyn UndugGround) -> Option<SoilPatch> {
        let key = self.key;
        key.iter().all(|k| k.abs() < 1 << 26).then_some(())?;
        let mut patch = SoilPatch::bare(key, ground);
        let [saturation, soaked] = self.water;
        self.water.into_iter().all(is_share).then_some(())?;
        patch.water = BankWater { saturation, soaked };
        (patch.cut, patch.loose) = (numbers(&self.cut, CELLS, MOST_CUT)?, numbers(&self.loose, CELLS, MOST_LOOSE)?);
        for (kind, masses) in &self.masses {
            (usize::from(*kind) < kinds).then_some(())?;
            patch.masses.push((*kind, numbers(masses, CELLS, MOST_MASS)?));
        }
        patch.masses.is_sorted_by(|a, b| a.0 < b.0).then_some(())?;
        if let Some([packed, sunk, reached]) = &self.pressed {
            let list = |text: &str| numbers(text, CELLS, MOST_LOOSE);
            let lists = [list(packed)?, list(sunk)?, list(reached)?];
            let press = |i: usize| Pressed { packed: lists[0][i], sunk: lists[1][i], reached: lists[2][i] };
            patch.pressed = (0..CELLS).map(press).collect();
            patch.pressed.iter().all(|press| press.sunk <= press.packed).then_some(())?;
        }
        if let Some(broken) = &self.broken {
            patch.broken = numbers(broken, CELLS, 1)?.into_iter().map(|broken| broken != 0).collect();
        }
        (patch.revision, patch.is_unchecked) = (self.revision, self.flags[2]);
        Some(patch)
    }
}

impl SoilSite {
    /// Returns the site as text: [`SoilSite::decode`] gives a site that continues with the same bits.
    ///
    /// # Errors
    /// [`Status::Internal`] if the text cannot be written.
    pub fn encode(&self) -> Result<String> {
        let text = toml::to_string(&SavedSite::of(self, false));
        text.map_err(|e| Error::new(Status::Internal, format!("writing soil: {e}")))
    }

    /// Returns the site that [`SoilSite::encode`] wrote, on the same undug ground.
    ///
    /// # Errors
    /// [`Status::Parse`] for a text that is no site; [`Status::InvalidArgument`] naming a setting outside its range.
    pub fn decode(text: &str, ground: &dyn UndugGround) -> Result<Self> {
        let saved: SavedSite = toml::from_str(text).map_err(|e| parse_fault(toml_fault(text, &e)))?;
        saved.site(ground)
    }
}

fn parse_fault(fault: impl std::fmt::Display) -> Error {
    Error::new(Status::Parse, format!("saved soil: {fault}"))
}

impl SavedSite {
    /// Creates the saved form. With `for_hash`, each patch is given only by its hash.
    pub fn of(site: &SoilSite, for_hash: bool) -> Self {
        let settings = &site.desc.settings;
        let slots = site.field.slots.values();
        Self {
            cell_m: site.desc.cell_m,
            saturation: [settings.saturation, site.field.water.saturation, site.field.water.soaked],
            freezing_k_s: site.freezing_k_s,
            own_kinds: settings.own_kinds.iter().map(SavedKind::of).collect(),
            horizons: settings.horizons.iter().map(|horizon| (horizon.top_m, horizon.kind.0)).collect(),
            steps: site.steps,
            idle: site.idle,
            revision: site.field.revision,
            next_id: site.next_id,
            taken: site.taken.to_string(),
            brought: site.brought.to_string(),
            tools: site.tools.iter().map(SavedTool::of).collect(),
            patches: slots.map(|slot| SavedPatch::of(&site.field, *slot, for_hash)).collect(),
        }
    }

    /// Returns the site, on the same undug ground.
    ///
    /// # Errors
    /// [`Status::Parse`] for values that no site can have; [`Status::InvalidArgument`] naming a setting outside its
    /// range.
    pub fn site(&self, ground: &dyn UndugGround) -> Result<SoilSite> {
        let horizons = self.horizons.iter().map(|(top_m, kind)| SoilHorizon { top_m: *top_m, kind: SoilKindId(*kind) });
        let settings = SoilSettings {
            own_kinds: self.own_kinds.iter().map(SavedKind::kind).collect(),
            horizons: horizons.collect(),
            saturation: self.saturation[0],
        };
        let mut site = SoilSite::new(SoilSiteDesc { cell_m: self.cell_m, settings })?;
        self.fill(&mut site, ground).ok_or_else(|| parse_fault("values that no site can have"))?;
        if !site.books().is_balanced() {
            return Err(parse_fault("masses that do not balance"));
        }
        Ok(site)
    }

    fn fill(&self, site: &mut SoilSite, ground: &dyn UndugGround) -> Option<()> {
        let kinds = site.field.materials.kinds.len();
        let is_sound =
            self.saturation.into_iter().all(is_share) && (0.0..=MOST_FREEZING_K_S).contains(&self.freezing_k_s);
        (is_sound && self.steps.abs() <= MOST_STEPS && self.patches.len() <= MOST_PATCHES).then_some(())?;
        site.field.water = BankWater { saturation: self.saturation[1], soaked: self.saturation[2] };
        site.freezing_k_s = self.freezing_k_s;
        site.freeze();
        (site.steps, site.idle, site.next_id) = (self.steps, self.idle, self.next_id);
        (site.taken, site.brought) = (self.taken.parse().ok()?, self.brought.parse().ok()?);
        for tool in &self.tools {
            let is_new = site.tools.iter().all(|other| other.id < tool.id) && tool.id < self.next_id;
            site.tools.push(tool.tool(kinds).filter(|_| is_new)?);
        }
        for saved in &self.patches {
            let patch = saved.patch(kinds, ground).filter(|patch| site.field.slot(patch.key).is_none())?;
            let slot = site.field.insert(patch);
            site.field.restore(slot, saved.flags);
        }
        site.field.revision = self.revision;
        site.bar();
        Some(())
    }
}
