//! The studio without a display: its table against the header, its settings file, its scripts, and random hands on its
//! panel.

use std::{collections::BTreeSet, fs, path::PathBuf, sync::Arc};

use welkin::{
    capi::{
        abi::HEADER,
        by_name::{LISTS, SETTERS},
    },
    gpu::{Device, DeviceOptions},
};
use welkin_studio::{
    bytes,
    headless::Headless,
    manual,
    pages::PAGES,
    script,
    settings::{Part, Settings},
    table::{self, Row},
};

/// Structs that a host sets and the studio does not, and why.
const NOT_SET: [(&str, &str); 10] = [
    ("wk_cloud_map", "a picture in memory"),
    ("wk_ground_grid", "heights in memory"),
    ("wk_occluder_map", "a picture in memory"),
    ("wk_sea_region", "its corners are a list of their own"),
    ("wk_shelter", "those of the studio's machine and hall"),
    ("wk_soil", "lists of kinds and horizons"),
    ("wk_terrain", "the studio's world has one"),
    ("wk_terrain_cells", "heights in memory"),
    ("wk_wind_grid", "velocities in memory"),
    ("wk_weather", "set with its layers and overrides"),
];

/// A device that draws nothing, for what needs no picture.
fn noop() -> Arc<Device> {
    let options = DeviceOptions { backends: wgpu::Backends::NOOP, ..DeviceOptions::default() };
    Device::headless(&options).expect("a device without a driver")
}

fn studio() -> Headless {
    Headless::new(&noop(), [1024, 768], 1.0).expect("a studio")
}

fn folder(name: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    fs::create_dir_all(&folder).expect("the target directory is writable");
    folder
}

fn all_rows() -> Vec<(Part, Row)> {
    Part::kinds()
        .into_iter()
        .flat_map(|part| table::rows(part.structure()).iter().map(move |row| (part, row.clone())))
        .collect()
}

#[test]
fn each_struct_that_a_call_sets_is_in_the_table_or_named() {
    // `wk_status wk_context_set_sea(wk_context *context, const wk_sea *sea);`, over several lines too.
    let mut taken = BTreeSet::new();
    for call in HEADER.split("WK_API").skip(1).filter_map(|text| text.split(';').next()) {
        if call.contains("_set_") {
            let parameters = call.split_once('(').map_or("", |split| split.1).split(',');
            taken.extend(parameters.filter_map(|p| p.trim().strip_prefix("const wk_")?.split_whitespace().next()));
        }
    }
    assert!(taken.len() > 20, "{taken:?}");
    for name in taken.iter().map(|name| format!("wk_{name}")) {
        let is_set = SETTERS.iter().any(|s| s.1 == name) || LISTS.iter().any(|list| list.of == name);
        let is_named = NOT_SET.iter().any(|n| n.0 == name);
        assert!(is_set != is_named, "{name}: set {is_set}, named as not set {is_named}");
    }
    for part in Part::kinds() {
        let mut settings = Settings::default();
        settings.switch(part, true);
        let stands = PAGES.iter().filter(|page| page.parts(&settings).contains(&part)).count();
        assert_eq!(stands, 1, "{part:?} stands on one page");
    }
}

#[test]
fn rows_have_what_the_header_says() {
    let rows = all_rows();
    assert!(rows.len() > 150, "{}", rows.len());
    for (_, row) in &rows {
        let name = format!("{}.{}", row.of, row.field.name);
        assert!(row.help.len() > 10, "{name} has no help");
        assert_eq!(
            row.limits.is_none(),
            !row.field.range.contains(',') || row.field.range.contains('_'),
            "{name}: {}",
            row.field.range
        );
        if row.help.starts_with("Optional") {
            assert!(row.switch.is_some(), "{name} is optional and has no switch");
        }
        assert!(row.choices.iter().all(|c| !c.name.is_empty() && !c.help.is_empty()), "{name}: {:?}", row.choices);
        let names: BTreeSet<&str> = row.choices.iter().map(|c| c.name.as_str()).collect();
        assert_eq!(names.len(), row.choices.len(), "{name}: {:?}", row.choices);
    }
    let row = |of: &str, name: &str| {
        let found = rows.iter().find(|(_, row)| row.of == of && row.field.name == name);
        found.map(|(_, row)| row.clone()).unwrap_or_else(|| panic!("{of}.{name}"))
    };
    let visibility = row("wk_weather", "visibility_m");
    assert_eq!((visibility.unit, visibility.limits, visibility.default(0)), ("m", Some([1.0, 1e6]), 40_000.0));
    assert_eq!(visibility.label, "visibility");
    assert_eq!(row("wk_rain", "most_drops").limits, Some([1000.0, 8e6]));
    let kind = row("wk_weather", "fog_kind");
    assert_eq!(kind.choices[0].name, "none");
    assert_eq!(row("wk_weather", "wind_speed_m_s").unit, "m/s");
    let bit = |name| row("wk_weather", name).switch.map(|s| (s.of.name, s.bit));
    assert!(bit("swell_period_s").is_some() && bit("swell_period_s") == bit("swell_height_m"));
}

/// Random whole numbers (xorshift, Marsaglia 2003).
struct Dice(u64);

impl Dice {
    fn below(&mut self, n: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 16) as usize % n.max(1)
    }
}

/// Sets a row to something that may be set.
fn shake(dice: &mut Dice, settings: &mut Settings, part: Part, row: &Row) {
    settings.switch(part, true);
    let bytes = settings.bytes_mut(part).expect("it is on");
    table::turn(bytes, row, dice.below(4) > 0);
    for element in 0..row.field.count {
        if !row.choices.is_empty() {
            bytes::set_integer(bytes, &row.field, element, row.choices[dice.below(row.choices.len())].value);
        } else {
            let [low, high] = row.limits.unwrap_or([0.0, 10.0]);
            bytes::set_number(bytes, &row.field, element, low + (high - low) * dice.below(1000) as f64 / 1000.0);
        }
    }
}

#[test]
fn a_settings_file_brings_back_what_was_set() {
    let (mut dice, rows) = (Dice(7), all_rows());
    for _ in 0..100 {
        let mut settings = Settings::default();
        for _ in 0..dice.below(30) {
            let (part, row) = &rows[dice.below(rows.len())];
            shake(&mut dice, &mut settings, *part, row);
        }
        settings.switch(Part::Call("wk_context_set_terrain_drawing"), dice.below(2) == 0);
        let text = settings.to_toml();
        let back = Settings::from_toml(&text).unwrap_or_else(|e| panic!("{e}\n{text}"));
        // Values of fields that are off are not kept.
        for part in settings.parts() {
            let (a, b) = (settings.bytes(part), back.bytes(part));
            assert_eq!(a.is_some(), b.is_some(), "{part:?} in\n{text}");
            let (Some(a), Some(b)) = (a, b) else { continue };
            for row in table::rows(part.structure()).iter().filter(|row| table::is_on(a, row)) {
                for element in 0..row.field.count {
                    let [a, b] = [a, b].map(|bytes| bytes::integer(bytes, &row.field, element));
                    assert_eq!(a, b, "{}.{}\n{text}", row.of, row.field.name);
                }
            }
        }
        assert_eq!(back.to_toml(), text);
    }
}

#[test]
fn wrong_files_are_refused_by_name_and_the_scene_stays() {
    let mut studio = studio();
    let before = studio.app.settings.clone();
    let path = folder("studio-files").join("wrong.toml");
    for (text, word) in [
        ("weather = 3", "weather"),
        ("[whether]\nvisibility_m = 1.0", "whether"),
        ("[weather]\nvisibility = 1.0", "visibility_m"),
        ("[weather]\nvisibility_m = \"far\"", "[1, 1000000]"),
        ("[weather]\nfog_kind = \"thick\"", "shallow, patches"),
        ("[[weather]]", "weather"),
        ("[weather", "line 1"),
    ] {
        fs::write(&path, text).expect("the folder is ours");
        let said = studio.app.load(&path).expect_err(text);
        assert!(said.contains(word) && said.contains("wrong.toml"), "{text}: {said}");
        assert_eq!(studio.app.settings, before, "{text}");
    }
    assert!(studio.app.load(&path.with_file_name("none.toml")).unwrap_err().contains("none.toml"));
}

#[test]
fn commands_name_what_they_accept_and_change_nothing_if_wrong() {
    let mut studio = studio();
    let before = studio.app.settings.clone();
    for (line, word) in [
        ("sett weather.visibility_m 3", "preset NAME"),
        ("set weather.visibility_m", "set weather.visibility_m 3000"),
        ("set wether.visibility_m 3", "weather"),
        ("set weather.visibilty_m 3", "visibility_m"),
        ("preset sunny", "clear"),
        ("metar nonsense", "report"),
        ("place home", "valley"),
        ("page Settings", "Rain and snow"),
        ("eye 1 2", "3 numbers"),
        ("eye 0 0 inf", "3 numbers"),
        ("fov 400", "[1, 150]"),
        ("theme pink", "light or dark"),
        ("pass -3", "[0, 86400]"),
        ("undo", "nothing"),
        ("off whether", "weather"),
    ] {
        let said = script::run(&mut studio, line).expect_err(line);
        assert!(said.contains(word), "{line}: {said}");
        assert_eq!(studio.app.settings, before, "{line}");
    }
    // What the library refuses ends a script with the line, and the panel has it beside the field.
    let said = script::run_all(&mut studio, "preset rain\nset weather.visibility_m -4\n").unwrap_err();
    assert!(said.starts_with("line 2: weather: ") && said.contains("[1, 1000000]"), "{said}");
    assert!(studio.app.refusal(Part::Weather, "visibility_m").is_some_and(|m| m.contains("[1, 1000000]")));
    script::run_all(&mut studio, "undo\n").expect("the last weather is accepted");
    assert!(studio.app.refused.is_empty(), "{:?}", studio.app.refused);
}

#[test]
fn elements_of_lists_are_set_refused_and_taken_away_one_by_one() {
    let mut studio = studio();
    let text = "
        set light2.position_m [3.0, 4.0, 6.0]
        set light2.inner_deg 20
        set rain_area1.rate_mm_h 12
        on sea_hull3
        set weather_of_region1.visibility_m 300
        set weather_of_region1.fog_kind fog
        set weather_region1.has fog
        pass 0.1";
    script::run_all(&mut studio, text).expect("all of it is accepted");
    let counts = |studio: &Headless| [0, 1, 2, 3].map(|list| studio.app.settings.items(list));
    assert_eq!(counts(&studio), [1, 1, 2, 3], "lights and hulls before the named one are there too");
    let regions = studio.app.world().calls().with(|_, context| context.weather_region_count());
    assert_eq!(regions, Some(1));
    // Hulls have numbers of their own, or the library would refuse them.
    assert!(studio.app.refused.is_empty(), "{:?}", studio.app.refused);
    let back = Settings::from_toml(&studio.app.settings.to_toml()).expect("its own file");
    assert_eq!(back.to_toml(), studio.app.settings.to_toml());
    for (line, part, field) in [
        ("set weather_of_region1.visibility_m -3", Part::ItemWeather(1, 0), "visibility_m"),
        ("set light2.outer_deg 300", Part::Item(2, 1), "outer_deg"),
    ] {
        let said = script::run_all(&mut studio, line).expect_err(line);
        assert!(said.contains(&part.key()), "{said}");
        assert!(studio.app.refusal(part, field).is_some(), "{line}: {:?}", studio.app.refused);
        script::run_all(&mut studio, "undo").expect("the last settings are accepted");
    }
    let second = studio.app.settings.bytes(Part::Item(2, 1)).cloned();
    studio.app.change(|settings| settings.remove(Part::Item(2, 0)));
    assert_eq!(studio.app.settings.bytes(Part::Item(2, 0)).cloned(), second);
    assert!(script::run(&mut studio, "on light65").unwrap_err().contains("light1"));
}

#[test]
fn each_step_is_undone_and_done_again() {
    let mut studio = studio();
    let lines = [
        "set weather.visibility_m 3000",
        "on sea",
        "set sea.beaufort 6",
        "preset fog",
        "set layer3.cover 0.5",
        "off sea",
    ];
    let mut states = vec![studio.app.settings.clone()];
    for line in lines {
        script::run(&mut studio, line).unwrap();
        states.push(studio.app.settings.clone());
    }
    for state in states.iter().rev().skip(1) {
        assert!(studio.app.undo());
        assert_eq!(studio.app.settings, *state);
    }
    assert!(!studio.app.undo());
    for state in &states[1..] {
        assert!(studio.app.redo());
        assert_eq!(studio.app.settings, *state);
    }
    assert!(!studio.app.redo());
}

/// Events of a hand that points, drags, types and presses keys anywhere.
fn hand(dice: &mut Dice) -> Vec<egui::Event> {
    use egui::{Event, Key, Modifiers, PointerButton, Pos2};
    let place = |dice: &mut Dice| Pos2::new(dice.below(1024) as f32, dice.below(768) as f32);
    let button = |pos, pressed| Event::PointerButton {
        pos,
        button: PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    };
    let key = |key, pressed| Event::Key { key, physical_key: None, pressed, repeat: false, modifiers: Modifiers::NONE };
    let at = place(dice);
    match dice.below(6) {
        0 | 1 => vec![Event::PointerMoved(at), button(at, true), button(at, false)],
        2 => {
            let to = at + egui::vec2(dice.below(200) as f32 - 100.0, 0.0);
            vec![Event::PointerMoved(at), button(at, true), Event::PointerMoved(to), button(to, false)]
        }
        3 => vec![Event::Text(["1e6", "-5", "fog", "METAR", "0.3", "x"][dice.below(6)].into())],
        4 => {
            let one =
                [Key::Tab, Key::Enter, Key::Escape, Key::Backspace, Key::ArrowUp, Key::Space, Key::W][dice.below(7)];
            vec![key(one, true), key(one, false)]
        }
        _ => vec![
            Event::PointerMoved(at),
            Event::MouseWheel {
                unit: egui::MouseWheelUnit::Point,
                delta: egui::vec2(0.0, dice.below(400) as f32 - 200.0),
                phase: egui::TouchPhase::Move,
                source: egui::MouseWheelSource::Unknown,
                modifiers: Modifiers::NONE,
            },
        ],
    }
}

#[test]
fn no_hand_on_the_panel_brings_a_refusal_that_is_not_shown() {
    let mut studio = studio();
    let (mut dice, mut refusals, mut pages) = (Dice(11), 0, BTreeSet::new());
    for action in 0..1000 {
        if action % 25 == 0 {
            studio.app.open(PAGES[action / 25 % PAGES.len()].title).unwrap();
        }
        pages.insert(studio.app.page);
        studio.frame_with(0.02, hand(&mut dice)).unwrap_or_else(|e| panic!("action {action}: {e}"));
        let app = &studio.app;
        for (part, refusal) in &app.refused {
            refusals += 1;
            let fields = table::rows(part.structure());
            let shown = fields.iter().any(|row| app.refusal(*part, row.field.name).is_some());
            assert!(shown || app.refusal_of_all(*part).is_some(), "action {action}: {part:?} {refusal:?}");
        }
    }
    assert_eq!(pages.len(), PAGES.len());
    println!("{refusals} frames with a refusal");
}

#[test]
fn nothing_is_drawn_while_nothing_changes() {
    let mut studio = studio();
    studio.app.pace = 0.0;
    let size = [64, 36];
    assert!(studio.app.step(0.1, size).unwrap(), "the first picture");
    assert!(!studio.app.step(0.1, size).unwrap(), "nothing has changed");
    script::run(&mut studio, "set weather.visibility_m 3000").unwrap();
    assert!(studio.app.step(0.1, size).unwrap(), "the next frame shows it");
    assert!(!studio.app.step(0.1, size).unwrap());
    studio.app.turn(1.0, 0.0);
    assert!(studio.app.step(0.1, size).unwrap());
}

#[test]
fn the_manual_s_page_is_that_of_the_table() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/studio/settings.md");
    let committed = fs::read_to_string(path).expect("the page is committed");
    assert_eq!(committed, manual::page(), "write it anew: studio --settings-page > docs/studio/settings.md");
}

#[test]
fn a_script_writes_the_picture_and_the_window() {
    let gpu = Device::headless(&DeviceOptions::default()).expect("a software driver is installed");
    let mut studio = Headless::new(&gpu, [640, 360], 1.0).expect("a studio");
    let folder = folder("studio-pictures");
    let file = |name: &str| folder.join(name).display().to_string();
    let text = format!(
        "preset crystal\nplace hill\nlook 300 8\npass 0.1\npicture {}\nwindow {}\nset given.x 1",
        file("picture.png"),
        file("window.png")
    );
    let said = script::run_all(&mut studio, &text).unwrap_err();
    assert!(said.starts_with("line 7: "), "{said}");
    let window = image::open(file("window.png")).expect("a picture").into_rgb8();
    assert_eq!(window.dimensions(), (640, 360));
    let picture = image::open(file("picture.png")).expect("a picture").into_rgb8();
    assert!(picture.width() < 400 && picture.height() > 250, "{:?}", picture.dimensions());
    let row = |y: u32| {
        let all: Vec<_> = (0..picture.width()).map(|x| picture.get_pixel(x, y).0).collect();
        [0, 1, 2].map(|c| all.iter().map(|p| f64::from(p[c])).sum::<f64>() / f64::from(picture.width()))
    };
    let (sky, ground) = (row(20), row(picture.height() - 5));
    assert!(sky[2] > sky[0] + 15.0, "the sky is blue: {sky:?}");
    assert!(ground[1] > ground[2] + 2.0 && ground[1] > 10.0, "the ground is not: {ground:?}");
}
