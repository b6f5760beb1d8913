//! State of a context's lightning: its settings, and the flashes that the host triggered.

use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::{
    flash::FlashKind,
    settings::{LightningSettings, MAX_TRIGGERED, StormCell},
    trigger::FlashTrigger,
};
use crate::{
    error::{Error, Result, Status},
    world::{HeldEffect, UpdateBudget, World, parse_error},
};

/// Time for which a triggered flash is kept after its first stroke, s. In this time its thunder travels 40 km.
const KEPT_S: f64 = 120.0;

/// Lightning of a context.
#[derive(Clone, Default)]
pub(crate) struct HeldLightning {
    /// Settings of the host.
    pub settings: LightningSettings,
    /// Flashes that the host triggered, until [`KEPT_S`] after each.
    pub triggered: Vec<FlashTrigger>,
    /// Revision of settings and triggered flashes.
    pub revision: u64,
}

/// Saved form of a host's storm cell.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct SavedCell {
    /// Middle of the cell in the host's world, m.
    position: [f64; 3],
    /// Distance from the middle within which two thirds of the flashes start, m.
    radius_m: f64,
    /// Flashes a minute.
    flashes_per_minute: f64,
}

/// Saved form of a triggered flash.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct SavedTrigger {
    /// Time of the first stroke, s of simulation time.
    time_s: f64,
    /// Position that the flash strikes or, in the cloud, passes over, in the host's world, m.
    position: [f64; 3],
    /// Whether the flash strikes the ground; otherwise it stays in the cloud.
    to_ground: bool,
    /// Largest peak current, kA; `None` for a random one.
    peak_ka: Option<f64>,
    /// Number of strokes; `None` for a random one.
    strokes: Option<u32>,
}

/// Saved form of the state.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Saved {
    /// Flashes a minute of each of the weather's storm cells; `None` for the weather's rate.
    flashes_per_minute: Option<f64>,
    /// Whether views limit flicker.
    limits_flicker: bool,
    /// Tips of tall objects in the host's world, m.
    masts: Vec<[f64; 3]>,
    /// Storm cells of the host.
    cells: Vec<SavedCell>,
    /// Flashes that the host triggered.
    triggered: Vec<SavedTrigger>,
}

/// Table and key of the lightning in a saved state.
const TABLE: &str = "settings";
const KEY: &str = "lightning";

impl HeldLightning {
    /// Removes the lightning from the saved state `state` and returns it. Without lightning in the state it returns the
    /// default settings.
    ///
    /// # Errors
    /// [`Status::Parse`] for a value of another form or for more than [`MAX_TRIGGERED`] triggered flashes.
    /// [`Status::InvalidArgument`] naming a field that is out of range.
    pub fn read(&self, state: &mut toml::Table) -> Result<Self> {
        let revision = self.revision + 1;
        let settings = state.get_mut(TABLE).and_then(toml::Value::as_table_mut);
        let Some(value) = settings.and_then(|s| s.remove(KEY)) else { return Ok(Self { revision, ..Self::default() }) };
        let saved: Saved = value.try_into().map_err(|e| parse_error(format_args!("{KEY}: {e}")))?;
        let cell = |c: &SavedCell| StormCell {
            position: DVec3::from_array(c.position),
            radius_m: c.radius_m,
            flashes_per_minute: c.flashes_per_minute,
        };
        let trigger = |t: &SavedTrigger| FlashTrigger {
            time_s: t.time_s,
            position: DVec3::from_array(t.position),
            kind: if t.to_ground { FlashKind::ToGround } else { FlashKind::InCloud },
            peak_ka: t.peak_ka,
            strokes: t.strokes,
        };
        let read = Self {
            settings: LightningSettings {
                flashes_per_minute: saved.flashes_per_minute,
                cells: saved.cells.iter().map(cell).collect(),
                masts: saved.masts.into_iter().map(DVec3::from_array).collect(),
                limits_flicker: saved.limits_flicker,
            },
            triggered: saved.triggered.iter().map(trigger).collect(),
            revision,
        };
        let checked =
            read.settings.validate().and_then(|()| read.triggered.iter().try_for_each(FlashTrigger::validate));
        checked.map_err(|e| e.found_in("saved state"))?;
        if read.triggered.len() > MAX_TRIGGERED {
            return Err(parse_error(format_args!("{KEY}: more than {MAX_TRIGGERED} triggered flashes")));
        }
        Ok(read)
    }

    /// Adds a flash. `now_s` is the present.
    ///
    /// # Errors
    /// [`Status::InvalidArgument`] naming a field that is out of range, or if there are [`MAX_TRIGGERED`] flashes
    /// already; [`Status::WrongOrder`] for a flash in the past. After an error nothing has changed.
    pub fn trigger(&mut self, flash: &FlashTrigger, now_s: f64) -> Result<()> {
        flash.validate()?;
        if flash.time_s < now_s {
            let rest = format!("must be at least the present, {now_s} s, got {}", flash.time_s);
            return Err(Error::about(Status::WrongOrder, "flash.time_s", rest));
        }
        if self.triggered.len() >= MAX_TRIGGERED {
            let accepted = format!("one of at most {MAX_TRIGGERED} to come or within {KEPT_S} s after it");
            return Err(Error::range("flash", &accepted, "one more"));
        }
        self.triggered.push(*flash);
        self.revision += 1;
        Ok(())
    }
}

impl HeldEffect for HeldLightning {
    fn advance(&mut self, world: &World, _within: UpdateBudget) -> Result<Status> {
        self.triggered.retain(|t| t.time_s + KEPT_S >= world.time_s);
        Ok(Status::Ok)
    }

    fn save(&self, state: &mut toml::Table) -> Result<()> {
        let set = &self.settings;
        if *set == LightningSettings::default() && self.triggered.is_empty() {
            return Ok(());
        }
        let saved = Saved {
            flashes_per_minute: set.flashes_per_minute,
            limits_flicker: set.limits_flicker,
            masts: set.masts.iter().map(|m| m.to_array()).collect(),
            cells: set
                .cells
                .iter()
                .map(|c| SavedCell {
                    position: c.position.to_array(),
                    radius_m: c.radius_m,
                    flashes_per_minute: c.flashes_per_minute,
                })
                .collect(),
            triggered: self
                .triggered
                .iter()
                .map(|t| SavedTrigger {
                    time_s: t.time_s,
                    position: t.position.to_array(),
                    to_ground: t.kind == FlashKind::ToGround,
                    peak_ka: t.peak_ka,
                    strokes: t.strokes,
                })
                .collect(),
        };
        let written = |e| Error::new(Status::Internal, format!("the state cannot be written: {e}"));
        let value = toml::Value::try_from(saved).map_err(written)?;
        let settings = state.entry(TABLE).or_insert_with(|| toml::Table::new().into());
        if let Some(settings) = settings.as_table_mut() {
            settings.insert(KEY.into(), value);
        }
        Ok(())
    }
}
