//! Targets of the coverage-guided fuzzers (`make fuzz`), which the tests replay on `fuzz/corpus`: one function per kind
//! of input. Each panics if Welkin panics, if an error message is unfit for a host, or if the parsed data is
//! inconsistent.

use std::{ffi::CString, ptr::null_mut};

use welkin::{
    capi::{
        conditions::*,
        context::*,
        plan::*,
        report::*,
        status::{WK_ERROR_WRONG_ORDER, WK_OK},
        timeline::*,
    },
    error::{Error, Status},
    heights::{ByteOrder, HeightMap, HeightScale, HeightSettings, NoiseTerrain, RawHeights, RawSample, RowOrder},
    noise::NoiseImage,
    planet::Planet,
    sky,
};

use super::{
    calls::{CALLS, World},
    dice::Dice,
    judge::Judge,
    structs::Struct,
};

/// Maximum number of calls in a sequence, so that a long input is not slower than a short one.
const MOST_CALLS: usize = 60;
/// Maximum length of an error message, bytes.
const MOST_MESSAGE: usize = 300;

thread_local! {
    /// Objects for inputs that replace all earlier state.
    static WORLD: World = World::on_noop();
}

/// Panics if an error is unfit for a host.
fn fit(error: &Error) {
    let text = error.to_string();
    assert!(!text.is_empty() && text.len() < MOST_MESSAGE, "{} bytes: {text}", text.len());
    assert!(!matches!(error.status, Status::Internal | Status::Poisoned), "{text}");
}

/// Panics if an answer of the C interface is wrong.
fn judged(function: &str, status: i32) -> bool {
    judged_about(b"", function, status)
}

/// Panics if an answer of the C interface about an input is wrong.
fn judged_about(input: &[u8], function: &str, status: i32) -> bool {
    if let Some(fault) = Judge.fault_about(input, function, status) {
        panic!("{function}: {fault}");
    }
    status == WK_OK
}

/// A weather report: a context must accept the parsed weather, and its conditions must be finite.
pub fn metar(data: &[u8]) {
    let Ok(text) = CString::new(data) else { return };
    let (mut layers, mut weather, mut metar) =
        (Struct::list("wk_cloud_layer", 16), Struct::plain("wk_weather"), Struct::plain("wk_metar"));
    let size = layers.stride();
    // SAFETY: pointers to live locals, and a list of as many elements.
    let status = unsafe {
        let layers = layers.ptr().cast();
        wk_weather_from_metar(text.as_ptr(), layers, 16, size, weather.ptr().cast(), metar.ptr().cast())
    };
    if !judged_about(data, "wk_weather_from_metar", status) {
        return;
    }
    assert_eq!([weather.not_finite(), metar.not_finite()].concat(), Vec::<&str>::new());
    let world = World::on_noop();
    let (mut conditions, position) = (Struct::plain("wk_conditions"), [0.0_f64, 0.0, 2.0]);
    // SAFETY: a live handle and pointers to live locals.
    unsafe {
        let context = world.context();
        let status = wk_context_set_weather(context, weather.ptr().cast(), 0.0, 0.0);
        assert!(judged("wk_context_set_weather", status), "a weather that was read is refused");
        let status = wk_context_get_conditions(context, &position, 0.0, conditions.ptr().cast());
        assert!(judged("wk_context_get_conditions", status));
    }
    assert!(conditions.not_finite().iter().all(|f| *f == "visibility_m"), "{:?}", conditions.not_finite());
}

/// A planet file: the parsed planet, written and parsed again, must be the same.
pub fn planet(data: &[u8]) {
    let Ok(text) = std::str::from_utf8(data) else { return };
    match Planet::from_toml(text) {
        Err(e) => fit(&e),
        Ok(planet) => {
            planet.check().expect("what was read is in range");
            let again = Planet::from_toml(&planet.to_toml()).expect("what was written is read");
            assert_eq!(again.hash(), planet.hash());
        }
    }
}

/// FNV-1a, 64 bits (Fowler, Noll and Vo 1991): the checksum of saved states.
fn fnv(text: &str) -> u64 {
    text.bytes().fold(0xcbf2_9ce4_8422_2325, |h, b| (h ^ u64::from(b)).wrapping_mul(0x0000_0100_0000_01b3))
}

/// A state with corrected checksums, also that of its timeline. Otherwise a fuzzer would never get past the checksum.
fn sealed(text: &str) -> String {
    let Some((_, body)) = text.split_once('\n') else { return text.to_owned() };
    let timeline = body.split_once("# timeline ").and_then(|(before, rest)| {
        let (inner, after) = rest.split_once('\n')?.1.split_once("\"\"\"")?;
        Some(format!("{before}# timeline {:016x}\n{inner}\"\"\"{after}", fnv(inner)))
    });
    let body = timeline.unwrap_or_else(|| body.to_owned());
    format!("welkin state 2 {:016x}\n{body}", fnv(&body))
}

/// A saved state with valid checksums: after loading, it must save and load as the same state.
pub fn state(data: &[u8]) {
    let context = WORLD.with(World::context);
    let data = &std::str::from_utf8(data).map_or_else(|_| data.to_vec(), |text| sealed(text).into_bytes());
    // SAFETY: a live handle, and a slice's own pointer and length.
    let status = unsafe { wk_context_load(context, data.as_ptr().cast(), data.len()) };
    if !judged_about(data, "wk_context_load", status) {
        return;
    }
    let (before, saved) = (hash(context), saved(context).expect("a state that was loaded has no steps left"));
    // SAFETY: as above.
    let status = unsafe { wk_context_load(context, saved.as_ptr().cast(), saved.len()) };
    assert!(judged("wk_context_load", status), "a state that was saved is refused");
    assert_eq!(hash(context), before, "a state that was loaded is another");
}

/// Hash of a context's state.
fn hash(context: *mut wk_context) -> u64 {
    let mut hash = 0;
    // SAFETY: a live handle.
    assert!(judged("wk_context_state_hash", unsafe { wk_context_state_hash(context, &mut hash) }));
    hash
}

/// A context's state as bytes; `None` while steps of an update remain.
fn saved(context: *mut wk_context) -> Option<Vec<u8>> {
    let mut size = 0;
    // SAFETY: a live handle, and room as long as is said.
    unsafe {
        judged("wk_context_save", wk_context_save(context, null_mut(), 0, &mut size));
        let mut bytes = vec![0_u8; size];
        let status = wk_context_save(context, bytes.as_mut_ptr().cast(), size, &mut size);
        let is_saved = judged("wk_context_save", status);
        assert!(is_saved || status == WK_ERROR_WRONG_ORDER, "{status}");
        is_saved.then_some(bytes)
    }
}

/// Six states saved in the middle of changes.
pub fn states() -> Vec<Vec<u8>> {
    let changing = |f: &str| f.starts_with("wk_context_set") || f == "wk_context_update";
    let state = |seed| {
        let (mut dice, mut world) = (Dice::new(seed), World::on_noop());
        for (_, call) in (0..400).map(|_| dice.pick(CALLS)).filter(|c| changing(c.0)).collect::<Vec<_>>() {
            call(&mut dice, &mut world);
        }
        saved(world.context())
    };
    let states: Vec<_> = (0..60).filter_map(state).take(6).collect();
    assert_eq!(states.len(), 6, "states that can be saved");
    states
}

/// Bytes of a saved plan.
pub fn saved_plan() -> Vec<u8> {
    let (world, mut size) = (World::on_noop(), 0);
    let mut bytes = vec![0_u8; 1 << 16];
    // SAFETY: a live handle, and room as long as is said.
    let status = unsafe { wk_view_save_plan(world.view(), bytes.as_mut_ptr().cast(), bytes.len(), &mut size) };
    assert!(judged("wk_view_save_plan", status));
    bytes.truncate(size);
    bytes
}

/// A body of a cache file that [`cache`] accepts.
pub fn tables() -> Vec<u8> {
    sky::body_of_tables()
}

/// A saved plan.
pub fn plan(data: &[u8]) {
    let view = WORLD.with(World::view);
    // SAFETY: a live handle, and a slice's own pointer and length.
    judged_about(data, "wk_view_load_plan", unsafe { wk_view_load_plan(view, data.as_ptr().cast(), data.len()) });
}

/// The tables in a cache file, with a valid key and checksum.
pub fn cache(data: &[u8]) {
    let _ = sky::takes_tables(data);
}

/// A noise file: each level must have as many bytes as its size requires.
pub fn noise(data: &[u8]) {
    match NoiseImage::from_bytes(data) {
        Err(e) => fit(&e),
        Ok(read) => {
            for (level, bytes) in (0..).zip(read.levels()) {
                let texels: u32 = read.size_of_level(level).iter().product();
                assert_eq!(bytes.len(), texels as usize, "level {level}");
            }
        }
    }
}

/// A file of heights, by its own format and as raw numbers: what is read must be in range, and once written and read
/// again the same within a step.
pub fn heights(data: &[u8]) {
    heights_by(data, &HeightSettings::default());
    let Some((first, numbers)) = data.split_first() else { return };
    let kind = usize::from(*first);
    let sample = [RawSample::U16, RawSample::I16, RawSample::F32][kind % 3];
    let columns = 1 + kind / 12 % 8;
    let size = if sample == RawSample::F32 { 4 } else { 2 };
    let raw = RawHeights {
        columns: columns as u32,
        rows: (numbers.len() / size / columns).max(1) as u32,
        sample,
        byte_order: if kind / 3 % 2 == 0 { ByteOrder::Little } else { ByteOrder::Big },
        row_order: if kind / 6 % 2 == 0 { RowOrder::NorthFirst } else { RowOrder::SouthFirst },
    };
    heights_by(numbers, &HeightSettings { raw: Some(raw), no_data: Some(-9999.0), ..Default::default() });
}

/// Small files of heights in each format that is recognised by its first bytes.
pub fn height_files() -> Vec<Vec<u8>> {
    let terrain = NoiseTerrain { wavelength_m: 100.0, ..Default::default() };
    let map = |columns, rows| HeightMap::generate(columns, rows, 10.0, [0.0; 2], &terrain).expect("good terrain");
    let (wide, square) = (map(6, 4), map(4, 4));
    let png = |map: &HeightMap| {
        let settings = HeightSettings { scale: HeightScale::fitting(map), ..Default::default() };
        map.to_png(&settings).expect("every height has a number")
    };
    let ter = |map: &HeightMap| map.to_ter().expect("every height has a number");
    let chunks = ter(&wide);
    // A file whose chunk of heights comes before that of the numbers of points, without a chunk for the end.
    let (head, points, heights) = (&chunks[..16], &chunks[24..56], &chunks[56..chunks.len() - 4]);
    let turned = [head, &chunks[16..24], heights, points].concat();
    let values = |map: &HeightMap| map.heights_m().iter().map(|h| format!("{h:.2} ")).collect::<String>();
    let grid = |map: &HeightMap, place: &str| {
        let (columns, rows) = (map.columns(), map.rows());
        format!("ncols {columns}\nnrows {rows}\n{place}\nNODATA_value -9999\n{}\n", values(map)).into_bytes()
    };
    let square_cells = "xllcorner 1000.5\nyllcorner -20\ncellsize 10";
    let oblong_cells = "XLLCENTER 0\r\nYLLCENTER 1e3\r\nDX 10\r\nDY 20";
    vec![png(&wide), ter(&wide), ter(&square), turned, grid(&wide, square_cells), grid(&square, oblong_cells)]
}

/// Small raw files of heights in each layout.
pub fn raw_layouts() -> Vec<(RawHeights, Vec<u8>)> {
    let heights = (0..24).map(|i| (7 * i % 31) as f32).collect();
    let map = HeightMap::new(6, 4, heights).expect("good heights");
    let layout = |i: usize| {
        let raw = RawHeights {
            columns: 6,
            rows: 4,
            sample: [RawSample::U16, RawSample::I16, RawSample::F32][i % 3],
            byte_order: if i < 3 { ByteOrder::Little } else { ByteOrder::Big },
            row_order: RowOrder::NorthFirst,
        };
        let settings = HeightSettings { raw: Some(raw), ..Default::default() };
        (raw, map.to_raw(&settings).expect("every height has a number"))
    };
    (0..6).map(layout).collect()
}

/// Reads a file of heights by these settings. Returns whether it was read.
pub fn heights_by(data: &[u8], settings: &HeightSettings) -> bool {
    match HeightMap::from_bytes(data, settings) {
        Err(e) => {
            fit(&e);
            let text = e.to_string();
            let is_placed = ["byte ", "line ", "pixel "].iter().any(|place| text.contains(place));
            assert!(is_placed || e.status == Status::OutOfMemory, "no place: {text}");
            false
        }
        Ok(map) => {
            let samples = map.columns() as usize * map.rows() as usize;
            assert_eq!(map.heights_m().len(), samples);
            let known = map.heights_m().iter().filter(|h| !h.is_nan()).count();
            assert!(known + map.missing() == samples && map.range_m().is_none_or(|[a, b]| -1e5 <= a && b <= 1e5));
            let scale = HeightScale::fitting(&map);
            returned(&map, HeightSettings { scale, no_data: Some(0.0), raw: None });
            if let Ok(ter) = map.clone().with_cell([30.0; 2]).expect("a good cell").to_ter() {
                HeightMap::from_bytes(&ter, &HeightSettings::default()).expect("what was written is read");
            }
            true
        }
    }
}

/// Panics unless a map is written as PNG by these settings and read again within a step.
fn returned(map: &HeightMap, settings: HeightSettings) {
    let file = map.to_png(&settings).expect("every height has a number");
    let again = HeightMap::from_bytes(&file, &settings).expect("what was written is read");
    for (a, b) in map.heights_m().iter().zip(again.heights_m()) {
        let is_near = f64::from((a - b).abs()) <= settings.scale.step_m + 0.01;
        assert!(is_near || (a.is_nan() && b.is_nan()), "{a} m came back as {b} m");
    }
}

/// Calls of the whole header, with arguments taken from the data.
pub fn calls(data: &[u8]) {
    let mut dice = Dice::of_bytes(data);
    // With a new device for each input, most of the time would go into building noise and shaders.
    let mut world = WORLD.with(World::beside);
    for _ in 0..MOST_CALLS {
        if dice.is_spent() {
            break;
        }
        let (function, call) = dice.pick(CALLS);
        let answer = call(&mut dice, &mut world);
        assert!(answer.faults.is_empty(), "{function}: {:?}", answer.faults);
        judged(function, answer.status);
    }
}
