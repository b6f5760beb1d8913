//! `lab chart painted-clouds`: cost of painted clouds and error of their brightness and contrast, compared with the
//! library's clouds.

use std::{path::Path, sync::Arc};

use welkin::Result;
use welkin::clouds::{CloudModel, CloudSettings};
use welkin::gpu::{Device, DeviceOptions};

use crate::chart::Lab;
use crate::command::Options;
use crate::effect_charts::{Measured, TRUTH_AGAIN, end, open, over_blocks};
use crate::painted::{Easel, Form, Paint, candidates};
use crate::plot::Titles;
use crate::scenes;
use crate::store::io;
use crate::timing::{Ratio, interleaved};

/// Name of the chart.
const NAME: &str = "painted-clouds";

/// Family of a painting method.
fn family(paint: Paint) -> &'static str {
    match paint {
        Paint::Noise { form: Form::Plane, .. } => "plane",
        Paint::Noise { form: Form::Shell, .. } => "shell",
        Paint::Noise { form: Form::Dome | Form::SolidShell, .. } => "solid noise",
        Paint::Picture => "picture",
        Paint::Library(_) => "Welkin",
        Paint::TruthAgain => "truth",
    }
}

/// Draws a PNG of every method in every scene into a folder, for visual inspection.
///
/// # Errors
/// Files and the GPU.
pub fn draw(folder: &Path, part: Option<&str>) -> Result<()> {
    std::fs::create_dir_all(folder).map_err(|e| io(folder, &e))?;
    let device: Arc<Device> = Device::headless(&DeviceOptions::default())?;
    for scene in &scenes::CLOUDS {
        let mut easel = Easel::new(&device, scene, crate::cloudscapes::SIZE)?;
        let white = easel.pictures(Paint::TruthAgain, 0..1)?[0].white();
        for (name, paint) in candidates() {
            let name = format!("{}-{name}", scene.name);
            if !name.contains(part.unwrap_or_default()) {
                continue;
            }
            let path = folder.join(format!("{name}.png"));
            let image = easel.pictures(paint, 0..1)?[0].display(white);
            welkin_command_line::write_png(&path, &image, image.dimensions().into())?;
            println!("{}", path.display());
        }
    }
    Ok(())
}

/// Draws the chart.
///
/// # Errors
/// Files and the GPU.
pub fn run(lab: &Lab, options: &Options) -> Result<()> {
    let mut journal = open(lab, options, NAME, [&[], &[]], scenes::CLOUDS.iter().map(|s| s.name))?;
    if !candidates().iter().all(|(name, _)| journal.has(name)) {
        let easel = |scene, size| Easel::new(&lab.device, scene, size);
        let mut easels =
            scenes::CLOUDS.iter().map(|s| easel(s, crate::cloudscapes::SIZE)).collect::<Result<Vec<_>>>()?;
        let truths = easels.iter_mut().map(Easel::truth).collect::<Result<Vec<_>>>()?;
        let mut timed = easel(&scenes::CLOUDS[0], (640, 360))?;
        for (name, paint) in candidates() {
            if journal.has(name) {
                continue;
            }
            eprintln!("  {name} ..");
            let blocks = easels.iter_mut().map(|e| e.blocks(paint)).collect::<Result<Vec<_>>>()?;
            let (error, each) = over_blocks(&blocks, &truths, &[true; scenes::CLOUDS.len()]);
            let cost = match name {
                TRUTH_AGAIN => Ratio::default(),
                _ => interleaved(&lab.baseline, lab.rounds, |i| timed.timed(paint, i))?,
            };
            let is_default = matches!(paint, Paint::Library(m) if m.model == CloudModel::default() && m.settings == CloudSettings::default());
            let measured = Measured { cost, error, more: Vec::new(), each, units: Vec::new() };
            journal.push(measured.row(name, family(paint), is_default))?;
        }
    }
    let titles = Titles {
        title: "Painted clouds: what a frame costs against how far its textures are from a march of every pixel",
        x: "cost of a picture of fair cumulus, the camera turning, 640x360, over the baseline's",
        y: "95th percentile of the relative error of blocks: mean, and contrast of two sizes",
        note: "six skies from below, above and inside; line: nothing is both cheaper and better; ring: the default",
    };
    end(journal, &titles, &options.out.join(NAME)).map(|_| ())
}
