//! The command-line tool must create the same noise as the library.

use std::path::{Path, PathBuf};

use welkin::noise::{CloudPreset, NoiseImage, NoiseKind, NoiseSettings};

fn path(name: &str) -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join(name)
}

/// Runs the tool with the words of a line. Words that begin with a dot are files.
fn run(line: &str) -> welkin::Result<String> {
    let file = |word: &str| path(&format!("noise_tool{word}")).display().to_string();
    let words = line.split_whitespace().map(|w| if w.starts_with('.') { file(w) } else { w.to_string() });
    welkin_noise::run(words)
}

#[test]
fn files_and_previews_hold_the_library_s_noise() {
    let settings = NoiseSettings {
        kind: NoiseKind::Cellular,
        frequency: [4, 2, 2],
        octaves: 2,
        amplitude: 0.6,
        persistence: 0.4,
        seed: 9,
    };
    let expected = NoiseImage::generate([32, 16, 8], &settings).unwrap();
    let line = "--kind cellular --frequency 4,2 --octaves 2 --amplitude 0.6 --persistence 0.4 --seed 9 --size 32x16x8";
    run(&format!(".a.dds .a.ktx2 .a.png --slice 5 --tiles 2 {line}")).unwrap();
    assert_eq!(NoiseImage::load(path("noise_tool.a.dds")).unwrap(), expected);
    assert_eq!(NoiseImage::load(path("noise_tool.a.ktx2")).unwrap(), expected);
    let picture = image::open(path("noise_tool.a.png")).unwrap().to_luma8();
    assert_eq!(picture.dimensions(), (64, 32));
    let slice = expected.preview(5).unwrap();
    for (x, y, pixel) in picture.enumerate_pixels() {
        assert_eq!(pixel.0[0], slice[(y % 16 * 32 + x % 32) as usize], "{x} {y}");
    }
    // Clouds cut out of an existing file.
    let said = run(".clouds.dds --from .a.ktx2 --cover 0.3 --density 0.95").unwrap();
    assert!(said.contains("cover 0.3") || said.contains("cover 0.29"), "{said}");
    let clouds = NoiseImage::load(path("noise_tool.clouds.dds")).unwrap();
    assert!((clouds.cover(0.0) - 0.3).abs() < 0.02, "{}", clouds.cover(0.0));
}

#[test]
fn presets_are_the_library_s() {
    run(".few.ktx2 --seed 4 --preset few --gpu").unwrap();
    let read = NoiseImage::load(path("noise_tool.few.ktx2")).unwrap();
    assert_eq!(read.size(), CloudPreset::SIZE);
    let cover = read.cover(0.0);
    assert!((0.1..0.18).contains(&cover), "{cover}");
}

#[test]
fn wrong_words_are_refused_and_nothing_is_written() {
    for (line, named) in [
        ("", "no file"),
        (".never.dds --octaves", "--octaves has no value"),
        (".never.dds --octaves many", "--octaves cannot be `many`"),
        (".never.dds --octaves 40", "octaves must be in [1, 16]"),
        (".never.dds --size 100x100", "size[0]"),
        (".never.dds --size 8x8x8x8", "--size"),
        (".never.dds --kind wavy", "`wavy`"),
        (".never.dds --preset rainy", "`rainy`"),
        (".never.dds --colour red", "`--colour`"),
        (".never.dds --from .none", "noise_tool.none"),
        (".never.dds .never.tga", "noise_tool.never.tga"),
        (".never.dds .never.png --slice 3", "--slice 3 of 1"),
        (".never.dds --cutoff 2", "cutoff"),
        (".never.dds --cover -1", "cover"),
    ] {
        let e = run(line).expect_err(line).to_string();
        assert!(e.contains(named), "{line}: {e}");
    }
    assert!(!path("noise_tool.never.dds").exists());
}
