//! Parts of the weather that a picture can draw in less detail, and the steps of detail.
//!
//! A part is drawn at one of its rungs. The first rung is all of the part. The last is nothing, or the cheapest
//! stand-in. A step leads from one rung down to the next: taking it saves work and changes the picture. Each room
//! registers its own parts ([`crate::frame::PARTS`] lists them). Budgets, plans, the C API and saved plans follow from
//! that list and grow with it.

/// Largest number of parts in a list.
pub const MOST_PARTS: usize = 16;
/// Largest number of rungs of a part.
pub const MOST_RUNGS: usize = 4;
/// Largest number of steps of all parts together.
pub const MOST_STEPS: usize = 32;

/// A part of the weather, as its room registers it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Part {
    /// Name of the part in plans, budgets and messages: lower case, unique.
    pub name: &'static str,
    /// Names of the part's rungs, from the whole part to the cheapest rung: two to [`MOST_RUNGS`] names.
    pub rungs: &'static [&'static str],
    /// Importance to viewers, [0, 1], unless a budget sets another.
    pub importance: f64,
    /// Way in which the gauge finds the change due to leaving the part out.
    pub worth: Worth,
}

/// Way in which the gauge finds the change of a picture due to leaving a part out. Except with [`Worth::Unseen`], every
/// rung but the first gets this change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Worth {
    /// The gauge composes the picture without the part, in this channel. Where several parts share a channel, each gets
    /// the change due to all of them together.
    Composed(usize),
    /// A closed form gives the change due to each rung (`plan::Unseen`). For the last rung the gauge adds the change
    /// due to the part's stand-in, in this channel.
    Unseen(usize),
    /// The gauge estimates the change in this channel, whether the part is drawn now or not. The estimates of all
    /// pixels together have the right size, but they do not say which pixels change.
    Estimated(usize),
}

/// Reason for a part's rung.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Reason {
    /// The host pinned the part.
    Pinned,
    /// No tolerance was given: all of the part is drawn.
    #[default]
    EverythingAsked,
    /// This picture has not been gauged yet, or must not depend on earlier ones: all of the part is drawn.
    NotGauged,
    /// The weather does not have the part, or the recorded stages do not draw it.
    Absent,
    /// With less of the part the error would exceed the tolerance.
    Needed,
    /// The error with less of the part is within the tolerance.
    WithinTolerance,
    /// There is no time for more of the part.
    OutOfTime,
}

impl Reason {
    /// Returns the reason in a few words.
    pub const fn text(self) -> &'static std::ffi::CStr {
        match self {
            Self::Pinned => c"the host pinned it",
            Self::EverythingAsked => c"no tolerance was given",
            Self::NotGauged => c"this picture has not been gauged yet",
            Self::Absent => c"there is none of it",
            Self::Needed => c"with less of it the error would be beyond the tolerance",
            Self::WithinTolerance => c"the error with less of it is within the tolerance",
            Self::OutOfTime => c"the time allows no more",
        }
    }
}

/// Work that one step of a part saves in a picture, in units of the work of a pixel in which no part is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StepWork {
    /// Work for each pixel in which the host drew something.
    pub object: f64,
    /// Work for each other pixel.
    pub sky: f64,
    /// Work for the whole picture, whatever its size.
    pub fixed: f64,
}

/// Set of steps that are taken, starting from everything drawn: bit i is step i of the [`Ladder`].
pub(super) type Set = u32;

/// Steps of all parts, in the order of the list.
#[derive(Clone, Debug)]
pub(super) struct Ladder {
    /// List of the parts.
    pub parts: &'static [Part],
    /// Index of each part's first step, followed by the number of all steps.
    first: Vec<usize>,
}

impl Ladder {
    /// Numbers the steps of a list of parts.
    pub fn new(parts: &'static [Part]) -> Self {
        let mut first = vec![0];
        parts.iter().for_each(|p| first.push(first[first.len() - 1] + p.rungs.len() - 1));
        debug_assert!(parts.len() <= MOST_PARTS && first[parts.len()] <= MOST_STEPS);
        Self { parts, first }
    }

    /// Returns the number of all steps.
    #[cfg(test)]
    pub fn len(&self) -> usize {
        self.first[self.parts.len()]
    }

    /// Returns the steps of a part.
    pub fn steps(&self, part: usize) -> std::ops::Range<usize> {
        self.first[part]..self.first[part + 1]
    }

    /// Returns the set in which only `part` is reduced, to `rung`.
    pub fn set(&self, part: usize, rung: usize) -> Set {
        let rung = rung.min(self.parts[part].rungs.len() - 1);
        ((1 << rung) - 1) << self.first[part]
    }

    /// Returns the set of all steps of a part.
    pub fn whole(&self, part: usize) -> Set {
        self.set(part, MOST_RUNGS)
    }

    /// Returns the rung of a part in a set.
    pub fn rung(&self, set: Set, part: usize) -> usize {
        (set & self.whole(part)).count_ones() as usize
    }

    /// Returns the set with `part` moved to `rung`.
    pub fn with(&self, set: Set, part: usize, rung: usize) -> Set {
        set & !self.whole(part) | self.set(part, rung)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets_hold_the_rung_of_every_part() {
        const fn part(name: &'static str, rungs: &'static [&'static str]) -> Part {
            Part { name, rungs, importance: 0.5, worth: Worth::Composed(0) }
        }
        const PARTS: [Part; 3] =
            [part("a", &["all", "none"]), part("b", &["all", "some", "none"]), part("c", &["all", "none"])];
        let ladder = Ladder::new(&PARTS);
        assert_eq!((ladder.len(), ladder.steps(1)), (4, 1..3));
        let set = ladder.with(ladder.set(0, 1), 1, 2);
        assert_eq!((set, [0, 1, 2].map(|p| ladder.rung(set, p))), (0b0111, [1, 2, 0]));
        assert_eq!(ladder.with(set, 1, 1), 0b0011);
        assert_eq!(ladder.set(2, 9), 0b1000, "no rung below the last");
    }
}
