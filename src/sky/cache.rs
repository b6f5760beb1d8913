//! Cache of finished tables on disk. The file name contains a hash of the planet, the settings and the shaders that
//! built the tables.
//!
//! The cache is off unless the host names a directory. A file is ignored, and the tables are built again, if its
//! length, checksum, version or key is wrong, if it contains a value that is not finite, or if it is no regular file (a
//! link or a pipe). No file is ever used in part.

use std::fs;
use std::io::{Read, Write};
use std::path::{Path, PathBuf};

use bytemuck::{bytes_of, cast_slice};

use super::Planet;
use super::recipe::Name;
use super::settings::SkySettings;
use super::uniforms::{AirUniform, DimsUniform};
use crate::error::{Error, Result, Status};
use crate::gpu::shader;
use crate::planet::spectral::parts;

/// First bytes of a file; the numbers are the version of its layout.
const MAGIC: &[u8; 8] = b"WKSKY\x00\x01\n";

/// Continues an FNV-1a hash of 64 bits, which is equal on every machine, with `bytes`.
fn fnv(mut h: u64, bytes: &[u8]) -> u64 {
    for b in bytes {
        h = (h ^ u64::from(*b)).wrapping_mul(0x0000_0100_0000_01b3);
    }
    h
}

/// Start value of FNV-1a.
const SEED: u64 = 0xcbf2_9ce4_8422_2325;

/// Key of a planet's tables.
///
/// # Errors
/// Fails if a shader file is missing, or for a number of wavelengths out of range.
pub(crate) fn key(planet: &Planet, settings: &SkySettings) -> Result<u64> {
    let h = fnv(SEED, &planet.hash().to_le_bytes());
    let h = fnv(h, settings.model.name().as_bytes());
    let h = fnv(h, &settings.orders.to_le_bytes());
    let h = fnv(h, cast_slice(&AirUniform::of_parts(&parts(planet, settings.wavelengths)?)));
    let h = fnv(h, bytes_of(&DimsUniform::of(settings)));
    Ok(fnv(h, shader::assemble("sky/build.wgsl")?.as_bytes()))
}

/// Path of the file with the tables of a key.
pub(crate) fn path(directory: &Path, key: u64) -> PathBuf {
    directory.join(format!("sky-{key:016x}.tables"))
}

/// Whether all texels, which are half floats, are finite.
fn are_finite(table: &[u8]) -> bool {
    // Exponent bits, all of which are set in infinity and NaN.
    const ENDLESS: u16 = 0x7c00;
    table.as_chunks::<2>().0.iter().all(|half| u16::from_ne_bytes(*half) & ENDLESS != ENDLESS)
}

/// Size of a file of tables, bytes.
fn file_size(settings: &SkySettings) -> u64 {
    let table = |name: &Name| {
        let (width, height) = name.result_size(settings);
        8 + u64::from(width) * u64::from(height) * 8
    };
    Name::RESULTS.iter().map(table).sum::<u64>() + (MAGIC.len() + 8 + 8) as u64
}

/// Writes tables in the order of [`Name::RESULTS`], and returns the path of the file. The write is atomic: a reader
/// sees the old file or the complete new one. Afterwards the oldest files beyond [`MOST_FILES`] are removed.
///
/// # Errors
/// [`Status::Io`] naming the file, also for tables with values that are not finite.
pub(crate) fn write(directory: &Path, key: u64, tables: &[Vec<u8>]) -> Result<PathBuf> {
    let target = path(directory, key);
    if !tables.iter().all(|table| are_finite(table)) {
        return Err(Error::new(Status::Io, format!("{}: the tables hold what is no number", target.display())));
    }
    let mut file = MAGIC.to_vec();
    file.extend(key.to_le_bytes());
    for table in tables {
        file.extend((table.len() as u64).to_le_bytes());
        file.extend(table);
    }
    file.extend(fnv(SEED, &file).to_le_bytes());
    // Two processes may write at once. Each writes its own file, and the last rename wins.
    let part = directory.join(format!("sky-{key:016x}.{}.part", std::process::id()));
    let failed = |e: std::io::Error| Error::new(Status::Io, format!("{}: {e}", target.display()));
    fs::create_dir_all(directory).map_err(failed)?;
    // A file of this name is left over, or is a link to somewhere else. It is removed instead of written to.
    let _ = fs::remove_file(&part);
    let made = fs::File::options().write(true).create_new(true).open(&part);
    let written = made.and_then(|mut to| to.write_all(&file)).and_then(|()| fs::rename(&part, &target));
    if written.is_err() {
        let _ = fs::remove_file(&part);
    }
    written.map_err(failed)?;
    let _ = forget_oldest(directory);
    Ok(target)
}

/// Largest number of files kept in a directory. Each planet whose tables are kept makes one for each of its settings.
const MOST_FILES: usize = 32;

/// Removes the oldest tables beyond [`MOST_FILES`].
fn forget_oldest(directory: &Path) -> std::io::Result<()> {
    let mut files = Vec::new();
    for entry in fs::read_dir(directory)? {
        let entry = entry?;
        let name = entry.file_name();
        let is_ours = name.to_str().is_some_and(|n| n.starts_with("sky-") && n.ends_with(".tables"));
        let about = entry.metadata()?;
        if is_ours && !about.is_dir() {
            files.push((about.modified()?, entry.path()));
        }
    }
    files.sort();
    let excess = files.len().saturating_sub(MOST_FILES);
    files[..excess].iter().try_for_each(|(_, path)| fs::remove_file(path))
}

/// Reads the tables of a key; `None` if there is no file.
///
/// # Errors
/// [`Status::Io`] naming the file, if it cannot be read, is no regular file, or is damaged.
pub(crate) fn read(directory: &Path, key: u64, settings: &SkySettings) -> Result<Option<Vec<Vec<u8>>>> {
    let path = path(directory, key);
    let failed = |e: std::io::Error| Error::new(Status::Io, format!("{}: {e}", path.display()));
    let unfit = |what: &str| Error::new(Status::Io, format!("{} {what}", path.display()));
    // Checked before the file is opened: reading a pipe might never end, and a link could lead anywhere.
    let about = match fs::symlink_metadata(&path) {
        Err(e) if e.kind() == std::io::ErrorKind::NotFound => return Ok(None),
        about => about.map_err(failed)?,
    };
    if !about.is_file() {
        return Err(unfit("is a link or no file"));
    }
    let size = file_size(settings);
    if about.len() != size {
        return Err(unfit(&format!("is damaged: {} bytes in place of {size}", about.len())));
    }
    let mut file = Vec::with_capacity(size as usize + 1);
    fs::File::open(&path).and_then(|from| from.take(size + 1).read_to_end(&mut file)).map_err(failed)?;
    match parse(&file, key, settings) {
        Some(tables) if tables.iter().all(|table| are_finite(table)) => Ok(Some(tables)),
        Some(_) => Err(unfit("is damaged: it holds what is no number")),
        None => Err(unfit("is damaged")),
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

/// Settings of small tables, for fuzzers.
fn small() -> SkySettings {
    SkySettings {
        suns: 16,
        altitudes: 8,
        zeniths: 4,
        azimuths: 3,
        sky_azimuths: 8,
        sky_above: 8,
        sky_below: 8,
        ..SkySettings::default()
    }
}

/// Tables of zeros in the form that they have in a file between key and checksum, for fuzzers.
pub fn body_of_tables() -> Vec<u8> {
    let table = |name: &Name| {
        let (width, height) = name.result_size(&small());
        let size = u64::from(width) * u64::from(height) * 8;
        [size.to_le_bytes().to_vec(), vec![0; size as usize]].concat()
    };
    Name::RESULTS.iter().flat_map(table).collect()
}

/// Whether a file with this body is accepted, for fuzzers. The file gets a correct key and checksum, which fuzzers
/// could not find.
pub fn takes_tables(body: &[u8]) -> bool {
    let mut file = [MAGIC, 0_u64.to_le_bytes().as_slice(), body].concat();
    file.extend(fnv(SEED, &file).to_le_bytes());
    parse(&file, 0, &small()).is_some_and(|tables| tables.iter().all(|table| are_finite(table)))
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
            assert!(read(&directory, key, &settings).unwrap_err().to_string().contains("damaged"), "{damage}");
        }
        fs::write(&file, &whole[..whole.len() - 3]).unwrap();
        assert!(read(&directory, key, &settings).is_err());
        fs::write(&file, b"").unwrap();
        assert!(read(&directory, key, &settings).is_err());
        fs::remove_dir_all(&directory).unwrap();
    }

    #[test]
    fn foreign_huge_and_endless_files_links_and_texels_that_are_no_numbers_are_refused() {
        let directory = std::env::temp_dir().join(format!("welkin-sky-cache-odd-{}", std::process::id()));
        let settings = SkySettings::default();
        let size = |n: &Name| (n.result_size(&settings).0 * n.result_size(&settings).1 * 8) as usize;
        let tables: Vec<Vec<u8>> = Name::RESULTS.iter().map(|n| vec![0x11; size(n)]).collect();
        let refused = |key: u64, why: &str| {
            let e = read(&directory, key, &settings).unwrap_err();
            assert!(e.status == Status::Io && e.to_string().contains(why), "{why}: {}", e);
        };
        let file = write(&directory, 1, &tables).unwrap();
        assert!(read(&directory, 1, &settings).unwrap().is_some());
        // A file of another key under this name.
        fs::copy(&file, path(&directory, 2)).unwrap();
        refused(2, "damaged");
        // NaN and infinity, with a checksum that matches.
        for (bits, at) in [(0x7e00_u16, 0), (0x7c00, 5000), (0xfc00, 77), (0xffff, 1)] {
            let mut odd = tables.clone();
            odd[1][2 * at..2 * at + 2].copy_from_slice(&bits.to_ne_bytes());
            assert!(write(&directory, 3, &odd).unwrap_err().to_string().contains("no number"));
            let mut whole = fs::read(&file).unwrap();
            let second = MAGIC.len() + 8 + 8 + tables[0].len() + 8 + 2 * at;
            whole[second..second + 2].copy_from_slice(&bits.to_ne_bytes());
            let end = whole.len() - 8;
            let sum = fnv(SEED, &whole[..end]);
            whole[end..].copy_from_slice(&sum.to_le_bytes());
            fs::write(&file, &whole).unwrap();
            refused(1, "no number");
            write(&directory, 1, &tables).unwrap();
        }
        // A file of a terabyte, which must not be read into memory, and a directory. The file is closed at once,
        // because Windows does not remove a folder that contains an open file. A file system without sparse files would
        // write a whole terabyte; there a smaller file is used instead.
        let huge = fs::File::create(path(&directory, 4)).unwrap();
        if cfg!(windows) || huge.set_len(1 << 40).is_err() {
            huge.set_len(1 << 28).unwrap();
        }
        drop(huge);
        refused(4, "in place of");
        fs::create_dir(path(&directory, 5)).unwrap();
        refused(5, "no file");
        #[cfg(unix)]
        {
            use std::os::unix::fs::symlink;
            symlink(&file, path(&directory, 6)).unwrap();
            refused(6, "link");
            symlink("/dev/zero", path(&directory, 7)).unwrap();
            refused(7, "link");
            // The target of a link is not written to.
            let precious = directory.join("precious");
            fs::write(&precious, b"the user's own").unwrap();
            symlink(&precious, path(&directory, 8)).unwrap();
            symlink(&precious, directory.join(format!("sky-{:016x}.{}.part", 8, std::process::id()))).unwrap();
            write(&directory, 8, &tables).unwrap();
            assert!(read(&directory, 8, &settings).unwrap().is_some());
            assert_eq!(fs::read(&precious).unwrap(), b"the user's own");
        }
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
