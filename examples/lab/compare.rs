//! `lab compare A B`: two candidates' pictures side by side, their difference amplified, the figures under them.

use welkin::plan::{Candidate, Effect, candidates};
use welkin::{Error, Result};

use crate::canvas::{Anchor, Canvas, INK};
use crate::chart::Lab;
use crate::command::Options;
use crate::picture::Picture;
use crate::plot::short;
use crate::{fog, scenes, sky};

/// Size of a picture, and how large a pixel of it is drawn.
const SIZE: (u32, u32) = (128, 72);
const ZOOM: f64 = 3.0;

/// Draws both and writes `compare-A-B-SCENE`.
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
        Effect::Rain => {
            return Err(Error::range("A", "of sky or fog: no two ways to draw rain put drops in one place", a.name));
        }
    });
    let scene = scenes::find(a.effect, wanted)?;
    let lab = Lab::open(options)?;
    let pictures = match a.effect {
        Effect::Sky => sky_pictures(&lab, [a, b], scene, options.quick)?,
        _ => fog_pictures(&lab, [a, b], scene)?,
    };
    std::fs::create_dir_all(&options.out).map_err(|e| crate::store::io(&options.out, &e))?;
    let stem = options.out.join(format!("compare-{}-{}-{wanted}", a.name, b.name));
    draw([a.name, b.name], wanted, &pictures)?.save(&stem)?;
    println!("{}.png", stem.display());
    Ok(())
}

/// A, B and the truth.
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

fn draw(names: [&str; 2], scene: &str, [a, b, truth]: &[Picture; 3]) -> Result<Canvas> {
    let (w, h) = (f64::from(SIZE.0) * ZOOM, f64::from(SIZE.1) * ZOOM);
    let mut canvas = Canvas::new((2.0 * w + 60.0) as u32, (2.0 * h + 150.0) as u32);
    canvas.text(&format!("{} and {}, scene {scene}", names[0], names[1]), (20.0, 20.0), 18.0, INK, Anchor::Left);
    let white = truth.white();
    let between = a.figures(b)?;
    // The 95th percentile of the difference is shown as a third of white.
    let gain = (0.33 / between.luminance.p95.max(1e-6)).clamp(1.0, 1e5);
    let difference = Picture { texels: amplified(a, b, gain, white), ..a.clone() };
    let cells = [
        (format!("A: {}", names[0]), a.display(white), a.figures(truth)?),
        (format!("B: {}", names[1]), b.display(white), b.figures(truth)?),
        ("truth".to_owned(), truth.display(white), truth.figures(truth)?),
        (
            format!("A - B, x{}: red where A is brighter, blue where darker", short(gain)),
            difference.display(1.0),
            between,
        ),
    ];
    for (i, (title, image, figures)) in cells.iter().enumerate() {
        let (x, y) = (20.0 + (i % 2) as f64 * (w + 20.0), 52.0 + (i / 2) as f64 * (h + 52.0));
        canvas.text(title, (x, y - 10.0), 13.0, INK, Anchor::Left);
        for (px, py, c) in image.enumerate_pixels() {
            let (left, top) = (x + f64::from(px) * ZOOM, y + f64::from(py) * ZOOM);
            canvas.fill([left, top, left + ZOOM, top + ZOOM], (c[0], c[1], c[2]));
        }
        let e = figures.luminance;
        let of = if i == 3 { "between them" } else { "from the truth" };
        let text = format!(
            "{of}: p95 {} %, median {} %, worst {} %, perceptual {} %",
            short(100.0 * e.p95),
            short(100.0 * e.median),
            short(100.0 * e.worst),
            short(100.0 * figures.perceptual)
        );
        let text = if i == 2 { "the reference in f64".to_owned() } else { text };
        canvas.text(&text, (x, y + h + 10.0), 12.0, INK, Anchor::Left);
        if i < 2 {
            println!("  {title}: {text}");
        }
    }
    Ok(canvas)
}

/// The relative difference in luminance: red where A is brighter, blue where it is darker.
fn amplified(a: &Picture, b: &Picture, gain: f64, white: f64) -> Vec<[f64; 3]> {
    let y = welkin::sky::spectral::luminance;
    let one = |(a, b): (&[f64; 3], &[f64; 3])| {
        let d = gain * (y(a) - y(b)) / (y(b).max(0.0) + 0.01 * white);
        [d.max(0.0), 0.25 * d.abs(), (-d).max(0.0)]
    };
    a.texels.iter().zip(&b.texels).map(one).collect()
}
