//! Parts of the weather that a picture may do with less of, and the steps by which it does.
//!
//! A part is drawn at one of its rungs: the first is all of it, the last is nothing of it or the cheapest that stands
//! for it. Each room registers its own parts ([`crate::frame::PARTS`] lists them); what follows from the list (budgets,
//! plans, the C API, saved plans) grows with it.

/// Most parts that a list may have.
pub const MOST_PARTS: usize = 16;
/// Most rungs of a part.
pub const MOST_RUNGS: usize = 4;
/// Most steps down of all parts together.
pub const MOST_STEPS: usize = 32;

/// A part of the weather, as its room registers it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Part {
    /// Name in plans, budgets and messages: lower case, unique.
    pub name: &'static str,
    /// Names of the ways to draw it, from all of it to the cheapest. Two to [`MOST_RUNGS`].
    pub rungs: &'static [&'static str],
    /// How much it matters to those who look, [0, 1], where a budget does not say.
    pub importance: f64,
    /// How the gauge learns what it is worth.
    pub worth: Worth,
}

/// How the gauge learns what a part is worth in a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Worth {
    /// The gauge composes the picture without it, in this channel; parts that share one are taken to be worth as much
    /// together as each.
    Composed(usize),
    /// A closed form says what each rung changes (`plan::Unseen`); to the last rung the gauge adds what then stands in
    /// the part's place, in this channel.
    Unseen(usize),
    /// The gauge estimates it in this channel, whether the part is drawn now or not: the error of the whole picture,
    /// not where in it.
    Estimated(usize),
}

/// Why a part is drawn as it is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Reason {
    /// The host pinned it.
    Pinned,
    /// No tolerance was given: everything is drawn.
    #[default]
    EverythingAsked,
    /// This picture has not been gauged yet, or may not depend on earlier ones: everything is drawn.
    NotGauged,
    /// The weather has none of it, or the stages recorded do not draw it.
    Absent,
    /// With less of it the error would be beyond the tolerance.
    Needed,
    /// The error with less of it is within the tolerance.
    WithinTolerance,
    /// The time allows no more.
    OutOfTime,
}

impl Reason {
    /// In a few words.
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

/// Work of one step of a part in a picture, in pixels with none of the parts: for each pixel in which the host drew
/// something, for each in which it drew nothing, and whatever the picture is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StepWork {
    /// For each pixel in which the host drew something.
    pub object: f64,
    /// For each other pixel.
    pub sky: f64,
    /// For the whole picture.
    pub fixed: f64,
}

/// A set of steps that are taken down from everything: bit i is step i of the [`Ladder`].
pub(super) type Set = u32;

/// The steps of all parts, in the order of the list.
#[derive(Clone, Debug)]
pub(super) struct Ladder {
    pub parts: &'static [Part],
    /// Number of each part's first step, and of all.
    first: Vec<usize>,
}

impl Ladder {
    pub fn new(parts: &'static [Part]) -> Self {
        let mut first = vec![0];
        parts.iter().for_each(|p| first.push(first[first.len() - 1] + p.rungs.len() - 1));
        debug_assert!(parts.len() <= MOST_PARTS && first[parts.len()] <= MOST_STEPS);
        Self { parts, first }
    }

    #[cfg(test)]
    pub fn len(&self) -> usize {
        self.first[self.parts.len()]
    }

    /// Steps of a part.
    pub fn steps(&self, part: usize) -> std::ops::Range<usize> {
        self.first[part]..self.first[part + 1]
    }

    /// The set in which `part` alone is at `rung`.
    pub fn set(&self, part: usize, rung: usize) -> Set {
        let rung = rung.min(self.parts[part].rungs.len() - 1);
        ((1 << rung) - 1) << self.first[part]
    }

    /// All steps of a part.
    pub fn whole(&self, part: usize) -> Set {
        self.set(part, MOST_RUNGS)
    }

    /// The rung of a part in a set.
    pub fn rung(&self, set: Set, part: usize) -> usize {
        (set & self.whole(part)).count_ones() as usize
    }

    /// The set with `part` at another rung.
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
