//! Limit on changes of luminance for viewers whom flicker may harm.
//!
//! With the limit a flash rises once and fades: two changes. Of the flashes near a camera, one is drawn only if it
//! begins at least a second after the last drawn one. Any second then has at most three changes (WCAG 2.2, success
//! criterion 2.3.1, allows three flashes of two changes each). The choice restarts every 10 s with a second in which no
//! drawn flash begins. It therefore depends only on the flashes of these 10 s, and is the same in every view and for
//! every order in which a host draws times.

/// Length of an epoch, s. The choice in an epoch does not depend on other epochs.
pub const EPOCH_S: f64 = 10.0;
/// Least time between two drawn flashes, s.
const APART_S: f64 = 1.0;

/// Returns the beginning of the epoch of a time, s.
pub fn epoch_s(time_s: f64) -> f64 {
    (time_s / EPOCH_S).floor() * EPOCH_S
}

/// Whether the flash that begins at `time_s` is drawn. `times_s` has, in order, the times of all flashes since the
/// [`epoch_s`] of `time_s`.
pub fn is_drawn(time_s: f64, times_s: &[f64]) -> bool {
    let mut drawn_s = epoch_s(time_s);
    for t in times_s.iter().copied().filter(|t| *t <= time_s) {
        if t >= drawn_s + APART_S {
            drawn_s = t;
            if t == time_s {
                return true;
            }
        }
    }
    false
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chance::RandomStream;

    #[test]
    fn drawn_flashes_are_a_second_apart() {
        let mut chance = RandomStream::new(3, 4);
        let mut times: Vec<f64> = (0..2000).map(|_| 1000.0 * chance.even()).collect();
        times.sort_by(f64::total_cmp);
        let drawn: Vec<f64> = times
            .iter()
            .copied()
            .filter(|t| {
                let epoch: Vec<f64> = times.iter().copied().filter(|o| epoch_s(*o) == epoch_s(*t)).collect();
                is_drawn(*t, &epoch)
            })
            .collect();
        assert!(drawn.len() > 400, "{}", drawn.len());
        assert!(drawn.windows(2).all(|p| p[1] - p[0] >= APART_S), "closer than a second");
        assert!(times.windows(2).any(|p| p[1] - p[0] < 0.1), "the test has flashes that are close");
    }
}
