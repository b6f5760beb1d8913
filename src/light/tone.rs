//! Conversion of luminance to display values, in f64: the reference of `shaders/common/tone.wgsl`, and the exposure
//! that all channels of a simulator share.

use serde::{Deserialize, Serialize};

use crate::error::{Error, Result, check_range};

/// Curve from exposed values (luminance times [`Exposure::factor`]) to display values, of which 1 is display white.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum ToneCurve {
    /// No curve: the exposed value itself. Values above 1 are clamped only where they are encoded by sRGB, or by a
    /// target's format that ends at 1.
    Linear,
    /// 1 - exp(-x) for each channel (O'Neil 2005), which never reaches white: bright skies keep their gradation.
    #[default]
    Exponential,
    /// Hable's filmic curve (2010) with an exposure bias of 2 and the white point 11.2: an exposed value of 5.6 is
    /// white.
    Filmic,
}

impl ToneCurve {
    pub(crate) fn shader_value(self) -> u32 {
        match self {
            Self::Linear => 0,
            Self::Exponential => 1,
            Self::Filmic => 2,
        }
    }

    /// Applies the curve to an exposed value.
    pub fn apply(self, x: f64) -> f64 {
        let hable = |x: f64| (x * (0.15 * x + 0.05) + 0.004) / (x * (0.15 * x + 0.5) + 0.06) - 1.0 / 15.0;
        match self {
            Self::Linear => x,
            Self::Exponential => 1.0 - (-x).exp(),
            Self::Filmic => hable(2.0 * x.min(1e4)) / hable(11.2),
        }
    }
}

/// Exposure of a picture: one value for all channels of a simulator, never measured per view. [`Exposure::factor`]
/// gives it in display units per cd/m^2. Display units are exposed values, to which the tone curve has not been applied
/// yet.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Exposure {
    /// Computed in closed form from the light of sun, moon and sky at the place, and therefore equal on every channel
    /// and machine. `compensation_ev` brightens (+) or darkens (-), in stops, [-20, 20].
    Auto {
        /// Stops added.
        compensation_ev: f64,
    },
    /// A fixed exposure value at ISO 100, [-20, 30]; 15 is a sunny day, -4 a moonlit night.
    Ev100(f64),
    /// Display units per cd/m^2, (0, 1e6].
    Factor(f64),
}

impl Default for Exposure {
    fn default() -> Self {
        Self::Auto { compensation_ev: 0.0 }
    }
}

impl Exposure {
    /// Checks that the value is in range.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field.
    pub fn validate(&self) -> Result<()> {
        match *self {
            Self::Auto { compensation_ev } => {
                check_range("exposure.compensation_ev", compensation_ev, -20.0, 20.0, "EV")
            }
            Self::Ev100(ev) => check_range("exposure.ev100", ev, -20.0, 30.0, "EV"),
            Self::Factor(f) if f.is_finite() && f > 0.0 && f <= 1e6 => Ok(()),
            Self::Factor(f) => Err(Error::range("exposure.factor", "in (0, 1e6] per cd/m^2", f)),
        }
    }

    /// Returns the exposure, display units per cd/m^2. `adaptation_cd_m2` is the luminance, cd/m^2, to which an eye
    /// would adapt; only `Auto` uses it.
    pub fn factor(&self, adaptation_cd_m2: f64) -> f64 {
        match *self {
            Self::Auto { compensation_ev } => auto_factor(adaptation_cd_m2) * compensation_ev.exp2(),
            Self::Ev100(ev) => ev100_factor(ev),
            Self::Factor(f) => f,
        }
    }
}

/// Returns the exposure, display units per cd/m^2, by the saturation-based sensitivity of ISO 12232 with the usual lens
/// factor q = 0.65: the exposed value is 1 at the luminance L_max = 1.2 * 2^EV, cd/m^2.
fn ev100_factor(ev: f64) -> f64 {
    1.0 / (1.2 * ev.exp2())
}

/// Returns the exposure, display units per cd/m^2, at which the adaptation luminance has the exposed value `key` before
/// the tone curve. The key is smaller for a smaller luminance (Krawczyk, Myszkowski & Seidel 2005, eq. 11), so that a
/// night looks dark and yet is not black. Below 1e-5 cd/m^2 the exposure stays the same.
fn auto_factor(adaptation_cd_m2: f64) -> f64 {
    let luminance = adaptation_cd_m2.max(1e-5);
    let key = 1.03 - 2.0 / (2.0 + (luminance + 1.0).log10());
    key.max(0.03) / luminance
}

/// Encodes a linear value by IEC 61966-2-1 (sRGB).
pub fn srgb_encode(x: f64) -> f64 {
    let x = x.clamp(0.0, 1.0);
    if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 }
}

/// Decodes a value by IEC 61966-2-1 (sRGB).
pub fn srgb_decode(v: f64) -> f64 {
    let v = v.clamp(0.0, 1.0);
    if v <= 0.040_45 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_start_at_black_rise_and_stay_below_white() {
        for curve in [ToneCurve::Exponential, ToneCurve::Filmic] {
            assert!(curve.apply(0.0).abs() < 1e-12);
            let mut last = 0.0;
            for i in 1..200 {
                let y = curve.apply(0.02 * f64::from(i) * f64::from(i) / 160.0);
                assert!(y > last && y < 1.0, "{curve:?} {i} {y}");
                last = y;
            }
        }
    }

    #[test]
    fn srgb_round_trip() {
        for i in 0..=255 {
            let v = f64::from(i) / 255.0;
            assert!((srgb_encode(srgb_decode(v)) - v).abs() < 1e-6);
        }
    }

    #[test]
    fn exposure_is_monotone_in_light_and_checked() {
        // More light on the ground must never make a grey card darker on the display.
        let shown = |cd_m2: f64| Exposure::default().factor(cd_m2) * cd_m2;
        let mut last = 0.0;
        for i in -20..=20 {
            let y = shown(10f64.powf(f64::from(i) / 4.0));
            assert!(y >= last - 1e-12, "{i}: {y} < {last}");
            last = y;
        }
        assert!(Exposure::Ev100(f64::NAN).validate().unwrap_err().to_string().contains("exposure.ev100"));
        assert!(Exposure::Factor(0.0).validate().unwrap_err().to_string().contains("exposure.factor"));
        assert!((Exposure::Ev100(15.0).factor(0.0) * 1.2 * 32768.0 - 1.0).abs() < 1e-12);
    }
}
