//! `lab compare A B`: the pictures of two candidates side by side, their difference amplified, and the figures below.

use image::RgbImage;
use welkin::candidates::Method as LibraryMethod;
use welkin::plan::{Difference, difference::percentile};
use welkin::{Error, Result};

use crate::candidates::{Candidate, Effect, Method, candidates};
use crate::canvas::{Anchor, Canvas, INK};
use crate::chart::Lab;
use crate::command::Options;
use crate::picture::{Figures, Picture};
use crate::plot::short;
use crate::{cloudscapes, fog, rain, scenes, sky, snow, stars};

/// Size of a picture of sky or fog.
const SIZE: (u32, u32) = (128, 72);
/// Width of a picture in the figure.
const WIDTH: f64 = 384.0;

/// A picture as displayed, with its caption.
struct Panel {
    title: String,
    image: RgbImage,
    text: String,
}

/// Draws both candidates and writes `compare-A-B-SCENE`.
///
/// # Errors
/// Candidates of different effects, an unknown scene, files, the GPU.
pub fn run(a: &Candidate, b: &Candidate, options: &Options) -> Result<()> {
    if a.effect != b.effect {
        let known: Vec<&str> = candidates(a.effect).iter().map(|c| c.name).collect();
        return Err(Error::range("B", &format!("of the same effect as A, one of {}", known.join(", ")), b.name));
    }
    let wanted = options.scene.as_deref().unwrap_or(match a.effect {
        Effect::Sky => "low-sun",
        Effect::Fog => "fog",
        Effect::Rain => "shower",
        Effect::Stars => "moonless",
        Effect::Snow => "quiet",
        Effect::Clouds => "fair-cumulus",
    });
    let scene = scenes::find(a.effect, wanted)?;
    let lab = Lab::open(options)?;
    let panels = match a.effect {
        Effect::Sky => by_pixels([a.name, b.name], &sky_pictures(&lab, [a, b], scene, options.quick)?)?,
        Effect::Fog => by_pixels([a.name, b.name], &fog_pictures(&lab, [a, b], scene)?)?,
        Effect::Rain | Effect::Snow => by_blocks(&lab, [a, b], scene)?,
        Effect::Stars => by_pixels([a.name, b.name], &star_pictures(&lab, [a, b], scene)?)?,
        Effect::Clouds => by_pixels([a.name, b.name], &cloud_pictures(&lab, [a, b], scene)?)?,
    };
    std::fs::create_dir_all(&options.out).map_err(|e| crate::store::io(&options.out, &e))?;
    let stem = options.out.join(format!("compare-{}-{}-{wanted}", a.name, b.name));
    draw(&format!("{} and {}, scene {wanted}", a.name, b.name), &panels).save(&stem)?;
    panels[..2].iter().for_each(|p| println!("  {}: {}", p.title, p.text));
    println!("{}.png", stem.display());
    Ok(())
}

/// The pictures of A, of B and of the truth.
fn sky_pictures(lab: &Lab, pair: [&Candidate; 2], scene: usize, quick: bool) -> Result<[Picture; 3]> {
    let scene = scenes::SKY[scene];
    let truth = sky::truth(&[scene], scene.air, SIZE, quick)?.remove(0);
    let pixels = sky::pixels(&scene, SIZE);
    let one = |c: &Candidate| -> Result<Picture> {
        let mut drawn = sky::make(&lab.device, c)?;
        drawn.rebuild(&scene.air.planet())?;
        Ok(sky::compose(&scene, &pixels, &drawn.veils(&scene, &pixels)?, truth.ground, SIZE))
    };
    Ok([one(pair[0])?, one(pair[1])?, truth.picture])
}

fn fog_pictures(lab: &Lab, pair: [&Candidate; 2], scene: usize) -> Result<[Picture; 3]> {
    let scene = scenes::fog()[scene];
    let bench = fog::Bench::new(&lab.device)?;
    let host = fog::host(&scene, SIZE)?;
    let one = |c: &Candidate| bench.make(c, &scene, &host)?.picture();
    Ok([one(pair[0])?, one(pair[1])?, fog::truth(&scene, &host)?])
}

fn cloud_pictures(lab: &Lab, pair: [&Candidate; 2], scene: usize) -> Result<[Picture; 3]> {
    let mut host = cloudscapes::Host::new(&lab.device, &scenes::CLOUDS[scene], cloudscapes::SIZE)?;
    let mut one = |c: &Candidate| match c.method {
        Method::Library(LibraryMethod::Clouds(method)) => host.picture(&method),
        _ => Err(Error::range("candidate", "one of the clouds", c.name)),
    };
    let [a, b] = [one(pair[0])?, one(pair[1])?];
    Ok([a, b, host.truth()?])
}

fn star_pictures(lab: &Lab, pair: [&Candidate; 2], scene: usize) -> Result<[Picture; 3]> {
    let mut host = stars::Host::new(&lab.device, &scenes::STARS[scene], stars::SIZE)?;
    let mut one = |c: &Candidate| match c.method {
        Method::Library(LibraryMethod::Stars(method)) => host.picture(method),
        _ => Err(Error::range(c.name, "a way to draw stars", c.name)),
    };
    let [a, b] = [one(pair[0])?, one(pair[1])?];
    Ok([a, b, host.truth()?.0])
}

/// Panels for pictures that are compared pixel by pixel.
fn by_pixels(names: [&str; 2], [a, b, truth]: &[Picture; 3]) -> Result<[Panel; 4]> {
    let white = truth.white();
    let between = a.figures(b)?;
    let gain = gain(&between.luminance);
    let difference = Picture { texels: amplified(a, b, gain, white), ..a.clone() };
    let text = |of: &str, figures: &Figures| {
        format!("{}, perceptual {} %", said(of, &figures.luminance), short(100.0 * figures.perceptual))
    };
    let from_truth = |p: &Picture| Ok::<_, Error>(text("from the truth", &p.figures(truth)?));
    Ok([
        Panel { title: format!("A: {}", names[0]), image: a.display(white), text: from_truth(a)? },
        Panel { title: format!("B: {}", names[1]), image: b.display(white), text: from_truth(b)? },
        Panel { title: "truth".into(), image: truth.display(white), text: "the reference in f64".into() },
        Panel { title: of_difference("", gain), image: difference.display(1.0), text: text("between them", &between) },
    ])
}

/// Panels for rain and snow. Different methods put drops in different places, so pictures are compared block by block
/// over several moments, as in their chart. The last moment is shown.
fn by_blocks(lab: &Lab, pair: [&Candidate; 2], scene: usize) -> Result<[Panel; 4]> {
    let snows = pair[0].effect == Effect::Snow;
    let scene = if snows { scenes::snow()[scene] } else { scenes::rain()[scene] };
    let mut host = rain::Host::new(&lab.device, &scene, rain::SIZE)?;
    let (truth, white) = if snows { snow::truth(&mut host, 1)? } else { host.truth(1)? };
    let mut drawn = |c: &Candidate| match c.method {
        Method::Library(LibraryMethod::Snow(settings)) => snow::drawn_by(&mut host, settings),
        _ => host.drawn_by(c),
    };
    let [a, b] = [drawn(pair[0])?, drawn(pair[1])?];
    let figures = |x: &rain::Blocks, y: &rain::Blocks| {
        let mut errors = x.errors(y, white);
        errors.sort_by(f64::total_cmp);
        let at = |share| percentile(&errors, share);
        Difference { median: at(0.5), p95: at(0.95), worst: at(1.0) }
    };
    let picture = |texels: Vec<[f64; 3]>| Picture { width: rain::SIZE.0, height: rain::SIZE.1, texels };
    let shown = |b: &rain::Blocks| picture(b.last.iter().map(|y| [*y; 3]).collect()).display(white);
    let between = figures(&a, &b);
    let gain = gain(&between);
    let difference = picture(a.brighter(&b, white).iter().map(|d| two_colours(gain * d)).collect());
    let one = |which: &str, c: &Candidate, b: &rain::Blocks| Panel {
        title: format!("{which}: {}", c.name),
        image: shown(b),
        text: said("blocks from the truth", &figures(b, &truth)),
    };
    Ok([
        one("A", pair[0], &a),
        one("B", pair[1], &b),
        Panel { title: "truth".into(), image: shown(&truth), text: "all drops up to 14 m, each by itself".into() },
        Panel {
            title: of_difference("means of blocks, ", gain),
            image: difference.display(1.0),
            text: said("blocks between them", &between),
        },
    ])
}

/// Amplification of the difference: its 95th percentile is shown as a third of white.
fn gain(between: &Difference) -> f64 {
    (0.33 / between.p95.max(1e-6)).clamp(1.0, 1e5)
}

fn of_difference(what: &str, gain: f64) -> String {
    format!("A - B, {what}x{}: red where A is brighter, blue where darker", short(gain))
}

fn said(of: &str, e: &Difference) -> String {
    let [p95, median, worst] = [e.p95, e.median, e.worst].map(|v| short(100.0 * v));
    format!("{of}: p95 {p95} %, median {median} %, worst {worst} %")
}

fn draw(heading: &str, panels: &[Panel; 4]) -> Canvas {
    let (columns, rows) = panels[0].image.dimensions();
    let zoom = WIDTH / f64::from(columns);
    let (w, h) = (WIDTH, f64::from(rows) * zoom);
    let mut canvas = Canvas::new((2.0 * w + 60.0) as u32, (2.0 * h + 150.0) as u32);
    canvas.text(heading, (20.0, 20.0), 18.0, INK, Anchor::Left);
    for (i, panel) in panels.iter().enumerate() {
        let (x, y) = (20.0 + (i % 2) as f64 * (w + 20.0), 52.0 + (i / 2) as f64 * (h + 52.0));
        canvas.text(&panel.title, (x, y - 10.0), 13.0, INK, Anchor::Left);
        for (px, py, c) in panel.image.enumerate_pixels() {
            let (left, top) = (x + f64::from(px) * zoom, y + f64::from(py) * zoom);
            canvas.fill([left, top, left + zoom, top + zoom], (c[0], c[1], c[2]));
        }
        canvas.text(&panel.text, (x, y + h + 10.0), 12.0, INK, Anchor::Left);
    }
    canvas
}

/// Amplified relative difference in luminance: red where A is brighter, blue where it is darker.
fn amplified(a: &Picture, b: &Picture, gain: f64, white: f64) -> Vec<[f64; 3]> {
    let y = welkin::light::luminance;
    let one = |(a, b): (&[f64; 3], &[f64; 3])| two_colours(gain * (y(a) - y(b)) / (y(b).max(0.0) + 0.01 * white));
    a.texels.iter().zip(&b.texels).map(one).collect()
}

/// Red above 0, blue below.
fn two_colours(d: f64) -> [f64; 3] {
    [d.max(0.0), 0.25 * d.abs(), (-d).max(0.0)]
}
