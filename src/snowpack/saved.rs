//! Lying snow as text, and back. Units are whole numbers; runs of equal ones are "bits*times".

use serde::{Deserialize, Serialize};

use super::{
    column::Column,
    field::{Books, Field},
    held::SnowState,
};
use crate::{
    surroundings::Meltwater,
    world::{values, words},
};

/// Most cells of a terrain.
const MOST_CELLS: usize = 1 << 26;

/// A state as it is saved.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SavedSnow {
    time_s: f64,
    sunlight_w_m2: f64,
    country: [i64; 4],
    melted: [f64; 2],
    /// Left out where nothing was laid by fast-forward.
    #[serde(default, skip_serializing_if = "is_zero")]
    coarse_s: f64,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    field: Option<SavedField>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct SavedField {
    cells: usize,
    columns: [String; 4],
    books: [i64; 7],
    melted: [f64; 2],
}

fn is_zero(v: &f64) -> bool {
    *v == 0.0
}

fn numbers(c: &Column) -> [i64; 4] {
    [c.ice, c.water, c.depth, c.albedo]
}

fn column([ice, water, depth, albedo]: [i64; 4]) -> Option<Column> {
    Some(Column { ice, water, depth, albedo }).filter(Column::is_sound)
}

impl SavedField {
    fn of(field: &Field) -> Self {
        let list = |i: usize| words(field.columns.iter().map(move |c| numbers(c)[i] as u64));
        Self {
            cells: field.columns.len(),
            columns: [list(0), list(1), list(2), list(3)],
            books: field.books.to_array(),
            melted: [field.cover, field.runoff_mm_h],
        }
    }

    fn field(&self) -> Option<Field> {
        if self.cells > MOST_CELLS {
            return None;
        }
        let [ice, water, depth, albedo] = [0, 1, 2, 3].map(|i| values(&self.columns[i], self.cells));
        let (ice, water, depth, albedo) = (ice?, water?, depth?, albedo?);
        let at = |i: usize| column([ice[i] as i64, water[i] as i64, depth[i] as i64, albedo[i] as i64]);
        let mut field = Field::of((0..self.cells).map(at).collect::<Option<_>>()?);
        field.books = Books::from_array(self.books);
        [field.cover, field.runoff_mm_h] = self.melted;
        (field.books.balance() == field.lying()).then_some(field)
    }
}

impl SavedSnow {
    pub fn of(state: &SnowState) -> Self {
        Self {
            time_s: state.time_s,
            sunlight_w_m2: state.sunlight_w_m2,
            country: numbers(&state.country),
            melted: [state.melted.covered, state.melted.runoff_mm_h],
            coarse_s: state.coarse_s,
            field: state.field.as_ref().map(SavedField::of),
        }
    }

    /// What was saved, if it can be one of ours.
    pub fn state(&self) -> Option<SnowState> {
        let field = match &self.field {
            Some(field) => Some(field.field()?),
            None => None,
        };
        let sound = self.time_s.is_finite()
            && self.coarse_s >= 0.0
            && [self.sunlight_w_m2, self.melted[0], self.melted[1]].iter().all(|v| (0.0..1e5).contains(v));
        let [covered, runoff_mm_h] = self.melted;
        sound.then_some(SnowState {
            time_s: self.time_s,
            sunlight_w_m2: self.sunlight_w_m2,
            country: column(self.country)?,
            melted: Meltwater { covered, runoff_mm_h },
            coarse_s: self.coarse_s,
            field,
        })
    }
}
