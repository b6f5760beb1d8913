//! The sea of a context: from settings and weather to waves, statistics, and surfaces that are kept for queries.

use std::{f64::consts::TAU, sync::Arc};

use glam::DVec2;

use super::{
    bins::{BINS, Bins, MAX_SYSTEMS, Spreading, WaveSystem, bin_rad_s, toward_of},
    dispersion::wave_length_m,
    foam::{FoamLaw, whitecap_share},
    growth::{GrowthState, gamma_of_variance, kept_variance_m2, peak_of_variance_rad_s},
    history::{DatedGrowth, GrowthHistory},
    lattice::{SeaWave, list},
    settings::{MAX_SWELLS, MOST_STEEPNESS, SeaSettings, WindSea, developed_period_s},
    single::SingleWave,
    slopes::mean_square_slope,
    spectrum::{GROWING_GAMMA, highest_over_significant, significant_height_m},
    spreading::{beta_of_width, swell_width},
    surface::{SeaSurface, StillSea},
    tiles::{TileWork, WaveTiles},
    water::refractive_index,
};
use crate::weather::{Timeline, wave_height_of_state_m};

/// Peak enhancement of swells: between that of a wind sea and the 10 of very distant swells (Goda 2010, 2.3).
const SWELL_GAMMA: f64 = 7.0;
/// Number of surfaces that are kept, each for one time.
const KEPT_SURFACES: usize = 2;
/// Largest share of the variance that narrow crests take and strengthening gives back.
const MOST_LOST: f64 = 0.05;
/// Wavelength of the refractive index, nm: where the eye sees best.
const SEEN_NM: f64 = 550.0;
/// Time over which the largest wave is expected, s.
const HOUR_S: f64 = 3600.0;

/// Statistics of the sea at a time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SeaStatistics {
    /// Level without waves, m above mean sea level.
    pub level_m: f64,
    /// Significant height of all waves, m: four standard deviations of the surface's height, single waves included.
    pub significant_height_m: f64,
    /// Period of the strongest waves, s; that of the highest single wave if there are no others, 0 without waves.
    pub peak_period_s: f64,
    /// Mean direction that the waves come from, weighted by variance, degrees clockwise from true north; 0 without
    /// waves.
    pub mean_from_deg: f64,
    /// Mean square slope of the surface: Cox and Munk's (1954) for the wind, less under ice, or `drawn_square_slope` if
    /// that is larger.
    pub mean_square_slope: f64,
    /// Mean square slope of the waves of the surface. The rest of `mean_square_slope` is in waves too short for the
    /// surface.
    pub drawn_square_slope: f64,
    /// Height of the largest wave expected in an hour, m, crest to trough, plus the heights of all single waves.
    pub highest_in_hour_m: f64,
    /// Share of the sea under whitecaps, 0 to 1 (Monahan and O'Muircheartaigh 1980), less under ice. 0 if the settings
    /// exclude whitecaps.
    pub whitecap_share: f64,
    /// Temperature of the water, degrees Celsius.
    pub water_temperature_c: f64,
    /// Refractive index of the water against air at 550 nm (Quan and Fry 1995).
    pub refractive_index: f64,
    /// Diffuse attenuation of downward light, 1/m, at 450, 550 and 650 nm (Jerlov 1976).
    pub attenuation_per_m: [f64; 3],
}

/// Systems of waves, and the wind to which the short waves have adapted.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Systems {
    list: [WaveSystem; MAX_SYSTEMS],
    count: usize,
    wind_m_s: f64,
    /// Mean square slope at which the drawn waves end.
    most_slope: f64,
}

/// Settings in the form that the model reads.
#[derive(Clone, Debug)]
pub(super) struct PreparedSea {
    pub settings: SeaSettings,
    seed: u64,
    /// Swells of the settings.
    swells: [WaveSystem; MAX_SWELLS],
    /// Single waves of the settings, as ice leaves them.
    singles: Vec<SeaWave>,
    /// Form of the weather's swell. The state of growth gives its height, period and direction.
    weathers_swell: WaveSystem,
}

/// Returns the variance, m^2, of a significant height.
fn variance_m2(significant_m: f64) -> f64 {
    let quarter = 0.25 * significant_m;
    quarter * quarter
}

impl PreparedSea {
    /// Prepares valid settings.
    pub fn new(settings: SeaSettings, seed: u64) -> Self {
        let beta = beta_of_width(swell_width(1.0));
        let swell = |height_m: f64, period_s: f64, toward: DVec2, beta: f64| WaveSystem {
            m0_m2: variance_m2(height_m),
            peak_rad_s: TAU / period_s,
            gamma: SWELL_GAMMA,
            toward,
            spreading: Spreading::Even(beta),
            deep_share: 0.0,
            is_shaped: false,
        };
        let weathers_swell = swell(0.0, 10.0, DVec2::ZERO, beta);
        let mut swells = [weathers_swell; MAX_SWELLS];
        for (to, from) in swells.iter_mut().zip(settings.swells.iter().flatten()) {
            let beta = from.spread_deg.map_or(beta, |deg| beta_of_width(deg.to_radians()));
            *to = swell(from.height_m, from.period_s, toward_of(from.from_deg), beta);
        }
        let single = |wave: &SingleWave| {
            let wave = wave.wave(settings.depth_m);
            let kept = settings.ice.map_or(1.0, |ice| ice.amplitude_share(wave.frequency_hz, TAU * wave.turns_per_m));
            SeaWave { amplitude_m: wave.amplitude_m * kept, ..wave }
        };
        let singles = settings.waves.iter().map(single).collect();
        Self { settings, seed, swells, singles, weathers_swell }
    }

    /// Returns the wave systems of a state of growth.
    fn systems(&self, grown: &GrowthState) -> Systems {
        let (wind_sea, wind_m_s, most_slope) = self.wind_sea(grown);
        let mut systems = Systems { list: [wind_sea; MAX_SYSTEMS], count: 1, wind_m_s, most_slope };
        let mut push = |swell: WaveSystem| {
            systems.list[systems.count] = self.limited(swell);
            systems.count += 1;
        };
        match &self.settings.swells {
            Some(swells) => self.swells[..swells.len()].iter().for_each(|swell| push(*swell)),
            None if grown.swell_m2 > 1e-8 => push(WaveSystem {
                m0_m2: grown.swell_m2,
                peak_rad_s: (grown.swell_peaks / grown.swell_m2).clamp(TAU / 30.0, TAU),
                toward: (grown.swell_toward / grown.swell_m2).clamp_length_max(1.0),
                ..self.weathers_swell
            }),
            None => {}
        }
        systems
    }

    /// Returns the wind sea, the wind that roughens it, and the slope at which its drawn waves end.
    fn wind_sea(&self, grown: &GrowthState) -> (WaveSystem, f64, f64) {
        let toward = match self.settings.from_deg {
            Some(deg) => toward_of(deg),
            // If a height is set and there has been no wind, the waves come from north, as the wind of a calm does.
            None if grown.toward == DVec2::ZERO => toward_of(0.0),
            None => grown.toward,
        };
        let sea = |m0_m2: f64, peak_rad_s: f64, gamma: f64, deep_share: f64| {
            let spreading = Spreading::WindSea;
            self.limited(WaveSystem { m0_m2, peak_rad_s, gamma, toward, spreading, deep_share, is_shaped: true })
        };
        let short = grown.short_wind_m_s;
        let developed = |height_m: f64| sea(variance_m2(height_m), TAU / developed_period_s(height_m), 1.0, 0.0);
        match self.settings.wind_sea {
            WindSea::Weather => {
                let system = sea(grown.m0_m2, grown.peak_rad_s, grown.gamma, 1.0 - grown.given);
                (system, short, mean_square_slope(short))
            }
            WindSea::Height { significant_m, peak_period_s: Some(period_s), gamma } => {
                let gamma = gamma.unwrap_or(GROWING_GAMMA);
                (sea(variance_m2(significant_m), TAU / period_s, gamma, 0.0), short, f64::INFINITY)
            }
            WindSea::Height { significant_m, peak_period_s: None, gamma } => {
                let system = WaveSystem { gamma: gamma.unwrap_or(1.0), ..developed(significant_m) };
                (system, short, f64::INFINITY)
            }
            WindSea::SeaState(state) => (developed(wave_height_of_state_m(state)), short, f64::INFINITY),
            WindSea::Beaufort(number) => {
                let wind = 0.836 * number * number.sqrt();
                let m0 = kept_variance_m2(wind, self.settings.fetch_m);
                let system = sea(m0, peak_of_variance_rad_s(m0, wind), gamma_of_variance(m0, wind), 1.0);
                (system, wind, mean_square_slope(wind))
            }
        }
    }

    /// Returns a system with its height limited by [`MOST_STEEPNESS`]. Settings are checked beforehand, but a weather
    /// may give steeper waves.
    fn limited(&self, system: WaveSystem) -> WaveSystem {
        let most_m = MOST_STEEPNESS * wave_length_m(TAU / system.peak_rad_s, self.settings.depth_m);
        WaveSystem { m0_m2: system.m0_m2.min(variance_m2(most_m)), ..system }
    }
}

/// A surface that is kept, and its time.
struct KeptSurface {
    time_s: f64,
    used: u64,
    surface: Arc<SeaSurface>,
}

/// Everything that is worked out for queries, kept until its inputs change.
pub(super) struct SeaWorkshop {
    timeline_revision: Option<u64>,
    history: GrowthHistory,
    systems: Option<Systems>,
    bins: Bins,
    waves: Vec<SeaWave>,
    tiles: WaveTiles,
    statistics: SeaStatistics,
    foam: FoamLaw,
    work: TileWork,
    surfaces: Vec<KeptSurface>,
    /// Number of queries so far.
    queries: u64,
}

/// The weather's timeline with its revision, and the states of growth that the sea has kept from changes that the
/// timeline has forgotten.
#[derive(Clone, Copy)]
pub(super) struct WeatherPast<'a> {
    pub timeline: &'a Timeline,
    pub revision: u64,
    pub kept: &'a [DatedGrowth],
}

impl SeaWorkshop {
    /// Creates the workshop of a sea.
    pub fn new(sea: &PreparedSea) -> Self {
        let depth_m = sea.settings.depth_m;
        let mut bins = Bins::new(depth_m);
        bins.ice = sea.settings.ice;
        let kept = |_| KeptSurface { time_s: f64::NAN, used: 0, surface: Arc::new(SeaSurface::new()) };
        Self {
            timeline_revision: None,
            history: GrowthHistory::default(),
            systems: None,
            bins,
            waves: Vec::with_capacity(512),
            tiles: WaveTiles::new(sea.seed, depth_m),
            statistics: SeaStatistics::default(),
            foam: FoamLaw::NONE,
            work: TileWork::new(),
            surfaces: (0..KEPT_SURFACES).map(kept).collect(),
            queries: 0,
        }
    }

    /// Returns the states of growth at the beginnings and ends of the timeline's changes.
    pub fn history(&mut self, sea: &PreparedSea, past: &WeatherPast<'_>) -> &GrowthHistory {
        if self.timeline_revision != Some(past.revision) {
            self.history.fill(past.timeline, sea.settings.fetch_m, past.kept);
            self.timeline_revision = Some(past.revision);
            // The kept surfaces belong to the earlier timeline.
            self.surfaces.iter_mut().for_each(|kept| kept.time_s = f64::NAN);
        }
        &self.history
    }

    /// Updates the waves' amplitudes, the statistics and the foam to the weather of a time.
    fn follow(&mut self, sea: &PreparedSea, past: &WeatherPast<'_>, time_s: f64) {
        let grown = self.history(sea, past).at(past.timeline, sea.settings.fetch_m, time_s);
        let systems = sea.systems(&grown);
        if self.systems == Some(systems) {
            return;
        }
        self.bins.fill(&systems.list[..systems.count], systems.most_slope);
        list(&self.bins, sea.seed, sea.settings.depth_m, &mut self.waves);
        self.sort_waves();
        self.tiles.fill(&self.bins);
        self.systems = Some(systems);
        let factor = self.strengthen();
        self.count(sea, &systems, factor);
        self.waves.extend_from_slice(&sea.singles);
        self.sort_waves();
    }

    /// Sorts the waves from long to short; waves of the same length by their phases.
    fn sort_waves(&mut self) {
        self.waves.sort_unstable_by(|a, b| a.turns_per_m.total_cmp(&b.turns_per_m).then(a.phase.total_cmp(&b.phase)));
    }

    /// Strengthens all waves so that heights at fixed places have the variance that was asked for. Horizontal motion
    /// narrows crests. Let a, b and c be the sums over the waves of k coth(k h) times variance times cos^2, sin^2 and
    /// cos sin of the direction. The variance at fixed places is then m0 - a^2 - b^2 - 2 c^2 to second order: the mean
    /// of z^2 J less the square of the mean of z J, with the height z and the Jacobian J. Returns the factor on the
    /// variance: some 1.01 or less, more only in seas close to breaking, and never more than 1.06.
    fn strengthen(&mut self) -> f64 {
        let mut variance = self.tiles.tiles.iter().map(|t| t.variance_m2).sum::<f64>();
        let mut sums = [0.0; 3];
        for tile in &self.tiles.tiles {
            sums.iter_mut().zip(tile.narrowing_m).for_each(|(sum, part)| *sum += part);
        }
        for wave in &self.waves {
            let own = 0.5 * wave.amplitude_m * wave.amplitude_m;
            let steep = TAU * wave.turns_per_m * wave.stretch * own;
            let (x, y) = (wave.toward.x, wave.toward.y);
            variance += own;
            sums.iter_mut().zip([x * x, y * y, x * y]).for_each(|(sum, part)| *sum += steep * part);
        }
        let lost = sums[0] * sums[0] + sums[1] * sums[1] + 2.0 * sums[2] * sums[2];
        if lost <= 0.0 {
            return 1.0;
        }
        // The loss grows as the square of the variance: f - r f^2 = 1.
        let ratio = (lost / variance).min(MOST_LOST);
        let factor = (1.0 - (1.0 - 4.0 * ratio).sqrt()) / (2.0 * ratio);
        self.waves.iter_mut().for_each(|wave| wave.amplitude_m *= factor.sqrt());
        self.tiles.tiles.iter_mut().for_each(|tile| tile.strengthen(factor));
        factor
    }

    /// Works out the statistics of the waves, whose variance was strengthened by `factor`, and of the host's single
    /// waves.
    fn count(&mut self, sea: &PreparedSea, systems: &Systems, factor: f64) {
        let mut variance = self.tiles.tiles.iter().map(|t| t.variance_m2).sum::<f64>();
        let mut slope = self.tiles.tiles.iter().map(|t| t.mean_square_slope).sum::<f64>();
        let tiles = self.tiles.tiles.iter().map(|t| t.compression).sum::<f64>();
        let mut compression = tiles;
        for wave in &self.waves {
            let own = 0.5 * wave.amplitude_m * wave.amplitude_m;
            let k = TAU * wave.turns_per_m;
            variance += own;
            slope += own * k * k;
            compression += own * k * k * wave.stretch * wave.stretch;
        }
        let random = significant_height_m(variance / factor);
        let own = |wave: &SeaWave| 0.5 * wave.amplitude_m * wave.amplitude_m;
        let single: f64 = sea.singles.iter().map(own).sum();
        slope +=
            sea.singles.iter().map(|wave| own(wave) * (TAU * wave.turns_per_m) * (TAU * wave.turns_per_m)).sum::<f64>();
        let energy = |b: usize| self.bins.waves_m2[b].iter().chain(&self.bins.tiles_m2[b]).sum::<f64>();
        let second: f64 = (0..BINS).map(|b| energy(b) * bin_rad_s(b as f64 + 0.5).powi(2)).sum();
        // A bin's width in frequency grows as w, so the density is the energy over w.
        let dense = |b: usize| energy(b) / bin_rad_s(b as f64 + 0.5);
        let peak = (0..BINS).fold(0, |best, b| if dense(b) > dense(best) { b } else { best });
        let open = 1.0 - sea.settings.ice.map_or(0.0, |ice| ice.cover);
        let waves_in_hour = if variance > 0.0 { HOUR_S * (second * factor / variance).sqrt() / TAU } else { 1.0 };
        self.statistics = SeaStatistics {
            significant_height_m: significant_height_m(variance / factor + single),
            peak_period_s: if variance > 0.0 { TAU / self.peak_rad_s(peak) } else { highest_period_s(&sea.singles) },
            mean_from_deg: mean_from_deg(systems, &sea.singles),
            mean_square_slope: (open * mean_square_slope(systems.wind_m_s)).max(slope),
            drawn_square_slope: slope,
            highest_in_hour_m: random * highest_over_significant(waves_in_hour)
                + sea.singles.iter().map(|wave| 2.0 * wave.amplitude_m).sum::<f64>(),
            whitecap_share: if sea.settings.without_whitecaps { 0.0 } else { open * whitecap_share(systems.wind_m_s) },
            ..SeaStatistics::default()
        };
        let share = self.statistics.whitecap_share;
        self.foam = FoamLaw::new(share, [compression, tiles], sea.settings.salinity_g_kg);
    }

    /// Returns the frequency of the highest density, rad/s, in or beside a bin: the top of a parabola through the
    /// densities of three bins.
    fn peak_rad_s(&self, bin: usize) -> f64 {
        let dense = |b: usize| {
            let energy: f64 = self.bins.waves_m2[b].iter().chain(&self.bins.tiles_m2[b]).sum();
            energy / bin_rad_s(b as f64 + 0.5)
        };
        let middle = bin as f64 + 0.5;
        if bin == 0 || bin + 1 >= BINS {
            return bin_rad_s(middle);
        }
        let (a, b, c) = (dense(bin - 1), dense(bin), dense(bin + 1));
        let bend = a - 2.0 * b + c;
        let off = if bend < 0.0 { 0.5 * (a - c) / bend } else { 0.0 };
        bin_rad_s(middle + off.clamp(-0.5, 0.5))
    }

    /// Returns the statistics at a time.
    pub fn statistics(&mut self, sea: &PreparedSea, past: &WeatherPast<'_>, time_s: f64) -> SeaStatistics {
        self.follow(sea, past, time_s);
        let temperature_c = sea.settings.temperature_c;
        let water_temperature_c = temperature_c.unwrap_or_else(|| past.timeline.at(time_s).sea.temperature_c);
        SeaStatistics {
            level_m: sea.settings.level_at_m(time_s),
            water_temperature_c,
            refractive_index: refractive_index(sea.settings.salinity_g_kg, water_temperature_c, SEEN_NM),
            attenuation_per_m: sea.settings.clarity.diffuse_attenuation_per_m(),
            ..self.statistics
        }
    }

    /// Returns the waves at a time, from long to short, and the tiles.
    pub fn waves(&mut self, sea: &PreparedSea, past: &WeatherPast<'_>, time_s: f64) -> (&[SeaWave], &WaveTiles) {
        self.follow(sea, past, time_s);
        (&self.waves, &self.tiles)
    }

    /// Returns the surface at a time.
    pub fn surface(&mut self, sea: &PreparedSea, past: &WeatherPast<'_>, time_s: f64) -> Arc<SeaSurface> {
        self.queries += 1;
        self.history(sea, past);
        if let Some(kept) = self.surfaces.iter_mut().find(|kept| kept.time_s == time_s) {
            kept.used = self.queries;
            return kept.surface.clone();
        }
        self.follow(sea, past, time_s);
        let still = StillSea {
            level_m: sea.settings.level_at_m(time_s),
            depth_m: sea.settings.depth_m + sea.settings.level_at_m(time_s) - sea.settings.level_m,
            foam: self.foam,
        };
        let oldest = (0..KEPT_SURFACES).min_by_key(|i| self.surfaces[*i].used).unwrap_or(0);
        let kept = &mut self.surfaces[oldest];
        (kept.time_s, kept.used) = (time_s, self.queries);
        if Arc::get_mut(&mut kept.surface).is_none() {
            // Another thread still reads the old surface.
            kept.surface = Arc::new(SeaSurface::new());
        }
        if let Some(surface) = Arc::get_mut(&mut kept.surface) {
            surface.fill(&self.waves, &self.tiles, &mut self.work, (still, time_s));
        }
        kept.surface.clone()
    }
}

/// Returns the period of the highest wave, s; 0 without waves.
fn highest_period_s(waves: &[SeaWave]) -> f64 {
    let highest = waves.iter().filter(|wave| wave.amplitude_m > 0.0);
    highest.max_by(|a, b| a.amplitude_m.total_cmp(&b.amplitude_m)).map_or(0.0, |wave| 1.0 / wave.frequency_hz)
}

/// Returns the direction that waves come from, degrees, weighted by variance.
fn mean_from_deg(systems: &Systems, singles: &[SeaWave]) -> f64 {
    let of = |s: &WaveSystem| s.toward * s.m0_m2;
    let single = |wave: &SeaWave| wave.toward * (0.5 * wave.amplitude_m * wave.amplitude_m);
    let toward: DVec2 =
        systems.list[..systems.count].iter().map(of).sum::<DVec2>() + singles.iter().map(single).sum::<DVec2>();
    if toward.length_squared() <= 0.0 {
        return 0.0;
    }
    let deg = libm::atan2(-toward.x, -toward.y).to_degrees();
    if deg < 0.0 { deg + 360.0 } else { deg }
}
