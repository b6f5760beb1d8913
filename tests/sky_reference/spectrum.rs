//! Errors of colours from few wavelengths against those from forty.

use welkin::light::{EARTH_WAVELENGTHS_NM, luminance};
use welkin::sky::planet::Planet;
use welkin::sky::reference::{Options, Orders, Reference, Resolution, View};
use welkin::sky::spectral::{Conversion, SpectralSet};
use welkin_support::accept;

/// Cases by their angles: the sun's zenith angle, then view zenith angle and azimuth; `None` stands for the direct
/// light of the sun.
fn cases() -> Vec<(f64, Option<(f64, f64)>)> {
    let mut cases: Vec<_> = [0.0, 60.0, 80.0, 86.0, 89.0].map(|sun| (sun, None)).to_vec();
    for sun in [20.0, 60.0, 80.0, 88.0, 90.0, 93.0, 96.0] {
        for view in [(0.0, 0.0), (45.0, 90.0), (85.0, 0.0), (85.0, 90.0), (85.0, 180.0)] {
            cases.push((sun, Some(view)));
        }
    }
    cases
}

/// Transfers of every case at three wavelengths. Without `WELKIN_ACCEPT` single scattering is enough, because its
/// spectra vary as much.
fn transfers(planet: &Planet) -> Vec<[f64; 3]> {
    let orders = Orders::Exactly(if accept() { 4 } else { 1 });
    let resolution = Resolution {
        altitudes: 10,
        sun_angles: 30,
        zeniths: 10,
        azimuths: 8,
        panel_points: 4,
        haze_directions: (19, 10),
    };
    let truth = Reference::solve(planet, &Options { orders, resolution, ..Options::default() }).unwrap();
    let ask = |(sun, view): &(f64, Option<(f64, f64)>)| match view {
        None => truth.aerial(&View::degrees(1.0, *sun, *sun, 0.0), 1e9).unwrap().transmittance,
        Some((view, azimuth)) => truth.radiance(&View::degrees(1.0, *sun, *view, *azimuth)).unwrap().radiance,
    };
    cases().iter().map(ask).collect()
}

/// Errors of the worst channel and of the luminance, both over the luminance, root mean square over the cases.
fn errors(colours: &[[f64; 3]], exact: &[[f64; 3]]) -> (f64, f64) {
    // Light scattered only once does not reach every twilight sky.
    let lit: Vec<_> = colours.iter().zip(exact).filter(|(_, b)| luminance(b) > 1e-3).collect();
    let rms = |f: &dyn Fn(&[f64; 3], &[f64; 3]) -> f64| {
        (lit.iter().map(|(a, b)| f(a, b).powi(2)).sum::<f64>() / lit.len() as f64).sqrt()
    };
    let channel = rms(&|a, b| (0..3).map(|c| ((a[c] - b[c]) / luminance(b)).abs()).fold(0.0, f64::max));
    (channel, rms(&|a, b| luminance(a) / luminance(b) - 1.0))
}

/// Colours of every case by a set of wavelengths.
fn by_set(count: usize, planet: &Planet) -> Vec<[f64; 3]> {
    let set = SpectralSet::new(count).unwrap();
    let parts: Vec<Vec<[f64; 3]>> = set.planets(planet).iter().map(transfers).collect();
    let colour = |case: usize| {
        let triples: Vec<[f64; 3]> = parts.iter().map(|p| p[case]).collect();
        set.rec709_of_triples(&triples).unwrap()
    };
    (0..cases().len()).map(colour).collect()
}

#[test]
fn three_wavelengths_against_forty() {
    let mut hazy = Planet::earth();
    for c in 0..3 {
        hazy.mie.scattering_per_m[c] *= 6.0;
        hazy.mie.extinction_per_m[c] *= 6.0;
    }
    for (name, planet) in [("clear", Planet::earth()), ("haze", hazy)] {
        let exact = by_set(40, &planet);
        let report = |what: &str, colours: &[[f64; 3]]| {
            let (channel, y) = errors(colours, &exact);
            println!("{name} {what}: worst channel {:.2} %, luminance {:.2} % (rms)", channel * 100.0, y * 100.0);
            (channel, y)
        };
        // A set's error falls with its size.
        let mut before = f64::INFINITY;
        for count in [4, 8, 16] {
            let (channel, _) = report(&format!("{count} wavelengths"), &by_set(count, &planet));
            assert!(channel < 0.6 * before);
            before = channel;
        }
        // Haze follows a power of the wavelength, which sixteen wavelengths sample less well than air alone: errors of
        // 1.5 % in light scattered once, 1.2 % in all light.
        assert!(before < 0.018);
        let three = |nm: [f64; 3], conversion: &Conversion| -> Vec<[f64; 3]> {
            let dim = Planet { solar_irradiance: [1.0; 3], ..planet.at_wavelengths(nm) };
            transfers(&dim).iter().map(|t| conversion.rec709(t)).collect()
        };
        let default = EARTH_WAVELENGTHS_NM;
        let (channel, y) = report("per channel", &three(default, &Conversion::per_channel()));
        assert!(channel < 0.19 && y < 0.035);
        let (fitted, y) = report("fitted", &three(default, &Conversion::fitted(&default).unwrap()));
        assert!(fitted < 0.25 && y < 0.035);
        // The usual triple is far worse: the reason for the default.
        let old = [680.0, 550.0, 440.0];
        let (usual, _) = report("680, 550, 440 per channel", &three(old, &Conversion::per_channel()));
        assert!(usual > 3.0 * channel);
        let golden = [440.0, 520.0, 600.0];
        let (blue_first, _) = report("440, 520, 600 fitted", &three(golden, &Conversion::fitted(&golden).unwrap()));
        assert!(blue_first < 0.4);
    }
}
