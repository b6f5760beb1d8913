//! Ranges of numbers, and values of shaders made of them.

/// Least and greatest value of a number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    pub lo: f64,
    pub hi: f64,
}

/// Greatest rounding error of a normalised or trigonometric value.
pub const ROUNDING: f64 = 1e-6;

impl Range {
    pub const ALL: Self = Self { lo: f64::NEG_INFINITY, hi: f64::INFINITY };
    pub const NOT_NEGATIVE: Self = Self { lo: 0.0, hi: f64::INFINITY };
    pub const SHARE: Self = Self { lo: 0.0, hi: 1.0 };
    pub const U32: Self = Self { lo: 0.0, hi: 4_294_967_295.0 };
    pub const I32: Self = Self { lo: -2_147_483_648.0, hi: 2_147_483_647.0 };

    pub fn new(lo: f64, hi: f64) -> Self {
        // A difference or product of infinities may be anything.
        Self { lo: if lo.is_nan() { f64::NEG_INFINITY } else { lo }, hi: if hi.is_nan() { f64::INFINITY } else { hi } }
    }

    pub fn of(value: f64) -> Self {
        Self::new(value, value)
    }

    pub fn join(self, other: Self) -> Self {
        Self::new(self.lo.min(other.lo), self.hi.max(other.hi))
    }

    pub fn is_within(self, other: Self) -> bool {
        self.lo >= other.lo && self.hi <= other.hi
    }

    /// Whether all numbers of the range are so far from 0 that none is flushed to 0 as a 32-bit float.
    pub fn excludes_zero(self) -> bool {
        self.lo > 1e-37 || self.hi < -1e-37
    }

    pub fn add(self, other: Self) -> Self {
        Self::new(self.lo + other.lo, self.hi + other.hi)
    }

    pub fn negate(self) -> Self {
        Self::new(-self.hi, -self.lo)
    }

    pub fn multiply(self, other: Self) -> Self {
        let product = |a: f64, b: f64| if a == 0.0 || b == 0.0 { 0.0 } else { a * b };
        let corners = [(self.lo, other.lo), (self.lo, other.hi), (self.hi, other.lo), (self.hi, other.hi)];
        let of = corners.map(|(a, b)| product(a, b));
        Self::new(of.into_iter().fold(f64::INFINITY, f64::min), of.into_iter().fold(f64::NEG_INFINITY, f64::max))
    }

    pub fn square(self) -> Self {
        let size = self.absolute();
        size.multiply(size)
    }

    pub fn absolute(self) -> Self {
        let [low, high] = [self.lo.abs().min(self.hi.abs()), self.lo.abs().max(self.hi.abs())];
        Self::new(if self.lo <= 0.0 && self.hi >= 0.0 { 0.0 } else { low }, high)
    }

    pub fn divide(self, other: Self) -> Self {
        if other.excludes_zero() { self.multiply(Self::new(1.0 / other.hi, 1.0 / other.lo)) } else { Self::ALL }
    }

    pub fn min(self, other: Self) -> Self {
        Self::new(self.lo.min(other.lo), self.hi.min(other.hi))
    }

    pub fn max(self, other: Self) -> Self {
        Self::new(self.lo.max(other.lo), self.hi.max(other.hi))
    }

    /// Range of a function that never falls, over this range.
    pub fn rising(self, of: impl Fn(f64) -> f64) -> Self {
        Self::new(of(self.lo), of(self.hi))
    }
}

/// Known facts about an expression's value.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// A scalar or a vector.
    Numbers(Vec<Range>),
    /// A struct's members.
    Parts(Vec<Value>),
    /// An array, by the value that holds for each of its elements.
    Each(Box<Value>),
    /// A matrix, a pointer, an image.
    Other,
}

impl Value {
    pub fn scalar(range: Range) -> Self {
        Self::Numbers(vec![range])
    }

    pub fn numbers(&self) -> &[Range] {
        if let Self::Numbers(all) = self { all } else { &[] }
    }

    /// Range of all components of a vector together.
    pub fn whole(&self) -> Range {
        self.numbers().iter().copied().reduce(Range::join).unwrap_or(Range::ALL)
    }

    pub fn join(&self, other: &Self) -> Self {
        match (self, other) {
            (Self::Numbers(a), Self::Numbers(b)) if a.len() == b.len() => {
                Self::Numbers(a.iter().zip(b).map(|(a, b)| a.join(*b)).collect())
            }
            (Self::Parts(a), Self::Parts(b)) if a.len() == b.len() => {
                Self::Parts(a.iter().zip(b).map(|(a, b)| a.join(b)).collect())
            }
            (Self::Each(a), Self::Each(b)) => Self::Each(Box::new(a.join(b))),
            _ => Self::Other,
        }
    }

    pub fn is_within(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Numbers(a), Self::Numbers(b)) => a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.is_within(*b)),
            (Self::Parts(a), Self::Parts(b)) => a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.is_within(b)),
            (Self::Each(a), Self::Each(b)) => a.is_within(b),
            (_, other) => *other == Self::Other,
        }
    }

    /// A member, component or element; the union of all where the index is not known.
    pub fn part(&self, index: Option<u32>) -> Option<Self> {
        let at = index.map(|i| i as usize);
        match (self, at) {
            (Self::Numbers(all), Some(at)) => all.get(at).map(|range| Self::scalar(*range)),
            (Self::Numbers(_), None) => Some(Self::scalar(self.whole())),
            (Self::Parts(all), Some(at)) => all.get(at).cloned(),
            (Self::Each(element), _) => Some((**element).clone()),
            _ => None,
        }
    }

    /// Joins another value into the part at the end of a path.
    pub fn join_at(&mut self, path: &[Option<u32>], value: &Self) {
        let Some((first, rest)) = path.split_first() else {
            *self = self.join(value);
            return;
        };
        match (self, first) {
            (Self::Numbers(all), first) => {
                let joined = value.whole();
                let is_meant = |i: usize| first.is_none_or(|at| at as usize == i);
                all.iter_mut().enumerate().filter(|(i, _)| is_meant(*i)).for_each(|(_, r)| *r = r.join(joined));
            }
            (Self::Parts(all), Some(at)) => all[*at as usize].join_at(rest, value),
            (Self::Each(element), _) => element.join_at(rest, value),
            _ => {}
        }
    }
}
