//! Finished tables on disk, under a hash of the planet, the settings and the shaders that made them.
//!
//! Off unless the host names a directory. A file that is short, damaged, of another version or of another key is passed
//! over and the tables are built anew; nothing is ever read half.

use std::fs;
use std::path::{Path, PathBuf};

use bytemuck::bytes_of;

use super::Planet;
use super::recipe::Name;
use super::settings::SkySettings;
use super::uniforms::DimsUniform;
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
    Ok(target)
}

/// Reads tables of a key; `None` if there is no file or it is not whole.
pub(crate) fn read(directory: &Path, key: u64, settings: &SkySettings) -> Option<Vec<Vec<u8>>> {
    let file = fs::read(path(directory, key)).ok()?;
    let (body, sum) = file.split_last_chunk::<8>()?;
    if u64::from_le_bytes(*sum) != fnv(SEED, body) {
        return None;
    }
    let mut rest = body.strip_prefix(MAGIC)?.strip_prefix(&key.to_le_bytes())?;
    let mut tables = Vec::new();
    for name in Name::RESULTS {
        let (length, tail) = rest.split_first_chunk::<8>()?;
        let (width, height) = name.size(settings);
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
            .map(|(i, n)| vec![i as u8 + 1; (n.size(&settings).0 * n.size(&settings).1 * 8) as usize])
            .collect();
        assert!(read(&directory, key, &settings).is_none());
        let file = write(&directory, key, &tables).unwrap();
        assert_eq!(read(&directory, key, &settings).unwrap(), tables);
        assert!(read(&directory, key, &SkySettings { suns: 32, ..settings }).is_none());
        let whole = fs::read(&file).unwrap();
        for damage in [0, 9, whole.len() / 2, whole.len() - 1] {
            let mut bad = whole.clone();
            bad[damage] ^= 1;
            fs::write(&file, &bad).unwrap();
            assert!(read(&directory, key, &settings).is_none(), "{damage}");
        }
        fs::write(&file, &whole[..whole.len() - 3]).unwrap();
        assert!(read(&directory, key, &settings).is_none());
        fs::write(&file, b"").unwrap();
        assert!(read(&directory, key, &settings).is_none());
        fs::remove_dir_all(&directory).unwrap();
    }

    #[test]
    fn keys_differ_by_planet_and_settings() {
        let (earth, settings) = (Planet::earth(), SkySettings::default());
        let own = key(&earth, &settings).unwrap();
        assert_ne!(own, key(&earth.with_air_scaled(1.001), &settings).unwrap());
        assert_ne!(own, key(&earth, &SkySettings { orders: 6, ..settings }).unwrap());
    }
}
