//! A coarse sky that is built quickly, for tests that do not depend on an accurate sky.

use welkin::sky::SkySettings;

pub fn coarse_sky() -> SkySettings {
    SkySettings {
        orders: 4,
        suns: 32,
        altitudes: 14,
        zeniths: 11,
        azimuths: 7,
        rule_zeniths: 6,
        rule_azimuths: 8,
        build_panels: 2,
        ..SkySettings::default()
    }
}
