//! Seeded random numbers, and values that a careless or hostile host might pass.

/// Random numbers that are the same for the same seed on every machine (SplitMix64; Steele, Lea and Flood 2014). With
/// bytes as input, each throw uses two of them, so that a fuzzer that changes a byte changes one throw.
pub struct Dice {
    state: u64,
    /// Bytes still to be used, in reverse order.
    given: Vec<u8>,
}

impl Dice {
    pub fn new(seed: u64) -> Self {
        Self { state: seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 0x5bd1_e995, given: vec![] }
    }

    /// Throws from `bytes` first, then a sequence of its own.
    pub fn of_bytes(bytes: &[u8]) -> Self {
        Self { given: bytes.iter().rev().copied().collect(), ..Self::new(0) }
    }

    /// Whether all bytes are used.
    pub fn is_spent(&self) -> bool {
        self.given.is_empty()
    }

    pub fn bits(&mut self) -> u64 {
        if let Some(first) = self.given.pop() {
            self.state = u64::from(u16::from_le_bytes([first, self.given.pop().unwrap_or(0)]));
        }
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A random whole number below `n`.
    pub fn below(&mut self, n: usize) -> usize {
        (self.bits() % n.max(1) as u64) as usize
    }

    /// True once in `n` throws, on average.
    pub fn one_in(&mut self, n: usize) -> bool {
        self.below(n) == 0
    }

    /// A number in [0, 1), evenly distributed.
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub fn pick<T: Copy>(&mut self, from: &[T]) -> T {
        from[self.below(from.len())]
    }

    /// A number as hosts pass it: mostly moderate, sometimes of any magnitude, rarely not a number.
    pub fn float(&mut self) -> f64 {
        match self.below(40) {
            0 => self.pick(&[f64::NAN, f64::INFINITY, f64::NEG_INFINITY]),
            1 => self.pick(&[f64::MAX, f64::MIN, f64::MIN_POSITIVE, 5e-324, 1e308, -1e300, f64::from(f32::MAX)]),
            2..8 => self.pick(&[0.0, -0.0, 1.0, -1.0, 0.5, 90.0, 180.0, 360.0, -90.0, 1e-9, 1e9, 1e10, 1e12]),
            8..16 => {
                let size = 10_f64.powf(24.0 * self.unit() - 12.0);
                if self.one_in(3) { -size } else { size }
            }
            16..28 => self.unit(),
            28..34 => 100.0 * self.unit(),
            _ => 20_000.0 * self.unit() - 1000.0,
        }
    }

    /// A constant, a set of flags or a small count; rarely a large number.
    pub fn whole(&mut self) -> u64 {
        match self.below(10) {
            0 => 1 << self.below(64),
            1 => self.bits(),
            2 => u64::from(u32::MAX),
            _ => self.below(16) as u64,
        }
    }
}
