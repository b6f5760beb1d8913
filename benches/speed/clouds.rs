//! What clouds cost a frame on a software driver, in copies (see [`crate::copies`]) and of a clear sky's frame: the eye looks 15 degrees up.

use std::sync::Arc;

use welkin::{
    clouds::CloudModel,
    context::Context,
    frame::{FrameFlags, Shared},
    gpu::Device,
    weather::{CloudKind, CloudLayer, Weather},
};

use crate::copies::{Scene, measured, median, world};

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

fn scenes(device: &Arc<Device>) -> Fallible<Vec<Scene>> {
    let shared = Arc::new(Shared::new(device)?);
    let broken = [CloudLayer::of(CloudKind::Cumulus, 0.5, 1000.0)];
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
    Ok(vec![
        scene("clear sky", &clear)?,
        scene("closed deck, Deck", &deck)?,
        scene("closed deck, Volume", &closed)?,
        scene("broken cumulus, at rest", &broken)?,
        Scene { turn_rad: TURN_RAD, ..scene("broken cumulus, turning", &broken)? },
        scene("three layers, at rest", &several)?,
        Scene { flags: FrameFlags::NO_HISTORY, ..scene("broken cumulus, every pixel", &broken)? },
    ])
}

/// Prints the cost of each sky.
pub fn run() -> Fallible<()> {
    let mut scenes = measured(PITCH_RAD, scenes)?;
    let clear = median(&mut scenes[0].copies);
    for mut scene in scenes {
        let copies = median(&mut scene.copies);
        println!("  {}: {copies:.1} copies, {:.2} of a clear sky", scene.name, copies / clear);
    }
    Ok(())
}
