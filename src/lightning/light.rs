//! Light of a flash over time.
//!
//! A return stroke of 30 kA emits 1e6 W from each metre of its channel at its peak, between 400 and 1100 nm (Guo and
//! Krider 1982: first strokes 1.0e6 W/m, later ones 2.5e5 to 4.3e5 W/m), and 870 J/m in all (Krider, Dawson and Uman
//! 1968). The light is proportional to the current (Idone and Orville 1985). The sum of two exponentials has both
//! figures: 0.85 of the peak decays with 150 us, the rest with 5 ms, so that 1e6 W/m (0.85 x 150 us + 0.15 x 5 ms) =
//! 878 J/m. The spectrum is taken to be that of a black body of 20 000 K, which has 163 lm/W between these wavelengths.
//!
//! Before a stroke a leader comes down, the first one at 2e5 m/s, later ones at 1e7 m/s (Rakov and Uman 2003, table
//! 1.1). The tip of a later leader, some 34 m long, has 0.1 of the stroke's light (Idone and Orville 1985; Orville and
//! Idone 1982). The steps of the first leader are taken to have 0.02 of the stroke's light for 1 us in each 50 us. The
//! stroke runs up at a third of the speed of light.

use super::flash::{Flash, FlashKind, Stroke};

/// Peak power of a stroke with a current of [`OF_KA`], W/m.
const PEAK_W_M: f64 = 1e6;
/// Current for which [`PEAK_W_M`] is given, kA.
const OF_KA: f64 = 30.0;
/// Luminous efficacy of the light, lm/W.
pub(super) const LM_PER_W: f64 = 163.0;
/// Shares of the peak, and the times in which they decay to 1/e, s.
const FADES: [(f64, f64); 2] = [(0.85, 150e-6), (0.15, 5e-3)];
/// Leaders of the first stroke and of later ones: ratio of the light to that of the stroke, speed, m/s, and the time
/// for which a point of the channel shines after the leader's tip has passed, s. The ratio of the first is the mean of
/// 0.02 for 1 us in each 50 us; the time of the later ones is 34 m / 1e7 m/s.
const LEADERS: [(f64, f64, f64); 2] = [(0.02 / 50.0, 2e5, f64::INFINITY), (0.1, 1e7, 3.4e-6)];
/// Speed of the stroke, m/s.
const STROKE_M_S: f64 = 1e8;
/// Ratio of the light of a step of a flash in the cloud to that of a stroke with the same current. An assumption.
const IN_CLOUD: f64 = 0.3;
/// Time in which a flash drawn under the limit on flicker decays to 1/e, s.
const SMOOTH_S: f64 = 0.15;
/// Colour of a black body of 20 000 K in linear Rec. 709, with luminance 1.
pub const COLOR: [f64; 3] = [0.75, 0.99, 1.84];

/// Longest time before its first stroke at which a flash gives light already, s.
pub const BEFORE_S: f64 = 0.1;
/// Longest time after its last stroke at which a flash still gives light, s.
const AFTER_S: f64 = 0.06;
/// Longest time after its first stroke at which a flash drawn under the limit on flicker still gives light, s.
const SMOOTH_AFTER_S: f64 = 1.5;
/// Time after a flash's first stroke from which on its light is ignored, s. Flashes hardly ever last longer.
pub const LONGEST_S: f64 = 4.0;

/// Interval over which light is averaged, s of simulation time. If both ends are equal, the light is that of this
/// instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    /// Beginning, s.
    pub from_s: f64,
    /// End, s.
    pub until_s: f64,
}

impl Span {
    /// Returns the mean over the span of a light that starts with 1 at `start_s` and decays to 1/e in `fade_s`.
    fn mean_fading(&self, start_s: f64, fade_s: f64) -> f64 {
        let (from, until) = (self.from_s - start_s, self.until_s - start_s);
        if until < 0.0 {
            return 0.0;
        }
        if until <= from {
            return (-until / fade_s).exp();
        }
        let sum = |t: f64| -fade_s * (-t.max(0.0) / fade_s).exp_m1();
        (sum(until) - sum(from)) / (until - from)
    }

    /// Returns the share of the span that lies between two times.
    fn share_between(&self, begin_s: f64, end_s: f64) -> f64 {
        if self.until_s <= self.from_s {
            return f64::from(u8::from((begin_s..end_s).contains(&self.until_s)));
        }
        let inside = end_s.min(self.until_s) - begin_s.max(self.from_s);
        inside.max(0.0) / (self.until_s - self.from_s)
    }
}

/// Course of a flash's light over time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Course {
    /// The measured course: leaders, strokes and their decay.
    Natural,
    /// Rises once and decays smoothly, with the total light of the strokes but none of the leaders.
    Smooth,
}

impl Course {
    /// Whether a flash gives light in a span.
    pub fn shines(self, flash: &Flash, span: &Span) -> bool {
        let after_s = match self {
            Self::Natural => flash.last_s() + AFTER_S,
            Self::Smooth => flash.time_s + SMOOTH_AFTER_S,
        };
        span.until_s >= flash.time_s - BEFORE_S && span.from_s <= after_s
    }
}

/// Properties on which the light of a part of a channel depends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stretch {
    /// Position along the main channel, 0 at the upper end to 1 at the lower end. For a branch: the position on the
    /// main channel that the leader reaches at the same time.
    pub down: f64,
    /// Length of the main channel, m.
    pub length_m: f64,
    /// Ratio of the light to that of the main channel.
    pub strength: f64,
    /// Whether the part belongs to a branch. Later strokes do not take branches.
    pub is_branch: bool,
}

/// Returns the luminous flux of a part per metre, lm/m, averaged over a span.
pub fn flux_lm_m(flash: &Flash, stretch: &Stretch, span: &Span, course: Course) -> f64 {
    let used = if stretch.is_branch { 1 } else { flash.strokes().len() };
    let kind = if flash.kind == FlashKind::InCloud { IN_CLOUD } else { 1.0 };
    let unit = stretch.strength * kind * PEAK_W_M * LM_PER_W / OF_KA;
    let strokes = flash.strokes()[..used].iter();
    if course == Course::Smooth {
        let kept: f64 = FADES.iter().map(|(share, fade_s)| share * fade_s).sum();
        let energy: f64 = strokes.map(|s| s.peak_ka * kept).sum();
        return unit * energy / SMOOTH_S * span.mean_fading(flash.time_s, SMOOTH_S);
    }
    let left_m = (1.0 - stretch.down).max(0.0) * stretch.length_m;
    let one = |(i, stroke): (usize, &Stroke)| {
        let begins_s = flash.time_s + stroke.after_s;
        let (leader, speed_m_s, lasts_s) = LEADERS[i.min(1)];
        let arrives_s = begins_s - left_m / speed_m_s;
        let lit_s = begins_s + left_m / STROKE_M_S;
        if span.until_s < arrives_s || span.from_s > lit_s + AFTER_S {
            return 0.0;
        }
        let fading: f64 = FADES.iter().map(|(share, fade_s)| share * span.mean_fading(lit_s, *fade_s)).sum();
        let led = if flash.kind == FlashKind::ToGround {
            leader * span.share_between(arrives_s, (arrives_s + lasts_s).min(lit_s))
        } else {
            0.0
        };
        stroke.peak_ka * (fading + led)
    };
    unit * strokes.enumerate().map(one).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        light::{
            luminance,
            spectrum::{LUMINOUS_EFFICACY_LM_PER_W, REC709_FROM_XYZ, apply, black_body, cie_1931},
        },
        lightning::{schedule::Storm, settings::FlashTrigger},
    };

    fn flash(kind: FlashKind) -> Flash {
        let trigger =
            FlashTrigger { time_s: 10.0, position: glam::DVec3::ZERO, kind, peak_ka: Some(30.0), strokes: Some(4) };
        Storm::triggered(1, &trigger, glam::DVec2::ZERO)
    }

    const MAIN: Stretch = Stretch { down: 0.5, length_m: 5000.0, strength: 1.0, is_branch: false };

    /// 163 lm/W and the colour are those of a black body of 20 000 K.
    #[test]
    fn efficacy_and_colour_are_a_black_bodys() {
        let (mut watts, mut xyz) = (0.0, [0.0; 3]);
        for nm in 360..=1100 {
            let power = black_body(f64::from(nm), 20_000.0);
            watts += if nm >= 400 { power } else { 0.0 };
            let eye = cie_1931(f64::from(nm));
            xyz = [0, 1, 2].map(|i| xyz[i] + power * eye[i]);
        }
        let efficacy = LUMINOUS_EFFICACY_LM_PER_W * xyz[1] / watts;
        assert!((efficacy / LM_PER_W - 1.0).abs() < 0.03, "{efficacy}");
        let rgb = apply(&REC709_FROM_XYZ, &xyz).map(|v| v / xyz[1]);
        for (a, b) in rgb.iter().zip(COLOR) {
            assert!((a - b).abs() < 0.05, "{rgb:?}");
        }
        assert!((luminance(&COLOR) - 1.0).abs() < 0.01);
    }

    /// A metre of a stroke of 30 kA emits 870 J.
    #[test]
    fn a_stroke_has_the_energy_that_was_measured() {
        let mut one = flash(FlashKind::ToGround);
        one = Storm::triggered(
            1,
            &FlashTrigger {
                strokes: Some(1),
                time_s: 10.0,
                position: glam::DVec3::ZERO,
                kind: one.kind,
                peak_ka: Some(30.0),
            },
            glam::DVec2::ZERO,
        );
        let span = Span { from_s: 10.0, until_s: 11.0 };
        let joules = flux_lm_m(&one, &MAIN, &span, Course::Natural) / LM_PER_W;
        assert!((joules / 870.0 - 1.0).abs() < 0.03, "{joules}");
        let peak =
            flux_lm_m(&one, &Stretch { down: 1.0, ..MAIN }, &Span { from_s: 10.0, until_s: 10.0 }, Course::Natural);
        assert!((peak / LM_PER_W / 1e6 - 1.0).abs() < 1e-9, "{peak}");
    }

    /// The light of all frames has the same sum, however time is divided into frames.
    #[test]
    fn frames_of_any_rate_add_up_to_the_same_light() {
        for (kind, course) in [
            (FlashKind::ToGround, Course::Natural),
            (FlashKind::InCloud, Course::Natural),
            (FlashKind::ToGround, Course::Smooth),
        ] {
            let flash = flash(kind);
            let sum = |hz: f64| -> f64 {
                let frames = (5.0 * hz) as i64;
                (0..frames)
                    .map(|i| {
                        let span = Span { from_s: 9.0 + i as f64 / hz, until_s: 9.0 + (i + 1) as f64 / hz };
                        flux_lm_m(&flash, &MAIN, &span, course) / hz
                    })
                    .sum()
            };
            let whole = flux_lm_m(&flash, &MAIN, &Span { from_s: 9.0, until_s: 14.0 }, course) * 5.0;
            for hz in [24.0, 30.0, 60.0, 144.0, 1000.0] {
                assert!((sum(hz) / whole - 1.0).abs() < 1e-5, "{kind:?} {course:?} {hz}: {} of {whole}", sum(hz));
            }
        }
        let (natural, smooth) = (flash(FlashKind::ToGround), flash(FlashKind::ToGround));
        let all = Span { from_s: 0.0, until_s: 20.0 };
        let light = |f: &Flash, c| flux_lm_m(f, &MAIN, &all, c);
        // The smooth course leaves leaders out.
        assert!((light(&natural, Course::Natural) / light(&smooth, Course::Smooth) - 1.0).abs() < 0.02);
    }

    #[test]
    fn a_leader_comes_down_before_the_first_stroke_and_its_branches_with_it() {
        let flash = flash(FlashKind::ToGround);
        let at = |down: f64, time_s: f64| {
            flux_lm_m(&flash, &Stretch { down, ..MAIN }, &Span { from_s: time_s, until_s: time_s }, Course::Natural)
        };
        // 25 ms for 5 km.
        assert!(at(0.1, 9.98) > 0.0 && at(0.9, 9.98) == 0.0, "half way down");
        assert!(at(0.9, 9.9999) > 0.0 && at(0.9, 10.001) > 5.0 * at(0.9, 9.9999));
        let branch = Stretch { strength: 0.35, is_branch: true, ..MAIN };
        let second = flash.time_s + flash.strokes()[1].after_s;
        let span = Span { from_s: second, until_s: second + 1e-3 };
        let of = |s: &Stretch| flux_lm_m(&flash, s, &span, Course::Natural);
        assert!(of(&branch) < 0.01 * of(&MAIN), "later strokes take the main way");
    }
}
