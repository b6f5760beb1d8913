//! A stream of chance: the same numbers for the same seed, on every machine.

/// A stream of chance that any number may begin (Steele et al. 2014, "SplitMix").
#[derive(Clone, Copy, Debug)]
pub struct Chance(u64);

impl Chance {
    /// Of a seed and what it is for.
    pub fn new(seed: u64, what: u64) -> Self {
        let mut one = Self(seed);
        let first = one.bits();
        Self(first ^ what.wrapping_mul(0xd134_2543_de82_ef95))
    }

    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut v = self.0;
        v = (v ^ (v >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        v = (v ^ (v >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        v ^ (v >> 31)
    }

    /// Evenly spread over (0, 1).
    pub fn even(&mut self) -> f64 {
        ((self.bits() >> 11) as f64 + 0.5) / (1u64 << 53) as f64
    }

    /// Normally spread about 0 (Box and Muller 1958).
    pub fn normal(&mut self) -> f64 {
        let (a, b) = (self.even(), self.even());
        (-2.0 * libm::log(a)).sqrt() * libm::cos(2.0 * std::f64::consts::PI * b)
    }
}
