//! `probe lightning`: the flashes of a storm.

use glam::DVec2;
use welkin::{Result, error::check_range, lightning::schedule::Storm};

/// The flashes of a storm over a number of hours from time 0, one per line.
///
/// # Errors
/// [`welkin::Status::InvalidArgument`], with the name of the parameter.
pub fn flashes(per_minute: f64, hours: f64) -> Result<String> {
    check_range("hours", hours, 0.0, 1000.0, "h")?;
    let storm = Storm { seed: 0, per_minute, middle_m: DVec2::ZERO, radius_m: 3000.0 };
    storm.validate()?;
    let mut out = String::from("time_s,kind,strokes,east_m,north_m,peak_ka\n");
    for f in storm.flashes(0.0, 3600.0 * hours) {
        let (kind, strokes, place) = (f.kind.name(), f.strokes().len(), f.place_m);
        out.push_str(&format!("{:.3},{kind},{strokes},{:.1},{:.1},{:.2}\n", f.time_s, place.x, place.y, f.peak_ka()));
    }
    Ok(out)
}
