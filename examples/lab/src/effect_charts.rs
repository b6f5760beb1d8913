//! `lab chart` for each effect: its candidates against the truth in the effect's scenes.

use welkin::candidates::Method as LibraryMethod;
use welkin::plan::{Difference, Price, difference, difference::percentile};
use welkin::{Error, Result};

use crate::candidates::{Candidate, Effect, Method, as_many_drops, candidates};
use crate::chart::{COLUMNS, FRAME, FRAMES_AN_AIR, Lab, first_fields, plot, say_what_moved, today};
use crate::command::Options;
use crate::picture::{Figures, Picture};
use crate::plot::{Titles, short};
use crate::store::{Journal, Table};
use crate::timing::{Ratio, interleaved};
use crate::{cloudscapes, fog, rain, scenes, sky, snow, stars};

/// Measurements of a candidate for a chart.
pub struct Measured {
    pub cost: Ratio,
    pub error: Difference,
    /// Values of the columns that only this chart has.
    pub more: Vec<String>,
    /// 95th percentile of the error in each scene.
    pub each: Vec<f64>,
    /// Cost predicted from the work units.
    pub units: Vec<f64>,
}

impl Measured {
    /// The chart's row for the candidate.
    pub fn row(self, name: &str, family: &str, default: bool) -> Vec<String> {
        let mut row = first_fields(name, family, default, &self.cost, &self.error);
        row.extend(self.more);
        row.extend(self.each.iter().map(|v| format!("{v:.6e}")));
        row.extend(self.units.iter().map(|v| format!("{v:.4e}")));
        row.push(today());
        row
    }
}

/// Opens the journal of a chart.
pub fn open<'a>(
    lab: &Lab,
    options: &Options,
    what: &str,
    [more, units]: [&[&str]; 2],
    scenes: impl Iterator<Item = &'a str>,
) -> Result<Journal> {
    let each = scenes.map(|s| format!("p95_{s}")).collect::<Vec<_>>();
    let each = each.iter().map(String::as_str);
    let columns: Vec<&str> =
        COLUMNS.iter().chain(more).copied().chain(each).chain(units.iter().copied()).chain(["date"]).collect();
    Journal::open(&options.out, what, &lab.note(what, options), &columns, options.fresh)
}

/// Measures the candidates for which an earlier run kept no row.
fn measure(
    journal: &mut Journal,
    effect: Effect,
    mut measured: impl FnMut(&Candidate) -> Result<Measured>,
) -> Result<()> {
    let all = candidates(effect);
    for (i, c) in all.iter().enumerate() {
        if !journal.has(c.name) {
            eprintln!("  {}/{} {} ..", i + 1, all.len(), c.name);
            journal.push(measured(c)?.row(c.name, family(c), c.is_default))?;
        }
    }
    Ok(())
}

/// Saves the table, prints what changed and draws the chart with the points of all rows except the truth's own.
pub fn end(journal: Journal, titles: &Titles<'_>, stem: &std::path::Path) -> Result<Table> {
    let (mut table, old) = journal.finish()?;
    say_what_moved(&table, old.as_ref());
    table.rows.retain(|r| r[0] != TRUTH_AGAIN);
    plot(&table, "cost", titles, stem)?;
    Ok(table)
}

/// Row that compares the truth with another truth whose particles are in other places.
pub const TRUTH_AGAIN: &str = "truth-again";

/// Cost of a 640x360 frame, predicted from the work units.
fn frame_units(c: &Candidate) -> f64 {
    c.work.frame(640 * 360, true).at(&Price::default())
}

/// Error over all scenes together, with each picture exposed so that white is 1; and the 95th percentile in each scene.
fn luminance_over_scenes(pairs: &[(Picture, &Picture)]) -> Result<(Difference, Vec<f64>)> {
    let (mut a, mut b, mut each) = (Vec::new(), Vec::new(), Vec::new());
    for (drawn, truth) in pairs {
        let white = truth.white();
        let y = |p: &Picture| -> Vec<f64> { p.texels.iter().map(|t| welkin::light::luminance(t) / white).collect() };
        let [drawn, truth] = [y(drawn), y(truth)];
        each.push(difference(&drawn, &truth, 1.0)?.p95);
        a.extend(drawn);
        b.extend(truth);
    }
    Ok((difference(&a, &b, 1.0)?, each))
}

/// As [`luminance_over_scenes`], plus the mean perceptual difference.
fn over_scenes(pairs: &[(Picture, &Picture)]) -> Result<(Figures, Vec<f64>)> {
    let (luminance, each) = luminance_over_scenes(pairs)?;
    let mut perceptual = 0.0;
    for (drawn, truth) in pairs {
        perceptual += drawn.figures(truth)?.perceptual / pairs.len() as f64;
    }
    Ok((Figures { luminance, perceptual }, each))
}

/// Family of a candidate: its name up to the first number or size.
fn family(c: &Candidate) -> &'static str {
    let end = c.name.find('-').unwrap_or(c.name.len());
    match (c.effect, &c.name[..end]) {
        (Effect::Fog, "exact" | "even") => "closed form",
        (Effect::Fog, "froxels") => "froxels",
        (Effect::Fog, _) => "older laws",
        (Effect::Sky | Effect::Rain | Effect::Snow, known) => known,
        (Effect::Stars, _) => "night",
        (Effect::Clouds, "deck") => "deck",
        (Effect::Clouds, "volume") => "a sixteenth of the pixels",
        (Effect::Clouds, _) => "more pixels",
    }
}

/// Charts the ways to draw a sky.
///
/// # Errors
/// Files and the GPU.
pub fn sky(lab: &Lab, options: &Options) -> Result<()> {
    let more = [
        "moving_ms",
        "still",
        "still_low",
        "still_high",
        "still_ms",
        "rebuild_s",
        "shared_bytes",
        "view_bytes",
        "perceptual",
    ];
    let units = ["units", "units_still", "units_rebuild"];
    let mut journal = open(lab, options, Effect::Sky.name(), [&more, &units], scenes::SKY.iter().map(|s| s.name))?;
    let mut truths: Option<Vec<Vec<sky::TrueScene>>> = None;
    measure(&mut journal, Effect::Sky, |c| {
        if truths.is_none() {
            let of = |air| sky::truth(&scenes_of(air), air, sky::SIZE, options.quick);
            truths = Some(scenes::SkyAir::ALL.into_iter().map(of).collect::<Result<_>>()?);
        }
        measured_sky(lab, c, truths.as_deref().unwrap_or_default())
    })?;
    let titles = Titles {
        title: "Sky: what a frame costs against how far it is from the truth",
        x: "cost of a frame over the baseline's: 320x180, sun moved, and 1/3600 of building the air",
        y: "95th percentile of the relative error in luminance",
        note: &format!(
            "{} scenes from an excavator's seat to orbit; line: nothing is both cheaper and better; ring: the default",
            scenes::SKY.len()
        ),
    };
    let table = end(journal, &titles, &options.out.join("sky"))?;
    let titles = Titles {
        x: "cost of a further frame with the same sun, 320x180, over the baseline's",
        title: "Sky: what a frame costs while sun and altitude stay",
        ..titles
    };
    plot(&table, "still", &titles, &options.out.join("sky-still"))?;
    calibrate(&table);
    Ok(())
}

/// The sky scenes with this air.
pub fn scenes_of(air: scenes::SkyAir) -> Vec<scenes::SkyScene> {
    scenes::SKY.into_iter().filter(|s| s.air == air).collect()
}

fn measured_sky(lab: &Lab, c: &Candidate, truths: &[Vec<sky::TrueScene>]) -> Result<Measured> {
    let mut drawn = sky::make(&lab.device, c)?;
    let mut pairs = Vec::new();
    let mut rebuilds = Vec::new();
    // The clear air comes last, because frames are timed in it.
    for (air, truths) in scenes::SkyAir::ALL.into_iter().zip(truths).rev() {
        // An air that was never built, so that no tables are reused.
        let odd = air.planet().with_air_scaled(1.0 + 1e-5 * rebuilds.len() as f64 + 1e-6);
        let before = lab.baseline.run()?;
        let seconds = drawn.rebuild(&odd)?;
        rebuilds.push((seconds * 1e3, 0.5 * (before + lab.baseline.run()?)));
        drawn.rebuild(&air.planet())?;
        for (scene, truth) in scenes_of(air).iter().zip(truths) {
            let pixels = sky::pixels(scene, sky::SIZE);
            let veils = drawn.veils(scene, &pixels)?;
            pairs.push((scene.name, sky::compose(scene, &pixels, &veils, truth.ground, sky::SIZE), &truth.picture));
        }
    }
    let order = |name: &str| scenes::SKY.iter().position(|s| s.name == name);
    pairs.sort_by_key(|p| order(p.0));
    let pairs: Vec<(Picture, &Picture)> = pairs.into_iter().map(|(_, a, b)| (a, b)).collect();
    let (error, each) = over_scenes(&pairs)?;
    let frame = interleaved(&lab.baseline, lab.rounds, |i| drawn.frame(FRAME, i, true))?;
    let rebuild = Ratio::of(&rebuilds);
    let cost = frame.plus(&rebuild, 1.0 / FRAMES_AN_AIR);
    let still = interleaved(&lab.baseline, lab.rounds, |i| drawn.frame(FRAME, i, false))?;
    let pixels = u64::from(FRAME.0 * FRAME.1);
    let times = [frame.ms, still.median, still.low, still.high, still.ms, rebuild.ms * 1e-3];
    let mut more: Vec<String> = times.map(|v| format!("{v:.6e}")).into();
    more.extend([c.work.shared_bytes.to_string(), c.work.view_bytes.to_string(), format!("{:.6e}", error.perceptual)]);
    let units = [c.work.frame(pixels, true), c.work.frame(pixels, false), c.work.rebuild];
    let units = units.map(|u| u.at(&Price::default())).into();
    Ok(Measured { cost, error: error.luminance, more, each, units })
}

/// Charts the ways to draw fog.
///
/// # Errors
/// Files and the GPU.
pub fn fog(lab: &Lab, options: &Options) -> Result<()> {
    let list = scenes::fog();
    let more = ["shared_bytes", "view_bytes", "perceptual"];
    let mut journal = open(lab, options, Effect::Fog.name(), [&more, &["units"]], list.iter().map(|s| s.name))?;
    let bench = fog::Bench::new(&lab.device)?;
    measure(&mut journal, Effect::Fog, |c| {
        let hosts = list.iter().map(|s| fog::host(s, fog::SIZE)).collect::<Result<Vec<_>>>()?;
        let truths = list.iter().zip(&hosts).map(|(s, h)| fog::truth(s, h)).collect::<Result<Vec<_>>>()?;
        let mut pairs = Vec::new();
        for ((scene, host), truth) in list.iter().zip(&hosts).zip(&truths) {
            pairs.push((bench.make(c, scene, host)?.picture()?, truth));
        }
        let (error, each) = over_scenes(&pairs)?;
        // Timed in plain fog and in patches, whose law costs most.
        let frames = [1, 6].map(|s| (&list[s], fog::host(&list[s], (640, 360))));
        let mut made = Vec::new();
        for (scene, host) in frames {
            made.push(bench.make(c, scene, &host?)?);
        }
        let cost = interleaved(&lab.baseline, lab.rounds, |_| made.iter().map(fog::FogDraw::frame).sum())?;
        let bytes = [c.work.shared_bytes, c.work.view_bytes].map(|b| b.to_string());
        let more = bytes.into_iter().chain([format!("{:.6e}", error.perceptual)]).collect();
        Ok(Measured { cost, error: error.luminance, more, each, units: vec![frame_units(c)] })
    })?;
    let titles = Titles {
        title: "Fog: what a frame costs against how far it is from the truth",
        x: "cost of a frame in fog and one in patches of it, 640x360, over the baseline's",
        y: "95th percentile of the relative error in luminance",
        note: &format!(
            "{} scenes from dense fog to light haze; line: nothing is both cheaper and better; ring: the default",
            list.len()
        ),
    };
    end(journal, &titles, &options.out.join("fog")).map(|_| ())
}

/// Charts the ways to draw rain.
///
/// # Errors
/// Files and the GPU.
pub fn rain(lab: &Lab, options: &Options) -> Result<()> {
    let list = scenes::rain();
    let mut journal = open(lab, options, Effect::Rain.name(), [&[], &["units"]], list.iter().map(|s| s.name))?;
    let is_whole = candidates(Effect::Rain).iter().all(|c| journal.has(c.name)) && journal.has(TRUTH_AGAIN);
    if !is_whole {
        measure_rain(lab, &list, &mut journal)?;
    }
    let titles = Titles {
        title: "Rain: what a frame costs against how far it is from all drops drawn",
        x: "cost of fog and rain in steady rain and in a cloudburst, 640x360, over the baseline's",
        y: "95th percentile of the relative error of blocks: mean, and contrast of two sizes",
        note: &format!(
            "{} scenes by day, light rain to cloudburst; line: nothing is both cheaper and better",
            list.len() - 1
        ),
    };
    end(journal, &titles, &options.out.join("rain")).map(|_| ())
}

fn measure_rain(lab: &Lab, list: &[scenes::RainScene], journal: &mut Journal) -> Result<()> {
    let day: Vec<bool> = list.iter().map(|s| !s.lamps).collect();
    let mut hosts = list.iter().map(|s| rain::Host::new(&lab.device, s, rain::SIZE)).collect::<Result<Vec<_>>>()?;
    let mut truths = Vec::new();
    for (host, scene) in hosts.iter_mut().zip(list) {
        eprintln!("  truth of {} ..", scene.name);
        truths.push(host.truth(1)?);
    }
    // Timed in steady rain and in a cloudburst.
    let mut timed =
        [1, 3].map(|i| rain::Host::new(&lab.device, &list[i], (640, 360))).into_iter().collect::<Result<Vec<_>>>()?;
    measure(journal, Effect::Rain, |c| {
        let settings = match c.method {
            Method::Library(LibraryMethod::Rain(settings)) => settings,
            Method::SourceLod(lod) => as_many_drops(&lod),
            _ => return Err(Error::range("candidate", "one of the rain", c.name)),
        };
        let blocks = hosts.iter_mut().map(|h| h.drawn_by(c)).collect::<Result<Vec<_>>>()?;
        let (error, each) = over_blocks(&blocks, &truths, &day);
        timed.iter_mut().try_for_each(|h| h.set(settings))?;
        let cost = interleaved(&lab.baseline, lab.rounds, |_| timed.iter_mut().map(rain::Host::timed).sum())?;
        Ok(Measured { cost, error, more: Vec::new(), each, units: vec![frame_units(c)] })
    })?;
    if !journal.has(TRUTH_AGAIN) {
        // Difference between all drops and all drops in other places: no method can have a smaller error.
        let again = hosts.iter_mut().map(|h| Ok(h.truth(2)?.0)).collect::<Result<Vec<_>>>()?;
        let (error, each) = over_blocks(&again, &truths, &day);
        let measured = Measured { cost: Ratio::default(), error, more: Vec::new(), each, units: vec![0.0] };
        journal.push(measured.row(TRUTH_AGAIN, "truth", false))?;
    }
    Ok(())
}

/// Charts the ways to draw snow.
///
/// # Errors
/// Files and the GPU.
pub fn snow(lab: &Lab, options: &Options) -> Result<()> {
    let list = scenes::snow();
    let mut journal = open(lab, options, Effect::Snow.name(), [&[], &["units"]], list.iter().map(|s| s.name))?;
    if !(candidates(Effect::Snow).iter().all(|c| journal.has(c.name)) && journal.has(TRUTH_AGAIN)) {
        measure_snow(lab, &list, &mut journal)?;
    }
    let titles = Titles {
        title: "Snow: what a frame costs against how far it is from all flakes drawn",
        x: "cost of fog and snow with large flakes in hardly any wind, 640x360, over the baseline's",
        y: "95th percentile of the relative error of blocks: mean, and contrast of two sizes",
        note: &format!(
            "{} scenes by day, large flakes to storm; line: nothing is both cheaper and better; ring: the default",
            list.len()
        ),
    };
    end(journal, &titles, &options.out.join("snow")).map(|_| ())
}

fn measure_snow(lab: &Lab, list: &[scenes::RainScene], journal: &mut Journal) -> Result<()> {
    let day = vec![true; list.len()];
    let mut hosts = list.iter().map(|s| rain::Host::new(&lab.device, s, rain::SIZE)).collect::<Result<Vec<_>>>()?;
    let mut truths = Vec::new();
    for (host, scene) in hosts.iter_mut().zip(list) {
        eprintln!("  truth of {} ..", scene.name);
        truths.push(snow::truth(host, 1)?);
    }
    let mut timed = rain::Host::new(&lab.device, &list[0], (640, 360))?;
    measure(journal, Effect::Snow, |c| {
        let Method::Library(LibraryMethod::Snow(settings)) = c.method else {
            return Err(Error::range("candidate", "one of the snow", c.name));
        };
        let blocks = hosts.iter_mut().map(|h| snow::drawn_by(h, settings)).collect::<Result<Vec<_>>>()?;
        let (error, each) = over_blocks(&blocks, &truths, &day);
        timed.set_snow(settings)?;
        let cost = interleaved(&lab.baseline, lab.rounds, |_| timed.timed())?;
        Ok(Measured { cost, error, more: Vec::new(), each, units: vec![frame_units(c)] })
    })?;
    if !journal.has(TRUTH_AGAIN) {
        // Difference between all flakes and all flakes in other places: no method can have a smaller error.
        let again = hosts.iter_mut().map(|h| Ok(snow::truth(h, 2)?.0)).collect::<Result<Vec<_>>>()?;
        let (error, each) = over_blocks(&again, &truths, &day);
        let measured = Measured { cost: Ratio::default(), error, more: Vec::new(), each, units: vec![0.0] };
        journal.push(measured.row(TRUTH_AGAIN, "truth", false))?;
    }
    Ok(())
}

/// Error of blocks over all scenes by day, and in each scene.
pub fn over_blocks(drawn: &[rain::Blocks], truths: &[(rain::Blocks, f64)], day: &[bool]) -> (Difference, Vec<f64>) {
    let (mut all, mut each) = (Vec::new(), Vec::new());
    for ((blocks, (truth, white)), day) in drawn.iter().zip(truths).zip(day) {
        let mut errors = blocks.errors(truth, *white);
        errors.sort_by(f64::total_cmp);
        each.push(percentile(&errors, 0.95));
        // Light at night has another order of magnitude, so it has a column of its own.
        all.extend(errors.into_iter().filter(|_| *day));
    }
    all.sort_by(f64::total_cmp);
    let at = |share| percentile(&all, share);
    (Difference { median: at(0.5), p95: at(0.95), worst: at(1.0) }, each)
}

/// Charts the ways to draw the night sky.
///
/// # Errors
/// Files and the GPU.
pub fn stars(lab: &Lab, options: &Options) -> Result<()> {
    let names = scenes::STARS.iter().map(|s| s.name);
    let mut journal = open(lab, options, Effect::Stars.name(), [&["flux"], &["units"]], names)?;
    measure(&mut journal, Effect::Stars, |c| {
        let Method::Library(LibraryMethod::Stars(method)) = c.method else {
            return Err(Error::range("candidate", "one of the stars", c.name));
        };
        let (mut pictures, mut flux) = (Vec::new(), 0.0f64);
        for scene in &scenes::STARS {
            let mut host = stars::Host::new(&lab.device, scene, stars::SIZE)?;
            let ((truth, even), drawn) = (host.truth()?, host.picture(method)?);
            flux = flux.max(stars::flux_error(&drawn, &truth, &even));
            pictures.push([drawn, truth].map(|p| stars::blocks(&p)));
        }
        let pairs: Vec<(Picture, &Picture)> = pictures.iter().map(|[drawn, truth]| (drawn.clone(), truth)).collect();
        let (error, each) = luminance_over_scenes(&pairs)?;
        let mut timed = stars::Host::new(&lab.device, &scenes::STARS[0], (640, 360))?;
        let cost = interleaved(&lab.baseline, lab.rounds, |i| timed.timed(method, i == 0))?;
        Ok(Measured { cost, error, more: vec![format!("{flux:.6e}")], each, units: vec![frame_units(c)] })
    })?;
    let titles = Titles {
        title: "Stars: what a frame costs against how far its light is from the truth",
        x: "cost of a picture of nothing but a clear night sky, 640x360, over the baseline's",
        y: "95th percentile of the relative error of blocks' mean luminance",
        note: "moonless, moonlit, dusk; line: nothing is both cheaper and better; ring: the default",
    };
    end(journal, &titles, &options.out.join("stars")).map(|_| ())
}

/// Charts the ways to draw clouds.
///
/// # Errors
/// Files and the GPU.
pub fn clouds(lab: &Lab, options: &Options) -> Result<()> {
    let names = scenes::CLOUDS.iter().map(|s| s.name);
    let mut journal = open(lab, options, Effect::Clouds.name(), [&[], &["units"]], names)?;
    let host = |scene, size| cloudscapes::Host::new(&lab.device, scene, size);
    let mut hosts = scenes::CLOUDS.iter().map(|s| host(s, cloudscapes::SIZE)).collect::<Result<Vec<_>>>()?;
    let truths = hosts.iter_mut().map(cloudscapes::Host::truth).collect::<Result<Vec<_>>>()?;
    let mut timed = host(&scenes::CLOUDS[0], (640, 360))?;
    measure(&mut journal, Effect::Clouds, |c| {
        let Method::Library(LibraryMethod::Clouds(method)) = c.method else {
            return Err(Error::range("candidate", "one of the clouds", c.name));
        };
        let drawn = hosts.iter_mut().map(|h| h.picture(&method)).collect::<Result<Vec<_>>>()?;
        let (error, each) = luminance_over_scenes(&drawn.into_iter().zip(&truths).collect::<Vec<_>>())?;
        let cost = interleaved(&lab.baseline, lab.rounds, |i| timed.timed(&method, i == 0))?;
        Ok(Measured { cost, error, more: Vec::new(), each, units: vec![frame_units(c)] })
    })?;
    let titles = Titles {
        title: "Clouds: what a frame costs against how far it is from a march of every pixel",
        x: "cost of a picture of fair cumulus, the camera turning, 640x360, over the baseline's",
        y: "95th percentile of the relative error in luminance",
        note: "six skies from below, above and inside; line: nothing is both cheaper and better; ring: the default",
    };
    end(journal, &titles, &options.out.join("clouds")).map(|_| ())
}

/// Prints how well the work units predict the times: the factor between both for each candidate.
fn calibrate(table: &Table) {
    let find = |name: &str| candidates(Effect::Sky).into_iter().find(|c| c.name == name);
    let pixels = u64::from(FRAME.0 * FRAME.1);
    let mut data = Vec::new();
    for r in &table.rows {
        let Some(c) = find(&r[0]) else { continue };
        // Uses ratios to the baseline, which other load on the machine affects less than times.
        let moving = c.work.frame(pixels, true).plus(c.work.rebuild, 1.0 / FRAMES_AN_AIR);
        for (column, work) in [("cost", moving), ("still", c.work.frame(pixels, false))] {
            if let Some(v) = table.number(r, column) {
                data.push((format!("{} {column}", r[0]), v, work));
            }
        }
    }
    let fit = |price: &Price| {
        let logs: Vec<f64> = data.iter().map(|d| (d.1 / d.2.at(price)).ln()).collect();
        let mean = logs.iter().sum::<f64>() / logs.len().max(1) as f64;
        (logs.iter().map(|l| (l - mean).powi(2)).sum::<f64>() / logs.len().max(1) as f64, mean)
    };
    let grid = |lo: f64, n: i32| (0..n).map(move |i| lo * 1.3f64.powi(i));
    let prices = grid(0.02, 24).flat_map(|texel| grid(0.002, 24).map(move |byte| Price { texel, byte }));
    let best = prices.min_by(|a, b| fit(a).0.total_cmp(&fit(b).0)).unwrap_or_default();
    let (variance, mean) = fit(&best);
    println!(
        "  work units: a look-up {} samples, a byte {}; {} baselines a million samples; costs follow within a factor {} (1 sigma)",
        short(best.texel),
        short(best.byte),
        short(mean.exp() * 1e6),
        short(variance.sqrt().exp())
    );
    for d in &data {
        let factor = d.1 / (d.2.at(&best) * mean.exp());
        if !(0.5..2.0).contains(&factor) {
            println!("    {}: {} of what its units say", d.0, short(factor));
        }
    }
}
