//! Water in the ground: what it leaves of the soil's cohesion, and how soon rain and dry weather change it.

/// Saturation up to which cohesion grows: 2 % of water by mass in soil whose pores hold 20 %.
const PLATEAU_FROM: f64 = 0.1;
/// Saturation from which cohesion falls.
const PLATEAU_TO: f64 = 0.85;
/// Time constant with which water soaks into ground whose surface is wet, s.
const SOAK_S: f64 = 3600.0;
/// Time constant with which ground under a dry surface returns to its saturation without rain and sun, s.
const DRAIN_S: f64 = 86_400.0;

/// Returns the share of its cohesion that soil has at this saturation (the share of its pores that water fills): 0 dry,
/// 1 from 0.1 to 0.85, 0 when full. Strength of wet sand rises up to 2 % of water, is flat to 17 % and falls towards
/// saturation (Lanzerstorfer 2019); lines connect these points.
pub fn cohesion_share(saturation: f64) -> f64 {
    let rising = saturation / PLATEAU_FROM;
    let falling = (1.0 - saturation) / (1.0 - PLATEAU_TO);
    rising.min(falling).clamp(0.0, 1.0)
}

/// Returns the saturation after `seconds`. `soaked` is the share of wet surface, 0 to 1, and `at_rest` the saturation
/// without rain and sun. Where the surface is wet, water fills the rest of the pores within an hour or two; where the
/// surface is dry, the ground returns to `at_rest` within a day or two.
pub fn saturation_after(saturation: f64, soaked: f64, at_rest: f64, seconds: f64) -> f64 {
    let [soaks, drains] = [SOAK_S, DRAIN_S].map(|time_s| 1.0 - libm::exp(-seconds / time_s));
    let [up, down] = [soaked * soaks, (1.0 - soaked) * drains];
    (saturation + up * (1.0 - saturation) + down * (at_rest - saturation)).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cohesion_is_gone_dry_and_full_and_whole_between() {
        for (saturation, share) in
            [(0.0, 0.0), (0.05, 0.5), (0.1, 1.0), (0.5, 1.0), (0.84, 1.0), (0.925, 0.5), (1.0, 0.0)]
        {
            assert!((cohesion_share(saturation) - share).abs() < 1e-9, "{saturation}");
        }
    }

    #[test]
    fn rain_fills_the_pores_within_hours_and_dry_days_drain_them() {
        let mut saturation = 0.3;
        let mut pass = |soaked: f64, minutes: u32| {
            (0..minutes).for_each(|_| saturation = saturation_after(saturation, soaked, 0.3, 60.0));
            saturation
        };
        // 1 - 0.7 exp(-1) after an hour.
        assert!((pass(1.0, 60) - 0.7425).abs() < 1e-3);
        assert!(pass(1.0, 120) > 0.96);
        assert!((pass(0.0, 3 * 1440) - 0.3).abs() < 0.04);
    }
}
