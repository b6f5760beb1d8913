//! Draws every kind of cloud from a typical viewpoint, for visual inspection.

use std::{path::Path, sync::Arc};

use welkin::{
    Error, Result, Status,
    clouds::CloudSettings,
    gpu::{Device, DeviceOptions},
    weather::CloudKind,
};

use crate::{cloudscapes::Host, scenes::CloudScene};

const SIZE: (u32, u32) = (480, 270);

const fn scene(name: &'static str, kind: CloudKind, at: [f64; 5]) -> CloudScene {
    let [cover, base_m, height_m, pitch_deg, sun_deg] = at;
    CloudScene { name, kind, cover, base_m, height_m, pitch_deg, sun_deg }
}

/// Cover, base, height and pitch of the camera, and the sun's elevation.
const GENERA: [CloudScene; 18] = [
    scene("cumulus", CloudKind::Cumulus, [0.4, 1000.0, 2.0, 18.0, 45.0]),
    scene("cumulus-far", CloudKind::Cumulus, [0.3, 1000.0, 2.0, 4.0, 35.0]),
    scene("cumulus-above", CloudKind::Cumulus, [0.4, 1000.0, 3000.0, -12.0, 35.0]),
    scene("towering", CloudKind::ToweringCumulus, [0.25, 1000.0, 2.0, 12.0, 35.0]),
    scene("towering-level", CloudKind::ToweringCumulus, [0.25, 1000.0, 2500.0, 0.0, 30.0]),
    scene("cumulonimbus", CloudKind::Cumulonimbus, [0.2, 1000.0, 2.0, 14.0, 30.0]),
    scene("cumulonimbus-few", CloudKind::Cumulonimbus, [0.06, 1000.0, 2.0, 14.0, 30.0]),
    scene("cumulonimbus-level", CloudKind::Cumulonimbus, [0.1, 1000.0, 5000.0, 2.0, 30.0]),
    scene("cirrus", CloudKind::Cirrus, [0.4, 9000.0, 2.0, 35.0, 35.0]),
    scene("cirrus-low", CloudKind::Cirrus, [0.3, 9000.0, 2.0, 15.0, 35.0]),
    scene("cirrocumulus", CloudKind::Cirrocumulus, [0.5, 7500.0, 2.0, 40.0, 35.0]),
    scene("cirrostratus", CloudKind::Cirrostratus, [0.9, 8000.0, 2.0, 30.0, 35.0]),
    scene("altocumulus", CloudKind::Altocumulus, [0.6, 4000.0, 2.0, 35.0, 40.0]),
    scene("altostratus", CloudKind::Altostratus, [0.9, 4000.0, 2.0, 30.0, 40.0]),
    scene("stratocumulus", CloudKind::Stratocumulus, [0.75, 900.0, 2.0, 20.0, 40.0]),
    scene("stratocumulus-above", CloudKind::Stratocumulus, [0.9, 900.0, 3000.0, -12.0, 20.0]),
    scene("stratus", CloudKind::Stratus, [0.75, 300.0, 2.0, 20.0, 40.0]),
    scene("nimbostratus", CloudKind::Nimbostratus, [0.9, 600.0, 6000.0, -10.0, 30.0]),
];

/// Draws the kinds whose names contain `part` into a folder.
///
/// # Errors
/// Files; the GPU.
pub fn draw(dir: &Path, part: Option<&str>) -> Result<()> {
    let fault = |e: &dyn std::fmt::Display| Error::new(Status::Io, format!("{}: {e}", dir.display()));
    std::fs::create_dir_all(dir).map_err(|e| fault(&e))?;
    let device: Arc<Device> = Device::headless(&DeviceOptions::default())?;
    for scene in GENERA.iter().filter(|s| part.is_none_or(|part| s.name.contains(part))) {
        let picture = Host::new(&device, scene, SIZE)?.whole(CloudSettings::default())?;
        let path = dir.join(format!("{}.png", scene.name));
        let image = picture.display(picture.white());
        welkin_command_line::write_png(&path, &image, image.dimensions().into())?;
        println!("{}", path.display());
    }
    Ok(())
}
