//! Pictures of many scenes, kept to check that a change of the code leaves them all unchanged.
//!
//! `lab scenes DIR` draws every scene of [`list`] through the public API and writes a PNG for each. `lab scenes OLD
//! NEW` compares two such folders. Both folders must come from the same machine and driver, because drivers round
//! differently. No plan uses measured times here, so two runs give the same bytes.

mod host;
mod list;
mod scene;
mod world;

use std::{collections::BTreeSet, path::Path, time::Instant};

use image::RgbImage;
use welkin::{Error, Result, Status};

use host::Devices;

fn fault(what: &Path, e: impl std::fmt::Display) -> Error {
    Error::new(Status::Io, format!("{}: {e}", what.display()))
}

/// Draws every scene whose name contains `part` and writes it to `dir`.
///
/// # Errors
/// No scene with that name; files; the GPU.
pub fn draw(dir: &Path, part: Option<&str>) -> Result<()> {
    std::fs::create_dir_all(dir).map_err(|e| fault(dir, e))?;
    let mut devices = Devices::default();
    let scenes = list::scenes()?;
    let mut drawn = 0;
    for scene in scenes.iter().filter(|s| part.is_none_or(|p| s.name.contains(p))) {
        let began = Instant::now();
        let Some(picture) = devices.draw(scene).map_err(|e| Error::new(e.status, format!("{}: {}", scene.name, e)))?
        else {
            eprintln!("{}: left out, this machine has no device for it", scene.name);
            continue;
        };
        let path = dir.join(format!("{}.png", scene.name));
        welkin_command_line::write_png(&path, &picture, picture.dimensions().into())?;
        println!("{} {:.1} s", scene.name, began.elapsed().as_secs_f64());
        drawn += 1;
    }
    println!("{drawn} scenes in {}", dir.display());
    if drawn == 0 { Err(Error::range("--scene", "part of a scene's name", part.unwrap_or_default())) } else { Ok(()) }
}

/// Difference between two pictures of the same size, in 8-bit steps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Apart {
    /// Pixels in which any channel differs.
    any: usize,
    /// Pixels in which any channel differs by more than one step.
    seen: usize,
    largest: u8,
}

fn apart(a: &RgbImage, b: &RgbImage) -> Apart {
    let mut sum = Apart::default();
    for (p, q) in a.pixels().zip(b.pixels()) {
        let most = (0..3).map(|c| p.0[c].abs_diff(q.0[c])).max().unwrap_or_default();
        sum.any += usize::from(most > 0);
        sum.seen += usize::from(most > 1);
        sum.largest = sum.largest.max(most);
    }
    sum
}

fn names(dir: &Path) -> Result<BTreeSet<String>> {
    let entries = std::fs::read_dir(dir).map_err(|e| fault(dir, e))?;
    let names = entries.filter_map(|e| e.ok()?.file_name().into_string().ok());
    Ok(names.filter(|n| n.ends_with(".png")).collect())
}

fn open(path: &Path) -> Result<RgbImage> {
    Ok(image::open(path).map_err(|e| fault(path, e))?.to_rgb8())
}

/// Compares two folders and prints each scene that differs. Returns whether all are equal: present in both folders, of
/// the same size, and with no pixel more than one step apart.
///
/// # Errors
/// Files that cannot be read, folders without pictures.
pub fn compare(old: &Path, new: &Path) -> Result<bool> {
    let (before, after) = (names(old)?, names(new)?);
    let all: BTreeSet<&String> = before.union(&after).collect();
    if all.is_empty() {
        return Err(fault(old, "no pictures here"));
    }
    let (mut differ, mut exact) = (0, 0);
    for name in &all {
        if !(before.contains(*name) && after.contains(*name)) {
            println!("{name}: only in {}", if before.contains(*name) { old } else { new }.display());
            differ += 1;
            continue;
        }
        let (a, b) = (open(&old.join(name))?, open(&new.join(name))?);
        if a.dimensions() != b.dimensions() {
            println!("{name}: {:?} and {:?} pixels", a.dimensions(), b.dimensions());
            differ += 1;
            continue;
        }
        let found = apart(&a, &b);
        differ += usize::from(found.seen > 0);
        exact += usize::from(found.any == 0);
        if found.any > 0 {
            println!(
                "{name}: {} of {} pixels more than one step apart, largest difference {}; {} differ at all",
                found.seen,
                a.width() * a.height(),
                found.largest,
                found.any
            );
        }
    }
    println!("{} scenes: {differ} more than one step apart, {exact} the same to the bit", all.len());
    Ok(differ == 0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_runs_draw_the_same_bytes_and_a_changed_pixel_is_found() {
        let dir = std::env::temp_dir().join(format!("welkin-lab-scenes-{}", std::process::id()));
        let [old, new] = ["old", "new"].map(|n| dir.join(n));
        for to in [&old, &new] {
            draw(to, Some("metar-freezing-rain")).unwrap();
        }
        assert!(compare(&old, &new).unwrap());
        let file = "metar-freezing-rain.png";
        assert_eq!(std::fs::read(old.join(file)).unwrap(), std::fs::read(new.join(file)).unwrap());
        let whole = open(&old.join(file)).unwrap();
        let changed = |by: u8| {
            let mut picture = whole.clone();
            let byte = &mut picture.get_pixel_mut(100, 50).0[1];
            *byte = if *byte > 128 { *byte - by } else { *byte + by };
            picture.save(new.join(file)).unwrap();
            compare(&old, &new).unwrap()
        };
        assert!(changed(1) && !changed(2));
        std::fs::rename(new.join(file), new.join("another.png")).unwrap();
        assert!(!compare(&old, &new).unwrap());
        let e = draw(&new, Some("no such scene")).unwrap_err();
        assert!(e.to_string().contains("--scene"), "{e}");
        std::fs::remove_dir_all(&dir).unwrap();
    }

    #[test]
    fn each_scene_has_a_name_of_its_own() {
        let scenes = list::scenes().unwrap();
        let names: BTreeSet<&str> = scenes.iter().map(|s| s.name.as_str()).collect();
        assert_eq!(names.len(), scenes.len());
    }
}
