//! What clouds cost a frame on a software driver, in copies (see [`crate::copies`]) and of a clear sky's frame: the eye looks 15 degrees up.

use std::sync::Arc;

use welkin::{
    clouds::{CloudModel, CloudSettings},
    context::Context,
    frame::{Frame, FrameFlags, Shared, Stages},
    gpu::{Device, DeviceOptions, readback},
    light::luminance,
    weather::{CloudKind, CloudLayer, Weather},
};

use crate::copies::{Scene, measured, median, quantile, texture, world};

type Fallible<T> = Result<T, Box<dyn std::error::Error>>;

const PITCH_RAD: f64 = 0.26;
/// Of a camera that turns, rad a frame: 30 degrees a second at 60 Hz.
const TURN_RAD: f64 = 0.0087;

/// A world under these layers.
fn under(
    device: &Arc<Device>,
    shared: &Arc<Shared>,
    layers: &[CloudLayer],
    model: CloudModel,
) -> Fallible<Arc<Context>> {
    let weather = Weather { clouds: layers.to_vec(), ..Weather::default() };
    let mut context = world(device, shared, &weather, -60.0)?;
    Arc::get_mut(&mut context).ok_or("the world is shared already")?.set_cloud_model(model);
    Ok(context)
}

fn cumulus() -> [CloudLayer; 1] {
    [CloudLayer::of(CloudKind::Cumulus, 0.5, 1000.0)]
}

/// Most steps of a ray through a layer at fineness 1 (`shaders/clouds/march.wgsl`).
const STEPS: f64 = 96.0;
/// 95th percentile of the difference of luminance up to which steps need not be doubled.
const SAME: f64 = 0.01;

/// The least fineness of those tried whose picture of broken cumulus, marched in every pixel, is that of twice the steps.
fn brute_force() -> Fallible<f64> {
    let device = Device::headless(&DeviceOptions::default())?;
    let context = under(&device, &Arc::new(Shared::new(&device)?), &cumulus(), CloudModel::Volume)?;
    let mut scene = Scene::new("", &context, PITCH_RAD)?;
    let color = texture(&device, wgpu::TextureFormat::Rgba16Float);
    let mut picture = |fineness: f64| -> Fallible<Vec<f64>> {
        scene.view.set_clouds(CloudSettings { fineness, square_side: 1 })?;
        scene.frame_id += 1;
        let frame = Frame::new(scene.frame_id, scene.camera, &color, None);
        let frame = Frame { flags: FrameFlags::NO_HISTORY, cd_m2_per_unit: 1e3, ..frame };
        scene.view.record(&context, &frame, Stages::BACKGROUND.with(Stages::MEDIUM))?;
        device.wait()?;
        Ok(readback::rgba(&device, &color)?.iter().map(|t| luminance(&[t[0], t[1], t[2]].map(f64::from))).collect())
    };
    let mut fineness = 1.0;
    let mut fewer = picture(fineness)?;
    while fineness < 8.0 {
        let more = picture(2.0 * fineness)?;
        let white = more.iter().sum::<f64>() / more.len() as f64;
        let mut off: Vec<f64> = fewer.iter().zip(&more).map(|(a, b)| (a - b).abs() / (b + 0.01 * white)).collect();
        let off = quantile(&mut off, 0.95);
        println!(
            "broken cumulus, every pixel in at most {} steps: {:.2} % from twice as many",
            STEPS * fineness,
            1e2 * off
        );
        if off <= SAME {
            break;
        }
        (fineness, fewer) = (2.0 * fineness, more);
    }
    Ok(fineness)
}

fn scenes(device: &Arc<Device>, fineness: f64) -> Fallible<Vec<Scene>> {
    let shared = Arc::new(Shared::new(device)?);
    let broken = cumulus();
    let closed = [CloudLayer::of(CloudKind::Stratus, 1.0, 600.0)];
    let several = [
        CloudLayer::of(CloudKind::Cumulus, 0.35, 1000.0),
        CloudLayer::of(CloudKind::Altocumulus, 0.4, 4000.0),
        CloudLayer::of(CloudKind::Cirrus, 0.4, 9000.0),
    ];
    let volume = |layers: &[CloudLayer]| under(device, &shared, layers, CloudModel::Volume);
    let (clear, deck) = (volume(&[])?, under(device, &shared, &closed, CloudModel::Deck)?);
    let (broken, closed, several) = (volume(&broken)?, volume(&closed)?, volume(&several)?);
    let scene = |name, context| Scene::new(name, context, PITCH_RAD);
    let mut brute = scene("broken cumulus, every pixel in these steps", &broken)?;
    brute.flags = FrameFlags::NO_HISTORY;
    brute.view.set_clouds(CloudSettings { fineness, square_side: 1 })?;
    Ok(vec![
        scene("clear sky", &clear)?,
        scene("closed deck, Deck", &deck)?,
        scene("closed deck, Volume", &closed)?,
        scene("broken cumulus, at rest", &broken)?,
        Scene { turn_rad: TURN_RAD, ..scene("broken cumulus, turning", &broken)? },
        scene("three layers, at rest", &several)?,
        Scene { flags: FrameFlags::NO_HISTORY, ..scene("broken cumulus, every pixel", &broken)? },
        brute,
    ])
}

/// Prints the cost of each sky.
pub fn run() -> Fallible<()> {
    let fineness = brute_force()?;
    let mut scenes = measured(PITCH_RAD, |device| scenes(device, fineness))?;
    let clear = median(&mut scenes[0].copies);
    for mut scene in scenes {
        let copies = median(&mut scene.copies);
        println!("  {}: {copies:.1} copies, {:.2} of a clear sky", scene.name, copies / clear);
    }
    Ok(())
}
