//! Groups of present weather: `+TSRA`, `FZFG`, `BLSN` (WMO code table 4678).

/// Prefix of a group.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Intensity {
    /// `-`
    Light,
    /// no prefix
    Moderate,
    /// `+`
    Heavy,
    /// `VC`: in the vicinity, 8 to 16 km away.
    Vicinity,
}

/// Descriptor of a group.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Descriptor {
    Shallow,
    Partial,
    Patches,
    Drifting,
    Blowing,
    Showers,
    Thunderstorm,
    Freezing,
}

/// Phenomenon that a group reports.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Phenomenon {
    Drizzle,
    Rain,
    Snow,
    SnowGrains,
    IceCrystals,
    IcePellets,
    Hail,
    SmallHail,
    UnknownPrecipitation,
    Mist,
    Fog,
    Smoke,
    VolcanicAsh,
    Dust,
    Sand,
    Haze,
    Spray,
    DustWhirls,
    Squall,
    FunnelCloud,
    SandStorm,
    DustStorm,
}

/// One group of present weather.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct WeatherGroup {
    pub intensity: Intensity,
    pub descriptor: Option<Descriptor>,
    /// Phenomena in the report's order, the predominant first.
    pub phenomena: Vec<Phenomenon>,
}

impl Phenomenon {
    /// Whether the phenomenon is precipitation.
    pub fn falls(self) -> bool {
        use Phenomenon as P;
        matches!(
            self,
            P::Drizzle | P::Rain | P::Snow | P::SnowGrains | P::IceCrystals | P::IcePellets | P::Hail | P::SmallHail
        ) || self == P::UnknownPrecipitation
    }
}

fn descriptor(code: &str) -> Option<Descriptor> {
    use Descriptor as D;
    Some(match code {
        "MI" => D::Shallow,
        "PR" => D::Partial,
        "BC" => D::Patches,
        "DR" => D::Drifting,
        "BL" => D::Blowing,
        "SH" => D::Showers,
        "TS" => D::Thunderstorm,
        "FZ" => D::Freezing,
        _ => return None,
    })
}

fn phenomenon(code: &str) -> Option<Phenomenon> {
    use Phenomenon as P;
    Some(match code {
        "DZ" => P::Drizzle,
        "RA" => P::Rain,
        "SN" => P::Snow,
        "SG" => P::SnowGrains,
        "IC" => P::IceCrystals,
        "PL" | "PE" => P::IcePellets,
        "GR" => P::Hail,
        "GS" => P::SmallHail,
        "UP" => P::UnknownPrecipitation,
        "BR" => P::Mist,
        "FG" => P::Fog,
        "FU" => P::Smoke,
        "VA" => P::VolcanicAsh,
        "DU" => P::Dust,
        "SA" => P::Sand,
        "HZ" => P::Haze,
        "PY" => P::Spray,
        "PO" => P::DustWhirls,
        "SQ" => P::Squall,
        "FC" => P::FunnelCloud,
        "SS" => P::SandStorm,
        "DS" => P::DustStorm,
        _ => return None,
    })
}

/// Whether a descriptor can stand before these phenomena.
fn fits(descriptor: Descriptor, phenomena: &[Phenomenon]) -> bool {
    use {Descriptor as D, Phenomenon as P};
    let falls = phenomena.iter().all(|p| p.falls());
    match descriptor {
        D::Showers | D::Thunderstorm => falls,
        D::Freezing => !phenomena.is_empty() && (falls || phenomena == [P::Fog]),
        D::Shallow | D::Partial | D::Patches => matches!(phenomena, [P::Fog | P::Mist]),
        D::Drifting => matches!(phenomena, [P::Snow | P::Dust | P::Sand]),
        D::Blowing => matches!(phenomena, [P::Snow | P::Dust | P::Sand | P::Spray]),
    }
}

/// Reads a group. The inner `None` is present weather that the instrument could not identify (`//`).
pub(super) fn weather(text: &str) -> Option<Option<WeatherGroup>> {
    if text == "//" {
        return Some(None);
    }
    let (intensity, mut rest) = match text.as_bytes().first()? {
        b'-' => (Intensity::Light, &text[1..]),
        b'+' => (Intensity::Heavy, &text[1..]),
        _ => text.strip_prefix("VC").map_or((Intensity::Moderate, text), |t| (Intensity::Vicinity, t)),
    };
    // Codes are pairs of letters; slicing by bytes is safe once the word is ASCII.
    if !rest.is_ascii() || rest.is_empty() || rest.len() % 2 != 0 || rest.len() > 10 {
        return None;
    }
    // Some stations report showers and thunder together.
    rest = rest.strip_prefix("SHTS").map_or(rest, |_| &rest[2..]);
    let described = descriptor(&rest[..2]);
    if described.is_some() {
        rest = &rest[2..];
    }
    if described == Some(Descriptor::Thunderstorm) {
        rest = rest.strip_prefix("SH").unwrap_or(rest);
    }
    let codes = rest.as_bytes().chunks(2).map(|c| std::str::from_utf8(c).ok());
    let phenomena: Vec<Phenomenon> = codes.map(|c| phenomenon(c?)).collect::<Option<_>>()?;
    let good = described.map_or(!phenomena.is_empty(), |d| fits(d, &phenomena)) && phenomena.len() <= 3;
    good.then_some(Some(WeatherGroup { intensity, descriptor: described, phenomena }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use {Descriptor as D, Intensity as I, Phenomenon as P};

    #[test]
    fn groups_of_present_weather() {
        let read = |t| weather(t).flatten().map(|g| (g.intensity, g.descriptor, g.phenomena));
        assert_eq!(read("+TSRA"), Some((I::Heavy, Some(D::Thunderstorm), vec![P::Rain])));
        assert_eq!(read("-FZDZ"), Some((I::Light, Some(D::Freezing), vec![P::Drizzle])));
        assert_eq!(read("PLRA"), Some((I::Moderate, None, vec![P::IcePellets, P::Rain])));
        assert_eq!(read("TSRAGR"), Some((I::Moderate, Some(D::Thunderstorm), vec![P::Rain, P::Hail])));
        assert_eq!(read("VCSH"), Some((I::Vicinity, Some(D::Showers), vec![])));
        assert_eq!(read("TS"), Some((I::Moderate, Some(D::Thunderstorm), vec![])));
        assert_eq!(read("FZFG"), Some((I::Moderate, Some(D::Freezing), vec![P::Fog])));
        assert_eq!(weather("//"), Some(None));
        // Stations send this group, although the code does not have it.
        assert_eq!(read("-SHTSRA"), Some((I::Light, Some(D::Thunderstorm), vec![P::Rain])));
        assert_eq!(read("TSSHRA"), Some((I::Moderate, Some(D::Thunderstorm), vec![P::Rain])));
        assert_eq!(read("-RABR"), Some((I::Light, None, vec![P::Rain, P::Mist])));
        assert_eq!(read("BCBR"), Some((I::Moderate, Some(D::Patches), vec![P::Mist])));
    }

    #[test]
    fn pairs_that_the_code_does_not_have_are_refused() {
        for bad in
            ["", "-", "+", "VC", "MI", "BL", "FZ", "BLRA", "MISN", "FZHZ", "RASNDZPLGR", "RAS", "XY", "BÄ", "RARARARA"]
        {
            assert_eq!(weather(bad), None, "{bad}");
        }
    }
}
