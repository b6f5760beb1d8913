//! Inverse fast Fourier transform of small squares of complex numbers, with the same bits on every machine.

/// Samples of a side.
pub(super) const SIDE: usize = 128;

/// Columns that are transformed together.
const COLUMNS: usize = 4;

/// A complex number.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Complex {
    pub re: f64,
    pub im: f64,
}

impl Complex {
    pub const ZERO: Self = Self { re: 0.0, im: 0.0 };

    #[inline(always)]
    pub fn new(re: f64, im: f64) -> Self {
        Self { re, im }
    }

    #[inline(always)]
    pub fn plus(self, other: Self) -> Self {
        Self::new(self.re + other.re, self.im + other.im)
    }

    #[inline(always)]
    pub fn minus(self, other: Self) -> Self {
        Self::new(self.re - other.re, self.im - other.im)
    }

    #[inline(always)]
    pub fn times(self, other: Self) -> Self {
        Self::new(self.re * other.re - self.im * other.im, self.re * other.im + self.im * other.re)
    }

    #[inline(always)]
    pub fn scaled(self, by_factor: f64) -> Self {
        Self::new(self.re * by_factor, self.im * by_factor)
    }

    /// Returns i times this.
    #[inline(always)]
    pub fn turned(self) -> Self {
        Self::new(-self.im, self.re)
    }

    #[inline(always)]
    pub fn conjugate(self) -> Self {
        Self::new(self.re, -self.im)
    }
}

/// Factors and order of a transform of [`SIDE`] samples (Cooley and Tukey 1965, radix 2, decimation in time).
#[derive(Clone, Debug)]
pub(super) struct Transform {
    factors: [Complex; SIDE / 2],
    order: [usize; SIDE],
}

impl Transform {
    pub fn new() -> Self {
        let factor = |i: usize| {
            let (sin, cos) = libm::sincos(std::f64::consts::TAU * i as f64 / SIDE as f64);
            Complex::new(cos, sin)
        };
        let bits = SIDE.trailing_zeros();
        Self {
            factors: std::array::from_fn(factor),
            order: std::array::from_fn(|i| i.reverse_bits() >> (usize::BITS - bits)),
        }
    }

    /// Transforms a row in place: sum over n of row\[n\] exp(2 pi i n x / SIDE).
    fn row(&self, row: &mut [Complex; SIDE]) {
        for (i, &j) in self.order.iter().enumerate() {
            if i < j {
                row.swap(i, j);
            }
        }
        let mut half = 1;
        while half < SIDE {
            let stride = SIDE / (2 * half);
            for block in row.chunks_exact_mut(2 * half) {
                let (low, high) = block.split_at_mut(half);
                for (i, (a, b)) in low.iter_mut().zip(high).enumerate() {
                    let turned = b.times(self.factors[i * stride]);
                    (*a, *b) = (a.plus(turned), a.minus(turned));
                }
            }
            half *= 2;
        }
    }

    /// Transforms a square in place, of which only rows within `filled` of row 0 (cyclically) are not zero. The first
    /// index is the row (y), the second the column (x).
    pub fn square(&self, square: &mut [[Complex; SIDE]], filled: usize) {
        for (y, row) in square.iter_mut().enumerate() {
            if y <= filled || y + filled >= SIDE {
                self.row(row);
            }
        }
        // A few columns at a time use all of the memory that a row's line brings.
        let mut columns = [[Complex::ZERO; SIDE]; COLUMNS];
        for first in (0..SIDE).step_by(COLUMNS) {
            for (y, row) in square.iter().enumerate() {
                for (column, sample) in columns.iter_mut().zip(&row[first..]) {
                    column[y] = *sample;
                }
            }
            columns.iter_mut().for_each(|column| self.row(column));
            for (y, row) in square.iter_mut().enumerate() {
                for (column, sample) in columns.iter().zip(&mut row[first..]) {
                    *sample = column[y];
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn squares_are_sums_of_their_waves() {
        let mut square = vec![[Complex::ZERO; SIDE]; SIDE];
        let waves = [(0usize, 3usize, 0.7, 0.2), (5, 127, -0.3, 0.9), (120, 46, 0.1, -0.4), (0, 0, 0.5, 0.0)];
        for (y, x, re, im) in waves {
            square[y][x] = Complex::new(re, im);
        }
        Transform::new().square(&mut square, 8);
        for (y, x) in [(0usize, 0usize), (1, 5), (77, 31), (127, 127)] {
            let mut sum = Complex::ZERO;
            for (ny, nx, re, im) in waves {
                let turns = ((ny * y + nx * x) % SIDE) as f64 / SIDE as f64;
                let (sin, cos) = (std::f64::consts::TAU * turns).sin_cos();
                sum = sum.plus(Complex::new(re, im).times(Complex::new(cos, sin)));
            }
            let off = sum.minus(square[y][x]);
            assert!(off.re.abs() + off.im.abs() < 1e-13, "{y} {x}: {off:?}");
        }
    }
}
