//! Finished tables on disk, under a hash of the planet, the settings and the shaders that made them.
//!
//! Off unless the host names a directory. A file that is short, damaged, of another version or of another key is passed
//! over and the tables are built anew; nothing is ever read half.

use std::fs;
use std::path::{Path, PathBuf};

use bytemuck::{bytes_of, cast_slice};

use super::Planet;
use super::recipe::Name;
use super::settings::SkySettings;
use super::spectral::parts;
use super::uniforms::{AirUniform, DimsUniform};
use crate::error::{Error, Result, Status};
use crate::gpu::shader;

/// First bytes of a file; the digits are the version of its layout.
const MAGIC: &[u8; 8] = b"WKSKY\x00\x01\n";

/// FNV-1a, 64 bits: the same on every machine.
fn fnv(mut h: u64, bytes: &[u8]) -> u64 {
    for b in bytes {
        h = (h ^ u64::from(*b)).wrapping_mul(0x0000_0100_0000_01b3);
    }
    h
}

const SEED: u64 = 0xcbf2_9ce4_8422_2325;

/// The key of a planet's tables.
///
/// # Errors
/// A missing shader file.
pub(crate) fn key(planet: &Planet, settings: &SkySettings) -> Result<u64> {
    let h = fnv(SEED, &planet.hash().to_le_bytes());
    let h = fnv(h, settings.model.name().as_bytes());
    let h = fnv(h, &settings.orders.to_le_bytes());
    let h = fnv(h, cast_slice(&AirUniform::of_parts(&parts(planet, settings.wavelengths)?)));
    let h = fnv(h, bytes_of(&DimsUniform::of(settings)));
    Ok(fnv(h, shader::assemble("sky/build.wgsl")?.as_bytes()))
}

/// Where the tables of a key lie.
pub(crate) fn path(directory: &Path, key: u64) -> PathBuf {
    directory.join(format!("sky-{key:016x}.tables"))
}

/// Writes tables (in the order of [`Name::RESULTS`]) so that a reader sees the old file or the whole new one.
///
/// # Errors
/// [`Status::Io`] naming the file.
pub(crate) fn write(directory: &Path, key: u64, tables: &[Vec<u8>]) -> Result<PathBuf> {
    let target = path(directory, key);
    let mut file = MAGIC.to_vec();
    file.extend(key.to_le_bytes());
    for table in tables {
        file.extend((table.len() as u64).to_le_bytes());
        file.extend(table);
    }
    file.extend(fnv(SEED, &file).to_le_bytes());
    // Two processes may write at once: each its own file, and the last name given stands.
    let part = directory.join(format!("sky-{key:016x}.{}.part", std::process::id()));
    let failed = |e: std::io::Error| Error::new(Status::Io, format!("{}: {e}", target.display()));
    fs::create_dir_all(directory).map_err(failed)?;
    let written = fs::write(&part, &file).and_then(|()| fs::rename(&part, &target));
    if written.is_err() {
        let _ = fs::remove_file(&part);
    }
    written.map_err(failed)?;
    let _ = forget_oldest(directory);
    Ok(target)
}

/// Files that are kept in a directory: every weather makes one.
const MOST_FILES: usize = 32;

/// Removes the oldest tables beyond [`MOST_FILES`].
fn forget_oldest(directory: &Path) -> std::io::Result<()> {
    let mut files = Vec::new();
    for entry in fs::read_dir(directory)? {
        let entry = entry?;
        let name = entry.file_name();
        let is_ours = name.to_str().is_some_and(|n| n.starts_with("sky-") && n.ends_with(".tables"));
        if is_ours {
            files.push((entry.metadata()?.modified()?, entry.path()));
        }
    }
    files.sort();
    let excess = files.len().saturating_sub(MOST_FILES);
    files[..excess].iter().try_for_each(|(_, path)| fs::remove_file(path))
}

/// Reads tables of a key; `None` if there is no file.
///
/// # Errors
/// [`Status::Io`] naming the file, if it cannot be read or is not whole.
pub(crate) fn read(directory: &Path, key: u64, settings: &SkySettings) -> Result<Option<Vec<Vec<u8>>>> {
    let path = path(directory, key);
    match fs::read(&path) {
        Ok(file) => match parse(&file, key, settings) {
            Some(tables) => Ok(Some(tables)),
            None => Err(Error::new(Status::Io, format!("{} is damaged", path.display()))),
        },
        Err(e) if e.kind() == std::io::ErrorKind::NotFound => Ok(None),
        Err(e) => Err(Error::new(Status::Io, format!("{}: {e}", path.display()))),
    }
}

fn parse(file: &[u8], key: u64, settings: &SkySettings) -> Option<Vec<Vec<u8>>> {
    let (body, sum) = file.split_last_chunk::<8>()?;
    if u64::from_le_bytes(*sum) != fnv(SEED, body) {
        return None;
    }
    let mut rest = body.strip_prefix(MAGIC)?.strip_prefix(&key.to_le_bytes())?;
    let mut tables = Vec::new();
    for name in Name::RESULTS {
        let (length, tail) = rest.split_first_chunk::<8>()?;
        let (width, height) = name.result_size(settings);
        let expected = u64::from(width) * u64::from(height) * 8;
        if u64::from_le_bytes(*length) != expected || (tail.len() as u64) < expected {
            return None;
        }
        let (table, tail) = tail.split_at(expected as usize);
        tables.push(table.to_vec());
        rest = tail;
    }
    rest.is_empty().then_some(tables)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_files_come_back_and_damaged_ones_do_not() {
        let directory = std::env::temp_dir().join(format!("welkin-sky-cache-{}", std::process::id()));
        let settings = SkySettings::default();
        let key = key(&Planet::earth(), &settings).unwrap();
        let tables: Vec<Vec<u8>> = Name::RESULTS
            .iter()
            .enumerate()
            .map(|(i, n)| vec![i as u8 + 1; (n.result_size(&settings).0 * n.result_size(&settings).1 * 8) as usize])
            .collect();
        assert!(read(&directory, key, &settings).unwrap().is_none());
        let file = write(&directory, key, &tables).unwrap();
        assert_eq!(read(&directory, key, &settings).unwrap().unwrap(), tables);
        assert!(read(&directory, key, &SkySettings { suns: 32, ..settings }).is_err());
        let whole = fs::read(&file).unwrap();
        for damage in [0, 9, whole.len() / 2, whole.len() - 1] {
            let mut bad = whole.clone();
            bad[damage] ^= 1;
            fs::write(&file, &bad).unwrap();
            assert!(read(&directory, key, &settings).unwrap_err().message.contains("damaged"), "{damage}");
        }
        fs::write(&file, &whole[..whole.len() - 3]).unwrap();
        assert!(read(&directory, key, &settings).is_err());
        fs::write(&file, b"").unwrap();
        assert!(read(&directory, key, &settings).is_err());
        fs::remove_dir_all(&directory).unwrap();
    }

    #[test]
    fn the_oldest_files_go_and_others_stay() {
        let directory = std::env::temp_dir().join(format!("welkin-sky-cache-many-{}", std::process::id()));
        fs::create_dir_all(&directory).unwrap();
        fs::write(directory.join("notes.txt"), b"the user's own").unwrap();
        let first = write(&directory, 0, &[]).unwrap();
        let old = std::time::SystemTime::now() - std::time::Duration::from_secs(60);
        fs::File::options().append(true).open(&first).unwrap().set_modified(old).unwrap();
        for key in 1..=MOST_FILES as u64 {
            write(&directory, key, &[]).unwrap();
        }
        assert!(!first.exists() && directory.join("notes.txt").exists());
        assert_eq!(fs::read_dir(&directory).unwrap().count(), MOST_FILES + 1);
        fs::remove_dir_all(&directory).unwrap();
    }

    #[test]
    fn keys_differ_by_planet_and_settings() {
        let (earth, settings) = (Planet::earth(), SkySettings::default());
        let own = key(&earth, &settings).unwrap();
        assert_ne!(own, key(&earth.with_air_scaled(1.001), &settings).unwrap());
        assert_ne!(own, key(&earth, &SkySettings { orders: 6, ..settings }).unwrap());
        assert_ne!(own, key(&earth, &SkySettings { wavelengths: 9, ..settings }).unwrap());
    }
}
