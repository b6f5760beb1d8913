//! Saved form of a wind field as text. It has every number, so a loaded field continues with the same bits.

use glam::{DMat3, DVec3};
use serde::{Deserialize, Serialize};

use super::{
    advect::Scheme,
    desc::{FieldChange, WindFieldDesc, WindFieldMode, WindWalls},
    live::{Anchor, Live},
    pressure::PressureMethod,
};
use crate::{
    error::{Error, Result},
    weather::WindProfile,
    world::World,
};

/// Returns the name of the solver of a scheme. The state of another solver would continue differently.
fn solver(scheme: Scheme) -> String {
    format!("{} 1", scheme.name())
}

/// Saved scheme.
#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum SavedScheme {
    SemiLagrangian,
    #[serde(rename = "maccormack")]
    MacCormack,
    Reflection,
}

/// Saved method for the pressure.
#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
enum SavedPressure {
    Multigrid { max_cycles: u32 },
    Sor { relaxation: [f32; 2], max_iterations: u32 },
}

/// Saved description.
#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SavedDesc {
    /// Centre of the field's floor in the host's world, m.
    floor_center_m: [f64; 3],
    /// Size of a cell east, north and up, m.
    cell_m: [f64; 3],
    /// Numbers of cells east, north and up.
    cells: [u32; 3],
    /// Whether the mode is [`WindFieldMode::Running`].
    running: bool,
    /// Whether the walls are [`WindWalls::Smooth`].
    smooth: bool,
    /// Absent for the default, as in states saved before schemes could be chosen.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    scheme: Option<SavedScheme>,
    /// Absent for the default, as in states saved before methods could be chosen.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pressure: Option<SavedPressure>,
    most_bytes: u64,
}

impl SavedScheme {
    fn of(scheme: Scheme) -> Self {
        match scheme {
            Scheme::SemiLagrangian => Self::SemiLagrangian,
            Scheme::MacCormack => Self::MacCormack,
            Scheme::Reflection => Self::Reflection,
        }
    }

    fn scheme(self) -> Scheme {
        match self {
            Self::SemiLagrangian => Scheme::SemiLagrangian,
            Self::MacCormack => Scheme::MacCormack,
            Self::Reflection => Scheme::Reflection,
        }
    }
}

impl SavedPressure {
    fn of(method: PressureMethod) -> Self {
        match method {
            PressureMethod::Multigrid { max_cycles } => Self::Multigrid { max_cycles },
            PressureMethod::Sor { relaxation, max_iterations } => Self::Sor { relaxation, max_iterations },
        }
    }

    fn method(self) -> PressureMethod {
        match self {
            Self::Multigrid { max_cycles } => PressureMethod::Multigrid { max_cycles },
            Self::Sor { relaxation, max_iterations } => PressureMethod::Sor { relaxation, max_iterations },
        }
    }
}

/// Saved change.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SavedChange {
    /// Simulation time of the change, s.
    start_s: f64,
    /// Description from then on; `None` for no field.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    desc: Option<SavedDesc>,
}

/// Saved field.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SavedField {
    /// Name of the solver, as [`solver`] returns it.
    solver: String,
    /// Simulation time of the velocities, s.
    time_s: f64,
    /// Simulation time of the last start, s.
    begun_s: f64,
    /// Origin of the anchor in the host's world, m.
    anchor_m: [f64; 3],
    /// Rotation from the host's axes to (east, north, up) at the anchor, column by column.
    anchor_axes: [f64; 9],
    /// Altitude of the anchor, m.
    anchor_altitude_m: f64,
    /// Lowest corner of the field, cells from the anchor.
    corner: [i64; 3],
    /// Hashes of the scenery, in hexadecimal digits.
    stood: [String; 2],
    /// Wind for which a steady field was solved: east and north components of the mean at 10 m, m/s, and roughness
    /// length, m.
    solved_for: [f64; 3],
    /// Time for which a steady field has not rested, s.
    awake_s: f64,
    /// Whether a steady field rests.
    rests: bool,
    /// Length of the previous step, s.
    last_dt_s: f64,
    /// Largest change of a velocity in the last step, m/s.
    last_change_m_s: f32,
    /// Profile as in [`Live::shown_over`]. States of older versions lack it; their fields are compared with the wind at
    /// `time_s`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    shown_over: Option<WindProfile>,
    /// Description of the field.
    desc: SavedDesc,
    /// All numbers of the field (`FlowField::numbers`), as [`written`] encodes them.
    numbers: String,
}

impl SavedDesc {
    /// Creates the saved form of a description.
    fn of(d: &WindFieldDesc) -> Self {
        Self {
            floor_center_m: d.floor_center.to_array(),
            cell_m: d.cell_m.to_array(),
            cells: d.cells,
            running: d.mode == WindFieldMode::Running,
            smooth: d.walls == WindWalls::Smooth,
            scheme: Some(d.scheme).filter(|s| *s != Scheme::default()).map(SavedScheme::of),
            pressure: Some(d.pressure).filter(|p| *p != PressureMethod::default()).map(SavedPressure::of),
            most_bytes: d.most_bytes,
        }
    }

    /// Returns the description, checked.
    fn desc(&self) -> Result<WindFieldDesc> {
        let desc = WindFieldDesc {
            floor_center: DVec3::from(self.floor_center_m),
            cell_m: DVec3::from(self.cell_m),
            cells: self.cells,
            mode: if self.running { WindFieldMode::Running } else { WindFieldMode::Steady },
            walls: if self.smooth { WindWalls::Smooth } else { WindWalls::Rough },
            scheme: self.scheme.map_or(Scheme::default(), SavedScheme::scheme),
            pressure: self.pressure.map_or(PressureMethod::default(), SavedPressure::method),
            most_bytes: self.most_bytes,
        };
        desc.validate()?;
        Ok(desc)
    }
}

impl SavedChange {
    /// Creates the saved form of a change.
    pub fn of(c: &FieldChange) -> Self {
        Self { start_s: c.start_s, desc: c.desc.as_ref().map(SavedDesc::of) }
    }

    /// Returns the change, checked.
    pub fn change(&self) -> Result<FieldChange> {
        Ok(FieldChange { start_s: self.start_s, desc: self.desc.map(|d| d.desc()).transpose()? })
    }
}

impl SavedField {
    /// Creates the saved form of a field.
    pub fn of(live: &Live) -> Self {
        let (last_dt_s, last_change_m_s) = live.field.last_step();
        Self {
            solver: solver(live.desc.scheme),
            time_s: live.time_s,
            begun_s: live.begun_s,
            anchor_m: live.anchor.origin.to_array(),
            anchor_axes: live.anchor.to_enu.to_cols_array(),
            anchor_altitude_m: live.anchor.altitude_m,
            corner: live.corner,
            stood: live.stood.map(|hash| format!("{hash:016x}")),
            solved_for: live.solved_for,
            awake_s: live.awake_s,
            rests: live.rests,
            last_dt_s,
            last_change_m_s,
            shown_over: live.shown_over,
            desc: SavedDesc::of(&live.desc),
            numbers: written(live.field.numbers()),
        }
    }

    /// Returns the saved field.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] for values that cannot be a field.
    pub fn live(&self, world: &World) -> Result<Live> {
        let unfit = |what: &str| Error::invalid("wind_field.field", what);
        let desc = self.desc.desc()?;
        let solver = solver(desc.scheme);
        if self.solver != solver {
            let got = crate::error::shown(&self.solver);
            return Err(unfit(&format!("must be of the solver `{solver}`, got `{got}`")));
        }
        let numbers = [self.time_s, self.begun_s, self.anchor_altitude_m, self.awake_s, self.last_dt_s];
        let axes = DMat3::from_cols_array(&self.anchor_axes);
        let is_rotation = (axes.transpose() * axes - DMat3::IDENTITY).to_cols_array().iter().all(|v| v.abs() < 1e-6);
        let anchor_m = DVec3::from(self.anchor_m);
        let is_sound = numbers.iter().all(|v| v.is_finite() && v.abs() < 1e11) && (0.0..=1e3).contains(&self.last_dt_s);
        let over = self.shown_over;
        let is_wind = |w: WindProfile| {
            let rest = [w.gust_m_s, w.turbulence_intensity, w.wander_deg, w.sea_roughness_length_m];
            rest.iter().all(|v| (0.0..=1e3).contains(v))
                && w.speed_m_s() <= 1e3
                && (1e-9..=1e2).contains(&w.roughness_length_m)
        };
        let is_sound = is_sound && over.is_none_or(is_wind);
        if !(is_sound && is_rotation && anchor_m.is_finite() && self.last_change_m_s.is_finite()) {
            return Err(unfit("must have finite numbers and axes that are a rotation"));
        }
        let anchor = Anchor { origin: anchor_m, to_enu: axes, altitude_m: self.anchor_altitude_m };
        let mut live = Live::saved(world, desc, anchor, self.corner, self.time_s)?;
        let (all, last_dt_s, last_change_m_s) = live.field.numbers_mut();
        (*last_dt_s, *last_change_m_s) = (self.last_dt_s, self.last_change_m_s);
        if !read(&self.numbers, all) {
            return Err(unfit("must have as many finite numbers as its cells need"));
        }
        let hash = |i: usize| u64::from_str_radix(&self.stood[i], 16).map_err(|_| unfit("must have two hashes"));
        live.stood = [hash(0)?, hash(1)?];
        (live.begun_s, live.solved_for) = (self.begun_s, self.solved_for);
        (live.awake_s, live.rests, live.shown_over) = (self.awake_s, self.rests, over);
        Ok(live)
    }
}

/// Digits of base 64.
const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
/// Number of values that are written together as 16 digits.
const GROUP: usize = 3;

/// Returns numbers as digits of base 64, three numbers in 16 digits; the last group is filled with zeros.
fn written<'a>(lists: impl Iterator<Item = &'a Vec<f32>>) -> String {
    let mut text = String::new();
    for list in lists {
        text.reserve(list.len().div_ceil(GROUP) * 16);
        for group in list.chunks(GROUP) {
            let mut bits = 0_u128;
            for i in 0..GROUP {
                bits = bits << 32 | u128::from(group.get(i).map_or(0, |v| v.to_bits()));
            }
            (0..16).rev().for_each(|d| text.push(char::from(DIGITS[(bits >> (6 * d)) as usize & 63])));
        }
    }
    text
}

/// Reads the numbers that [`written`] wrote into lists of the same lengths. Returns whether the text has exactly that
/// many numbers, all finite.
fn read<'a>(text: &str, lists: impl Iterator<Item = &'a mut Vec<f32>>) -> bool {
    let mut values = [u8::MAX; 256];
    DIGITS.iter().zip(0..).for_each(|(digit, value)| values[usize::from(*digit)] = value);
    let (groups, rest) = text.as_bytes().as_chunks::<16>();
    let mut groups = groups.iter();
    for group in lists.flat_map(|list| list.chunks_mut(GROUP)) {
        let Some(digits) = groups.next() else { return false };
        let mut bits = 0_u128;
        for digit in digits {
            let value = values[usize::from(*digit)];
            if value == u8::MAX {
                return false;
            }
            bits = bits << 6 | u128::from(value);
        }
        for (i, v) in group.iter_mut().enumerate() {
            *v = f32::from_bits((bits >> (32 * (GROUP - 1 - i))) as u32);
            if !v.is_finite() {
                return false;
            }
        }
    }
    rest.is_empty() && groups.next().is_none()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_read_bit_for_bit_and_damaged_ones_are_refused() {
        let lists = [vec![0.1_f32, -0.0, 1e-40, 3e38, 7.25], vec![-1.5; 3]];
        let text = written(lists.iter());
        assert_eq!(text.len(), 48);
        let mut found = [vec![9.0; 5], vec![9.0; 3]];
        assert!(read(&text, found.iter_mut()));
        let bits = |l: &[Vec<f32>; 2]| l.iter().flatten().map(|v| v.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&found), bits(&lists));
        let mut longer = [vec![0.0; 5], vec![0.0; 4]];
        for bad in [&text[..32], &text[1..], &format!("{text}AAAA"), &text.replace('A', "!"), &text.replace('A', "é")]
        {
            assert!(!read(bad, found.iter_mut()), "{bad}");
        }
        assert!(!read(&text, longer.iter_mut()));
        assert!(!read(&written([vec![f32::NAN; 5], vec![0.0; 3]].iter()), found.iter_mut()));
    }
}
