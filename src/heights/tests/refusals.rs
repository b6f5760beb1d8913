//! Files and settings that are refused: each message names the place and what is accepted.

use super::{
    super::{HeightScale, NoiseTerrain},
    *,
};
use crate::error::Status;

fn refused(bytes: &[u8], settings: &HeightSettings) -> String {
    let e = HeightMap::from_bytes(bytes, settings).expect_err("it is refused");
    let known = matches!(e.status, Status::Parse | Status::Unsupported | Status::InvalidArgument);
    assert!(known, "{:?}: {e}", e.status);
    e.to_string()
}

#[test]
fn grids_are_refused_by_line_and_column() {
    for (text, says) in [
        ("ncols 2\nnrows 1\ncellsize 1\n1 x2", "line 4, column 3: must be height 2 of 2, got x2"),
        (
            "ncols 2\nnrows 1\ncellsize 1\n1 1e9",
            "line 4, column 3, column 1 of row 0 (from 0), must be a height within",
        ),
        ("ncols 2\nnrows 1\ncellsize 1\n1 2 3", "line 4, column 5: the file must end after 2 x 1 heights"),
        ("ncols 3\nnrows 1\ncellsize 1\n10 20", "line 4, column 6: must be height 3 of 3, got the end of the file"),
        ("ncols 30\nnrows 9\ncellsize 1\n1 2", "line 4, column 1: 30 x 9 heights need at least 539 bytes, 3 are left"),
        ("ncols 2\nncols 2", "line 2, column 1: ncols must be there once, this is another"),
        ("ncols 2\ncellsize 1\n1 2", "line 3, column 1: ncols, nrows and cellsize (or dx and dy) must stand before"),
        ("ncols 2.5\nnrows 1", "line 1, column 7: must be a whole number for ncols, got 2.5"),
        ("ncols -2", "line 1, column 7: must be a whole number for ncols, got -2"),
        ("ncols", "line 1, column 6: must be a whole number for ncols, got the end of the file"),
        ("ncols 2\nnrows 1\ncellsize 0\n1 2", "line 3, column 10: cellsize must be in [0.000000001, 1000000], got 0"),
        (
            "ncols 2\nnrows 1\ncellsize nan\n1 2",
            "line 3, column 10: cellsize must be in [0.000000001, 1000000], got NaN",
        ),
        ("ncols 2\nnrows 1\ndx 1\n1 2", "dy is missing"),
        ("ncols 0\nnrows 1\ncellsize 1\n", "line 1, column 7: ncols must be in [1, 268435456], got 0"),
        (
            "ncols 2\nnrows 1\ncellsize 1\nxllcorner inf\n1 2",
            "line 4, column 11: xllcorner must be in [-1000000000000, 1000000000000], got inf",
        ),
    ] {
        let found = refused(text.as_bytes(), &HeightSettings::default());
        assert!(found.starts_with("ESRI ASCII grid: ") && found.contains(says), "{found}");
    }
}

#[test]
fn terrains_are_refused_by_byte() {
    let head = b"TERRAGENTERRAIN ";
    let terrain = |chunks: &[&[u8]]| [&head[..], &chunks.concat()].concat();
    let (size, heights) = (&b"SIZE\x01\0\0\0"[..], &b"ALTW\x01\0\0\0\0\0\0\0\0\0\0\0"[..]);
    let scale = |metres: f32| [&b"SCAL"[..], &[metres.to_le_bytes(); 3].concat()].concat();
    for (file, says) in [
        (terrain(&[size]), "byte 24: the file ends without a chunk ALTW"),
        (terrain(&[heights, b"EOF "]), "byte 16: ALTW needs a chunk SIZE, or XPTS and YPTS"),
        (terrain(&[size, &heights[..14]]), "byte 24, chunk ALTW: needs 40 bytes, the file has 38"),
        (terrain(&[size, heights, b"EOF ", b"SIZE"]), "byte 44: EOF must be the last chunk, 4 bytes follow it"),
        (terrain(&[size, size, heights]), "byte 24: a terrain has one chunk SIZE, this is another"),
        (terrain(&[size, heights, heights]), "byte 40: a terrain has one chunk ALTW, this is another"),
        (
            terrain(&[size, heights, b"ROCK"]),
            "byte 40: a chunk must be SIZE, XPTS, YPTS, SCAL, CRAD, CRVM, ALTW or EOF, got ROCK",
        ),
        (terrain(&[size, heights, b"EO"]), "byte 40, the marker of a chunk: needs 44 bytes, the file has 42"),
        (
            terrain(&[size, heights, &scale(0.0)]),
            "byte 40, chunk SCAL, must have three scales above 0 and up to 1e6 m, got 0",
        ),
        (terrain(&[size, heights, &scale(f32::NAN)]), "up to 1e6 m, got NaN"),
        (terrain(&[b"XPTS\0\0\0\0YPTS\x01\0\0\0ALTW\0\0\0\0"]), "columns must be at least 1, got 0"),
        (
            terrain(&[size, b"ALTW\xff\x7f\xff\x7f\0\0\0\0\0\0\0\0"]),
            "byte 32, column 0 of row 0 (from 0), must be a height",
        ),
    ] {
        let found = refused(&file, &HeightSettings::default());
        assert!(found.starts_with("Terragen terrain: ") && found.contains(says), "{found}");
    }
}

#[test]
fn pictures_are_refused_by_byte_and_chunk() {
    let map = HeightMap::new(3, 2, (0..6).map(|h| h as f32).collect()).unwrap();
    let png = map.to_png(&HeightSettings::default()).unwrap();
    let changed = |at: usize, byte: u8| {
        let mut png = png.clone();
        png[at] = byte;
        png
    };
    let data = png.windows(4).position(|w| w == b"IDAT").unwrap() - 4;
    for (file, says) in [
        (png[..30].to_vec(), "byte 8, IHDR: needs 33 bytes, the file has 30".to_owned()),
        (
            changed(25, 2),
            "byte 24: must be one channel of grey (colour type 0) with 8 or 16 bits, got colour type 2 with".into(),
        ),
        (changed(24, 4), "got colour type 0 with 4 bits".into()),
        (changed(19, 0), "byte 16: columns must be at least 1, got 0".into()),
        (changed(16, 1), "byte 33: needs ".into()),
        (changed(19, 9), "byte 8, chunk IHDR: its checksum must be 0x".into()),
        (changed(data + 14, 0x55), format!("byte {data}, chunk IDAT: its checksum must be 0x")),
        (png[..data + 20].to_vec(), format!("byte {data}, chunk IDAT: needs ")),
        (png[..data].to_vec(), format!("byte {data}: must hold the compressed rows of the picture; ")),
    ] {
        let found = refused(&file, &HeightSettings::default());
        assert!(found.starts_with("PNG: ") && found.contains(&says), "{says}: {found}");
    }
}

#[test]
fn raw_files_are_refused_by_byte() {
    let map = HeightMap::new(2, 2, vec![0.0, 1.0, 2.0, 3.0]).unwrap();
    let settings = raw(&map, RawSample::F32, ByteOrder::Little, RowOrder::NorthFirst);
    let good = map.to_raw(&settings).unwrap();
    let short = refused(&good[..15], &settings);
    assert!(
        short.starts_with("raw heights: byte 15: 2 x 2 numbers of 4 bytes end at byte 16, the file ends at byte 15")
    );
    let long = refused(&[&good[..], &[0; 4]].concat(), &settings);
    assert!(
        long.starts_with("raw heights: byte 16: 2 x 2 numbers of 4 bytes end at byte 16, the file ends at byte 20")
    );
    let mut high = good.clone();
    high[8..12].copy_from_slice(&f32::MIN.to_le_bytes());
    let found = refused(&high, &settings);
    assert!(
        found.starts_with("raw heights: byte 8, column 0 of row 1 (from 0), must be a height within 100000 m"),
        "{found}"
    );
    assert!(found.contains("or the number in settings.no_data, got -3.4028234663852886e38"), "{found}");
    let none = HeightSettings { no_data: Some(f64::from(f32::MIN)), ..settings };
    assert_eq!(HeightMap::from_bytes(&high, &none).unwrap().missing(), 1);
}

#[test]
fn files_of_other_formats_are_named() {
    let none = HeightSettings::default();
    let said = refused(b"II*\0\x08\0\0\0", &none);
    assert!(said.contains("raw numbers with settings.raw; this is a TIFF: convert it by gdal_translate"), "{said}");
    for other in [&b""[..], b"hello", b"NCOL 2", b"\x89PNG", b"TERRAGEN"] {
        assert!(refused(other, &none).contains("byte 0 begins none of these"));
    }
    let e = HeightMap::load("no/such.ter", &none).unwrap_err();
    assert!(e.status == Status::Io && e.to_string().starts_with("no/such.ter: "), "{e}");
    let folder = std::env::temp_dir().join(format!("welkin-heights-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join("broken.asc");
    std::fs::write(&path, "ncols two").unwrap();
    let e = HeightMap::load(&path, &none).unwrap_err();
    std::fs::remove_dir_all(&folder).unwrap();
    assert!(e.to_string().contains("broken.asc: ESRI ASCII grid: line 1, column 7: must be a whole number"), "{e}");
}

#[test]
fn settings_are_refused_by_name() {
    let scale = |step_m, base_m| HeightSettings { scale: HeightScale { step_m, base_m }, ..Default::default() };
    for (settings, says) in [
        (scale(0.0, 0.0), "settings.scale.step_m must be 1e-6 to 10000 m in amount, got 0"),
        (scale(f64::NAN, 0.0), "settings.scale.step_m must be 1e-6 to 10000 m in amount, got NaN"),
        (scale(1.0, 2e6), "settings.scale.base_m must be in [-1000000, 1000000] m, got 2000000"),
    ] {
        assert_eq!(refused(b"", &settings), says);
    }
    let map = HeightMap::new(2, 1, vec![5.0, f32::NAN]).unwrap();
    let mut layout = raw(&map, RawSample::U16, ByteOrder::Big, RowOrder::NorthFirst);
    let said = |e: crate::error::Result<Vec<u8>>| e.unwrap_err().to_string();
    assert_eq!(
        said(map.to_raw(&layout)),
        "settings.no_data must be a whole number in [0, 65535], since heights_m[1] is not known, got none"
    );
    layout.no_data = Some(5.0);
    assert_eq!(said(map.to_raw(&layout)), "settings.no_data must be a number of no height; heights_m[0] has it, got 5");
    layout.scale.base_m = 6.0;
    assert!(said(map.to_raw(&layout)).starts_with("heights_m[0] must be in [6, 65541] m by settings.scale, got 5"));
    layout.raw = Some(RawHeights { rows: 3, ..layout.raw.unwrap() });
    assert!(said(map.to_raw(&layout)).starts_with("settings.raw.columns must be the map's 2 with rows = 1, got 2 x 3"));
    layout.raw = Some(RawHeights { rows: 0, ..layout.raw.unwrap() });
    assert_eq!(said(map.to_raw(&layout)), "settings.raw.rows must be at least 1, got 0");
    layout.raw = None;
    assert_eq!(said(map.to_raw(&layout)), "settings.raw must be set to the layout of the file");
    assert!(said(map.to_ter()).starts_with("heights_m[1] must be known"));
    let flat = HeightMap::new(2, 1, vec![5.0, 4000.0]).unwrap();
    assert!(said(flat.to_ter()).starts_with("cell must be known and the same in both directions"));
    assert!(said(flat.clone().with_cell([1.0, 2.0]).unwrap().to_ter()).contains("got [1.0, 2.0]"));
    assert!(said(flat.clone().with_cell([0.1; 2]).unwrap().to_ter()).starts_with("cell must be at least 0.125 for"));
    assert!(flat.clone().with_cell([0.125; 2]).unwrap().to_ter().is_ok());
    assert!(flat.with_cell([0.0, 1.0]).unwrap_err().to_string().starts_with("cell[0] must be in"));
}

#[test]
fn maps_are_refused_by_name() {
    let said = |e: crate::error::Result<HeightMap>| e.unwrap_err().to_string();
    assert_eq!(said(HeightMap::new(0, 1, vec![])), "columns must be at least 1, got 0");
    assert!(said(HeightMap::new(1 << 20, 1 << 20, vec![])).starts_with("columns must be at most 268435456 together"));
    assert!(said(HeightMap::new(2, 2, vec![0.0; 3])).starts_with("heights_m.len must be 4, one for each of 2 x 2"));
    assert!(said(HeightMap::new(1, 2, vec![0.0, f32::INFINITY])).starts_with("heights_m[1] must be within 100000 m"));
    let map = HeightMap::new(1, 1, vec![0.0]).unwrap();
    assert_eq!(said(map.resampled(0, 3)), "columns must be at least 1, got 0");
    let made = |cell, place, terrain| said(HeightMap::generate(2, 2, cell, [0.0, place], &terrain));
    let terrain = NoiseTerrain::default();
    assert!(made(0.0, 0.0, terrain).starts_with("cell_m must be in [0.01, 10000] m"));
    assert!(made(1.0, f64::NAN, terrain).starts_with("south_west_m[1] must be in"));
    assert!(made(1.0, 0.0, NoiseTerrain { hurst: 1.5, ..terrain }).starts_with("terrain.hurst must be in [0, 1]"));
    assert!(made(1.0, 0.0, NoiseTerrain { wavelength_m: 0.0, ..terrain }).starts_with("terrain.wavelength_m must be"));
    assert!(made(1.0, 0.0, NoiseTerrain { amplitude_m: -1.0, ..terrain }).starts_with("terrain.amplitude_m must be"));
}
