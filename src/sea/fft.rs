//! Inverse fast Fourier transform of small squares of complex numbers, with the same bits on every machine.

/// Samples of a side.
pub(super) const SIDE: usize = 128;

/// Rows or columns that are transformed together.
const LINES: usize = 8;

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

    #[cfg(test)]
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
    lines: Box<Lines>,
}

/// [`LINES`] rows or columns that are transformed together: sample after sample, real and imaginary parts apart, so
/// that the compiler works on several lines at a time.
#[derive(Clone, Debug)]
struct Lines {
    re: [[f64; LINES]; SIDE],
    im: [[f64; LINES]; SIDE],
}

impl Lines {
    /// Replaces samples `a` and `b` by `a + factor b` and `a - factor b`.
    #[inline(always)]
    fn cross(&mut self, a: usize, b: usize, factor: Complex) {
        let ([re_a, re_b], [im_a, im_b]) = ([self.re[a], self.re[b]], [self.im[a], self.im[b]]);
        for l in 0..LINES {
            let re = re_b[l] * factor.re - im_b[l] * factor.im;
            let im = re_b[l] * factor.im + im_b[l] * factor.re;
            (self.re[a][l], self.im[a][l]) = (re_a[l] + re, im_a[l] + im);
            (self.re[b][l], self.im[b][l]) = (re_a[l] - re, im_a[l] - im);
        }
    }

    /// Transforms the four samples from `first` on. The factors of such a transform are 1 and i, so that it needs no
    /// products.
    #[inline(always)]
    fn first_four(&mut self, first: usize) {
        for l in 0..LINES {
            let of = |n: usize| (self.re[first + n][l], self.im[first + n][l]);
            let [a, b, c, d] = [of(0), of(1), of(2), of(3)];
            let (low, high) = ((a.0 + b.0, a.1 + b.1), (c.0 + d.0, c.1 + d.1));
            let (left, right) = ((a.0 - b.0, a.1 - b.1), (c.0 - d.0, c.1 - d.1));
            // The last factor is i.
            let four = [
                (low.0 + high.0, low.1 + high.1),
                (left.0 - right.1, left.1 + right.0),
                (low.0 - high.0, low.1 - high.1),
                (left.0 + right.1, left.1 - right.0),
            ];
            for (n, (re, im)) in four.into_iter().enumerate() {
                (self.re[first + n][l], self.im[first + n][l]) = (re, im);
            }
        }
    }

    /// Does the work of two steps on four samples: crosses `a` with `b` and `c` with `d` by the first factor, then `a`
    /// with `c` by the second and `b` with `d` by i times the second.
    #[inline(always)]
    fn cross_twice(&mut self, [a, b, c, d]: [usize; 4], [first, second]: [Complex; 2]) {
        let Self { re, im } = self;
        let (ra, rb, rc, rd) = (re[a], re[b], re[c], re[d]);
        let (ia, ib, ic, id) = (im[a], im[b], im[c], im[d]);
        for l in 0..LINES {
            let (br, bi) = (rb[l] * first.re - ib[l] * first.im, rb[l] * first.im + ib[l] * first.re);
            let (dr, di) = (rd[l] * first.re - id[l] * first.im, rd[l] * first.im + id[l] * first.re);
            let (er, ei, fr, fi) = (ra[l] + br, ia[l] + bi, ra[l] - br, ia[l] - bi);
            let (gr, gi, hr, hi) = (rc[l] + dr, ic[l] + di, rc[l] - dr, ic[l] - di);
            let (xr, xi) = (gr * second.re - gi * second.im, gr * second.im + gi * second.re);
            let (yr, yi) = (-(hr * second.im + hi * second.re), hr * second.re - hi * second.im);
            (re[a][l], im[a][l]) = (er + xr, ei + xi);
            (re[c][l], im[c][l]) = (er - xr, ei - xi);
            (re[b][l], im[b][l]) = (fr + yr, fi + yi);
            (re[d][l], im[d][l]) = (fr - yr, fi - yi);
        }
    }

    /// Transforms samples that are in the order of their reversed bits: sum over n of sample\[n\] exp(2 pi i n x /
    /// SIDE).
    fn transform(&mut self, factors: &[Complex; SIDE / 2]) {
        (0..SIDE).step_by(4).for_each(|at| self.first_four(at));
        let mut side = 4;
        while 4 * side <= SIDE {
            for block in (0..SIDE).step_by(4 * side) {
                for i in 0..side {
                    let four = [0, 1, 2, 3].map(|n| block + i + n * side);
                    self.cross_twice(four, [factors[i * (SIDE / (2 * side))], factors[i * (SIDE / (4 * side))]]);
                }
            }
            side *= 4;
        }
        // SIDE is twice a power of four.
        for (i, factor) in factors.iter().enumerate() {
            self.cross(i, i + SIDE / 2, *factor);
        }
    }
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
            lines: Box::new(Lines { re: [[0.0; LINES]; SIDE], im: [[0.0; LINES]; SIDE] }),
        }
    }

    /// Transforms a square in place. Only rows at most `filled` away from row 0, counted cyclically, may have values
    /// other than zero. The first index is the row (y), the second the column (x).
    pub fn square(&mut self, square: &mut [[Complex; SIDE]], filled: usize) {
        let Self { factors, order, lines } = self;
        for (n, rows) in square.chunks_exact_mut(LINES).enumerate() {
            let first = n * LINES;
            if first > filled && first + LINES - 1 + filled < SIDE {
                continue;
            }
            for (l, row) in rows.iter().enumerate() {
                for (x, &to) in order.iter().enumerate() {
                    (lines.re[to][l], lines.im[to][l]) = (row[x].re, row[x].im);
                }
            }
            lines.transform(factors);
            for (l, row) in rows.iter_mut().enumerate() {
                for (x, sample) in row.iter_mut().enumerate() {
                    *sample = Complex::new(lines.re[x][l], lines.im[x][l]);
                }
            }
        }
        for first in (0..SIDE).step_by(LINES) {
            for (row, &to) in square.iter().zip(order.iter()) {
                for (l, sample) in row[first..first + LINES].iter().enumerate() {
                    (lines.re[to][l], lines.im[to][l]) = (sample.re, sample.im);
                }
            }
            lines.transform(factors);
            for (y, row) in square.iter_mut().enumerate() {
                for (l, sample) in row[first..first + LINES].iter_mut().enumerate() {
                    *sample = Complex::new(lines.re[y][l], lines.im[y][l]);
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
