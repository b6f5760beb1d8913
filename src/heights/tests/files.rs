//! Files that GDAL wrote, and files that Welkin writes.

use super::{super::HeightScale, *};

/// Readings of GDAL: file, columns, rows, then the numbers from the north-west; `testdata/make.py` wrote them.
const READINGS: &str = include_str!("../testdata/readings.txt");

fn made_by_gdal(name: &str) -> &'static [u8] {
    match name {
        "grid.asc" => include_bytes!("../testdata/grid.asc"),
        "grey16.png" => include_bytes!("../testdata/grey16.png"),
        "hole16.png" => include_bytes!("../testdata/hole16.png"),
        "grey8.png" => include_bytes!("../testdata/grey8.png"),
        "u16_little.raw" => include_bytes!("../testdata/u16_little.raw"),
        "u16_big.raw" => include_bytes!("../testdata/u16_big.raw"),
        "i16_little.raw" => include_bytes!("../testdata/i16_little.raw"),
        "i16_big.raw" => include_bytes!("../testdata/i16_big.raw"),
        "f32_little.raw" => include_bytes!("../testdata/f32_little.raw"),
        "f32_big.raw" => include_bytes!("../testdata/f32_big.raw"),
        "terrain.ter" => include_bytes!("../testdata/terrain.ter"),
        other => panic!("no file {other}"),
    }
}

/// Settings for one of GDAL's files, by its name.
fn settings_for(name: &str, columns: u32, rows: u32) -> HeightSettings {
    let sample = match &name[..3] {
        "u16" => RawSample::U16,
        "i16" => RawSample::I16,
        "f32" => RawSample::F32,
        _ => return HeightSettings::default(),
    };
    let byte_order = if name.contains("big") { ByteOrder::Big } else { ByteOrder::Little };
    let raw = RawHeights { columns, rows, sample, byte_order, row_order: RowOrder::NorthFirst };
    let no_data = (sample == RawSample::F32).then_some(-9999.0);
    HeightSettings { raw: Some(raw), no_data, ..Default::default() }
}

#[test]
fn files_of_gdal_read_as_gdal_reads_them() {
    let mut holes = 0;
    for line in READINGS.lines() {
        let words: Vec<&str> = line.split(' ').collect();
        let (name, columns, rows) = (words[0], words[1].parse().unwrap(), words[2].parse::<u32>().unwrap());
        let map = HeightMap::from_bytes(made_by_gdal(name), &settings_for(name, columns, rows)).unwrap();
        assert_eq!([map.columns(), map.rows()], [columns, rows], "{name}");
        for (i, word) in (0..).zip(&words[3..]) {
            let ours = map.height_m(i % columns, rows - 1 - i / columns);
            let theirs = (*word != "none").then(|| word.parse::<f64>().unwrap() as f32);
            assert_eq!(ours, theirs, "{name}, sample {i}");
            holes += usize::from(theirs.is_none());
        }
        match name {
            "grid.asc" => {
                assert_eq!(map.cell(), Some([90.0; 2]));
                assert_eq!(map.south_west(), Some([1045.0, 4595.0]), "the corner and half a cell");
            }
            "terrain.ter" => assert_eq!(map.cell(), Some([90.0; 2])),
            _ => assert_eq!((map.cell(), map.south_west()), (None, None), "{name}"),
        }
    }
    assert_eq!(holes, 4);
    // GDAL leaves out the last chunk, which old versions of Terragen need.
    assert!(!made_by_gdal("terrain.ter").ends_with(b"EOF "));
}

#[test]
fn the_first_row_of_a_picture_is_the_north() {
    let rows = [[1, 2, 3], [4, 5, 6]];
    let bytes: Vec<u8> = rows.as_flattened().iter().flat_map(|n: &u16| n.to_be_bytes()).collect();
    let layout = RawHeights {
        columns: 3,
        rows: 2,
        sample: RawSample::U16,
        byte_order: ByteOrder::Big,
        row_order: RowOrder::NorthFirst,
    };
    let read = |row_order| {
        let settings = HeightSettings { raw: Some(RawHeights { row_order, ..layout }), ..Default::default() };
        HeightMap::from_bytes(&bytes, &settings).unwrap()
    };
    let north = read(RowOrder::NorthFirst);
    assert_eq!((north.height_m(0, 0), north.height_m(2, 1)), (Some(4.0), Some(3.0)));
    let south = read(RowOrder::SouthFirst);
    assert_eq!((south.height_m(0, 0), south.height_m(2, 1)), (Some(1.0), Some(6.0)));
    assert_eq!((south.height_m(3, 0), south.height_m(0, 2)), (None, None));
    assert_eq!((south.range_m(), south.mean_m(), south.missing()), (Some([1.0, 6.0]), Some(3.5), 0));
}

#[test]
fn numbers_become_heights_by_the_scale_and_one_means_no_data() {
    let text = b"NCOLS 2\nnrows 2\ncellsize 0.5\n-9999 10\nnan -9999.5";
    let feet = HeightScale { step_m: 0.3048, base_m: 100.0 };
    let settings = HeightSettings { scale: feet, no_data: Some(-9999.0), raw: None };
    let map = HeightMap::from_bytes(text, &settings).unwrap();
    let expected = [None, Some((100.0 - 0.3048 * 9999.5) as f32), None, Some(103.048)];
    let found = [[0, 0], [1, 0], [0, 1], [1, 1]].map(|[column, row]| map.height_m(column, row));
    assert_eq!(found, expected);
    assert_eq!(map.missing(), 2);
    // The file's own number for no data counts beside the caller's.
    let own = b"ncols 3 nrows 1 cellsize 1 nodata_value -32768 -32768 -9999 7";
    assert_eq!(HeightMap::from_bytes(own, &settings).unwrap().missing(), 2);
    assert_eq!(HeightMap::from_bytes(own, &HeightSettings::default()).unwrap().missing(), 1);
}

/// Each way to write heights, with its step.
fn written(map: &HeightMap) -> Vec<(&'static str, HeightMap, f64)> {
    let (little, big) = (ByteOrder::Little, ByteOrder::Big);
    let (north, south) = (RowOrder::NorthFirst, RowOrder::SouthFirst);
    let scale = HeightScale::fitting(map);
    let middle = HeightScale { base_m: scale.base_m + 32_768.0 * scale.step_m, ..scale };
    let mut read = Vec::new();
    for (byte_order, row_order) in [(little, north), (little, south), (big, north), (big, south)] {
        let layout = |sample| raw(map, sample, byte_order, row_order);
        for (name, settings, step) in [
            ("u16", HeightSettings { scale, no_data: Some(0.0), ..layout(RawSample::U16) }, scale.step_m),
            ("i16", HeightSettings { scale: middle, no_data: Some(-32_768.0), ..layout(RawSample::I16) }, scale.step_m),
            ("f32", HeightSettings { no_data: Some(-9999.0), ..layout(RawSample::F32) }, 0.0),
            ("f32 with NaN", layout(RawSample::F32), 0.0),
        ] {
            read.push((name, HeightMap::from_bytes(&map.to_raw(&settings).unwrap(), &settings).unwrap(), step));
        }
    }
    let settings = HeightSettings { scale, no_data: Some(0.0), raw: None };
    read.push(("PNG", HeightMap::from_bytes(&map.to_png(&settings).unwrap(), &settings).unwrap(), scale.step_m));
    read
}

#[test]
fn heights_return_within_half_a_step() {
    let mut chance = RandomStream::new(1, 0);
    for i in 0..200 {
        let (columns, rows) = (1 + i % 13, 1 + i % 7);
        let low = 20_000.0 * chance.even() - 10_000.0;
        let range = [low, low + 10_f64.powf(7.0 * chance.even() - 3.0)];
        let map = random(columns, rows, range, if i % 2 == 0 { 5 } else { 0 }, &mut chance);
        // Floats of heights up to 20 km are themselves within a millimetre.
        for (name, read, step) in written(&map) {
            let off = difference(&map, &read);
            assert!(off <= 0.5 * step + 1e-3, "{name}, map {i}: {off} m, step {step} m");
            assert!(step > 0.0 || off == 0.0, "{name}, map {i}: {off} m");
        }
        if map.missing() == 0 {
            let cell = 10_f64.powf(4.0 * chance.even());
            let map = map.with_cell([cell; 2]).unwrap();
            let step = (range[1] - range[0] + 2.01 * cell) / 65_536.0;
            let ter = match map.to_ter() {
                Ok(ter) => ter,
                Err(e) => {
                    assert!(e.to_string().starts_with("cell must be at least "), "{e}");
                    assert!(range[1].abs().max(range[0].abs()) > 32_000.0 * cell, "{cell} {range:?}");
                    continue;
                }
            };
            let off = difference(&map, &HeightMap::from_bytes(&ter, &HeightSettings::default()).unwrap());
            assert!(off <= 0.5 * step + 1e-3, "ter, map {i}: {off} m, step {step} m");
        }
    }
}

/// Chunks of a Terragen file: SIZE, XPTS, YPTS, SCAL, ALTW.
fn chunks(ter: &[u8]) -> Vec<Vec<u8>> {
    let (mut at, mut chunks) = (16, Vec::new());
    for size in [8, 8, 8, 16] {
        chunks.push(ter[at..at + size].to_vec());
        at += size;
    }
    let heights = ter.len() - 4;
    chunks.push(ter[at..heights].to_vec());
    chunks
}

/// All orders of a list.
fn orders(list: &[Vec<u8>]) -> Vec<Vec<Vec<u8>>> {
    let Some((last, rest)) = list.split_last() else { return vec![vec![]] };
    let insert = |order: Vec<Vec<u8>>| {
        (0..=order.len()).map(move |at| [&order[..at], std::slice::from_ref(last), &order[at..]].concat())
    };
    orders(rest).into_iter().flat_map(insert).collect()
}

#[test]
fn terragen_chunks_are_read_in_any_order_and_written_in_one() {
    let mut chance = RandomStream::new(2, 0);
    for (columns, rows) in [(4, 3), (3, 5), (5, 5), (4, 4), (1, 1), (7, 2)] {
        let map = random(columns, rows, [-50.0, 900.0], 0, &mut chance).with_cell([10.0; 2]).unwrap();
        let ter = map.to_ter().unwrap();
        let markers: Vec<&[u8]> = vec![b"SIZE", b"XPTS", b"YPTS", b"SCAL", b"ALTW"];
        let mut parts = chunks(&ter);
        assert_eq!(parts.iter().map(|p| &p[..4]).collect::<Vec<_>>(), markers);
        assert!(ter.ends_with(b"EOF ") && ter.len().is_multiple_of(4));
        assert_eq!(parts[0][4..6], (columns.min(rows) as u16 - 1).to_le_bytes());
        let truth = HeightMap::from_bytes(&ter, &HeightSettings::default()).unwrap();
        parts.push([&b"CRAD"[..], &6370.0_f32.to_le_bytes()].concat());
        let mut read = 0;
        for order in orders(&parts) {
            for end in [&b"EOF "[..], b""] {
                let file = [&b"TERRAGENTERRAIN "[..], &order.concat(), end].concat();
                let found = HeightMap::from_bytes(&file, &HeightSettings::default()).unwrap();
                assert_eq!((difference(&truth, &found), found.cell()), (0.0, Some([10.0; 2])));
                read += 1;
            }
        }
        assert_eq!(read, 2 * 720);
    }
}

#[test]
fn terragen_squares_need_no_points_and_no_scale() {
    let mut file = b"TERRAGENTERRAIN SIZE\x01\0\0\0ALTW\0\x10\xff\xff".to_vec();
    for number in [0_i16, 16_384, -16_384, 32_767] {
        file.extend(number.to_le_bytes());
    }
    file.extend(b"EOF ");
    let map = HeightMap::from_bytes(&file, &HeightSettings::default()).unwrap();
    // 30 (number 4096 / 65 536 - 1)
    assert_eq!(map.heights_m(), [-30.0, 30_690.0, -30_750.0, 61_408.125]);
    assert_eq!(map.cell(), Some([30.0; 2]));
}
