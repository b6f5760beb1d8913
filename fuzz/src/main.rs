//! Writes what fuzzing begins with: the repository's own reports, planets, states and plans, and small files of noise, heights and tables.

use std::{fs, io, path::Path};

use welkin::noise::{NoiseImage, NoiseSettings};
use welkin_fuzz::targets;

const PLANET: &str = include_str!("../../examples/data/planet_golden.toml");
const REPORTS: &str = include_str!("../../examples/data/metar.txt");

// Counters of coverage want a fuzzer beside them, and a fuzzer its target.
libfuzzer_sys::fuzz_target!(|_data: &[u8]| {});

fn main() -> io::Result<()> {
    let root = std::env::args().nth(1).ok_or(io::Error::other("usage: seeds DIRECTORY"))?;
    let write = |target: &str, seeds: Vec<Vec<u8>>| {
        let directory = Path::new(&root).join(target);
        fs::create_dir_all(&directory)?;
        seeds.iter().enumerate().try_for_each(|(i, seed)| fs::write(directory.join(format!("seed-{i:03}")), seed))
    };
    let reports = REPORTS.lines().filter(|l| !l.starts_with('#') && !l.is_empty());
    write("metar", reports.map(|l| l.as_bytes().to_vec()).collect())?;
    write("planet", vec![PLANET.as_bytes().to_vec()])?;
    write("state", targets::states())?;
    write("plan", vec![targets::saved_plan()])?;
    write("cache", vec![targets::tables(), targets::tables()[..2000].to_vec()])?;
    let settings = NoiseSettings { frequency: [2; 3], ..Default::default() };
    let images = [[16, 8, 1], [8, 8, 8]].map(|size| NoiseImage::generate(size, &settings).expect("good settings"));
    write("noise", images.iter().flat_map(|i| [i.to_dds(), i.to_ktx2()]).collect())?;
    // A raw file's first byte says its layout: six columns, then the order of targets::raw_layouts.
    let raw = (60..).zip(targets::raw_layouts()).map(|(first, (_, file))| [vec![first], file].concat());
    write("heights", targets::height_files().into_iter().chain(raw).collect())?;
    write(
        "calls",
        (0..40_u8).map(|i| (0..200_u8).map(|k| k.wrapping_mul(7 + 2 * i).wrapping_add(i)).collect()).collect(),
    )
}
