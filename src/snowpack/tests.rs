use glam::DVec2;

use super::{
    column::{Column, Forcing, UNITS},
    field::{Field, Land, Step, WindOver},
    laws, slides,
};
use crate::weather::{Conditions, Falling, Weather, Wind, derive};

const STEP_S: f64 = 60.0;

fn flat(nodes: [usize; 2], cell_m: f64) -> Land {
    let heights_m = vec![0.0; nodes[0] * nodes[1]];
    Land { nodes, cell_m, heights_m, obstacles_m: Vec::new(), sheltered: Vec::new() }
}

fn weather(temperature_c: f64, wind_m_s: f64, humidity: f64) -> Conditions {
    let w =
        Weather { temperature_c, relative_humidity: humidity, wind: Wind::of(wind_m_s, 270.0), ..Weather::default() };
    derive(&w).unwrap()
}

fn snow(rate_mm_h: f64) -> Falling {
    Falling { snow_mm_h: rate_mm_h, ..Falling::NONE }
}

/// Leads a field by steps with the same weather, amid bare country.
fn lead(field: &mut Field, land: &Land, forcing: &Forcing, wind: DVec2, steps: usize) {
    lead_amid(&Column::default(), (field, land), forcing, wind, steps);
}

fn lead_amid(country: &Column, (field, land): (&mut Field, &Land), forcing: &Forcing, wind: DVec2, steps: usize) {
    for i in 0..steps {
        let step = Step {
            seconds: STEP_S,
            block: 1,
            forcings: std::slice::from_ref(forcing),
            wind: WindOver { mean: wind, local: None },
            country,
            slides: i % 10 == 9,
        };
        field.step(land, &step);
    }
}

#[test]
fn what_falls_lies_to_the_last_bit() {
    let land = flat([4, 3], 2.0);
    let mut field = Field::new(&land, Column::default());
    let c = weather(-8.0, 0.0, 1.0);
    let forcing = Forcing::new(&c, &snow(1.5), 0.0, STEP_S);
    lead(&mut field, &land, &forcing, DVec2::ZERO, 600);
    // 10 hours of 1.5 mm/h.
    let lies = field.columns[5].mass_kg_m2();
    assert!((lies / 15.0 - 1.0).abs() < 1e-5, "{lies}");
    assert_eq!(field.lying(), field.books.balance());
    let density = field.columns[5].density_kg_m3();
    assert!((61.0..110.0).contains(&density), "{density} kg/m^3");
}

#[test]
fn the_books_close_over_ten_thousand_steps_of_drift_slides_and_thaw() {
    // A hill of 6 m with a steep side, and a wall on it.
    let mut land = flat([32, 32], 2.0);
    for cell in 0..land.len() {
        let (x, y) = ((cell % 32) as f64 - 14.0, (cell / 32) as f64 - 16.0);
        land.heights_m[cell] = (6.0 - 0.5 * x.abs().min(2.2 * x.abs().max(y.abs()))).max(0.0);
    }
    land.obstacles_m =
        (0..land.len()).map(|c| if c % 32 == 22 && (8..20).contains(&(c / 32)) { 2.5 } else { 0.0 }).collect();
    let mut field = Field::new(&land, Column::of(0.3, 150.0));
    let forcing = |t, rate, wind, sun| Forcing::new(&weather(t, wind, 0.7), &snow(rate), sun, STEP_S);
    let weathers = [
        (forcing(-9.0, 2.0, 12.0, 0.0), DVec2::new(12.0, 3.0)),
        (forcing(-4.0, 0.0, 15.0, 100.0), DVec2::new(-9.0, 12.0)),
        (forcing(3.0, 0.5, 4.0, 300.0), DVec2::new(0.0, -4.0)),
        (forcing(-15.0, 1.0, 18.0, 0.0), DVec2::new(10.0, -15.0)),
    ];
    for i in 0..100 {
        let (forcing, wind) = &weathers[i % 4];
        lead(&mut field, &land, forcing, *wind, 100);
        assert_eq!(field.lying(), field.books.balance(), "after {} steps", (i + 1) * 100);
        assert!(field.columns.iter().all(Column::is_sound));
    }
    let b = field.books;
    assert!(b.blown_out > 0 && b.ran_off > 0 && b.sublimated > 0 && b.fallen > 0, "{b:?}");
    println!("books of 10000 steps, kg/m^2: {:?}", b.to_array().map(|v| v as f64 / UNITS / land.len() as f64));
}

#[test]
fn no_slope_is_above_repose_after_sliding_and_no_mass_is_lost() {
    let mut land = flat([40, 40], 0.5);
    land.heights_m[20 * 40 + 20] = 3.0;
    let mut field = Field::new(&land, Column::of(0.05, 100.0));
    field.columns[10 * 40 + 10] = Column::of(6.0, 200.0);
    let before = field.lying();
    while !slides::relax(&mut field.columns, &land) {}
    assert_eq!(field.lying(), before);
    let surface = |c: usize| land.heights_m[c] + field.columns[c].depth_m();
    let mut steepest: f64 = 0.0;
    for cell in (0..land.len()).filter(|c| field.columns[*c].depth > 0) {
        let (x, y) = (cell % 40, cell / 40);
        for (to, way) in [(cell + 1, x < 39), (cell + 40, y < 39)].iter().filter(|t| t.1).map(|t| (t.0, 0.5)) {
            // Of two the higher one must be able to slide.
            let high = if surface(cell) > surface(to) { cell } else { to };
            if field.columns[high].depth > 0 {
                steepest = steepest.max((surface(cell) - surface(to)).abs() / way);
            }
        }
    }
    let degrees = steepest.atan().to_degrees();
    println!("steepest slope after sliding: {degrees} deg");
    assert!((36.0..38.05).contains(&degrees), "{degrees}");
    assert_eq!(field.columns[20 * 40 + 20].depth, 0, "too steep a rock keeps nothing");
}

/// Snow that lies along a line of cells down a west wind after hours of drift, m.
fn along(land: &Land, wind_m_s: f64, temperature_c: f64, hours: usize) -> Vec<f64> {
    let country = Column::of(0.3, 120.0);
    let mut field = Field::new(land, country);
    let forcing = Forcing::new(&weather(temperature_c, wind_m_s, 1.0), &Falling::NONE, 0.0, STEP_S);
    lead_amid(&country, (&mut field, land), &forcing, DVec2::new(wind_m_s, 0.0), 60 * hours);
    assert_eq!(field.lying(), field.books.balance());
    let row = land.nodes[1] / 2;
    field.columns[row * land.nodes[0]..][..land.nodes[0]].iter().map(Column::mass_kg_m2).collect()
}

#[test]
fn drift_starts_at_the_threshold_wind_of_dry_and_wet_snow() {
    let land = flat([24, 3], 5.0);
    let moved = |wind: f64, wet: bool| {
        let mut column = Column::of(0.3, 120.0);
        column.water = if wet { column.ice / 20 } else { 0 };
        let mut field = Field::new(&land, column);
        let forcing = Forcing::new(&weather(0.0, wind, 1.0), &Falling::NONE, 0.0, STEP_S);
        lead(&mut field, &land, &forcing, DVec2::new(wind, 0.0), 30);
        field.books.blown_out
    };
    assert_eq!((moved(7.6, false), moved(9.8, true)), (0, 0));
    assert!(moved(7.9, false) > 0 && moved(10.1, true) > 0);
    assert!(moved(15.0, false) > 5 * moved(8.5, false));
}

#[test]
fn a_fence_casts_its_lee_drift() {
    let mut land = flat([80, 5], 1.0);
    land.obstacles_m = (0..land.len()).map(|c| if c % 80 == 30 { 2.0 } else { 0.0 }).collect();
    let lies = along(&land, 14.0, -6.0, 12);
    // Most of the drift of a solid fence lies within some seven heights behind it.
    let lee: f64 = lies[31..46].iter().sum::<f64>() / 15.0;
    let far = lies[70];
    println!("fence of 2 m, 12 h of 14 m/s: lee {lee:.1} kg/m^2, before {:.1}, far {far:.1}", lies[25]);
    assert!(lee > 1.5 * far && lee > 1.5 * lies[25], "{lies:?}");
    let deepest = (31..80).max_by(|a, b| lies[*a].total_cmp(&lies[*b])).unwrap();
    assert!((31..31 + 24).contains(&deepest), "deepest {} m behind", deepest - 30);
}

#[test]
fn windward_and_lee_of_a_hill_differ() {
    let mut land = flat([80, 5], 2.0);
    for cell in 0..land.len() {
        let x = ((cell % 80) as f64 - 40.0) / 10.0;
        land.heights_m[cell] = 6.0 / (1.0 + x * x);
    }
    let lies = along(&land, 11.0, -6.0, 8);
    let mean = |range: std::ops::Range<usize>| lies[range.clone()].iter().sum::<f64>() / range.len() as f64;
    let (windward, lee) = (mean(30..40), mean(43..56));
    println!("hill of 6 m, 8 h of 11 m/s: windward {windward:.1}, lee {lee:.1} kg/m^2");
    assert!(lee > 1.5 * windward, "{windward} {lee}: {lies:?}");
}

#[test]
fn a_roof_keeps_its_porch_bare_and_rain_takes_snow_away() {
    let mut land = flat([9, 9], 1.0);
    land.sheltered = (0..81).map(|c| c % 9 < 3).collect();
    let mut field = Field::new(&land, Column::default());
    let cold = Forcing::new(&weather(-3.0, 1.0, 1.0), &snow(2.0), 0.0, STEP_S);
    lead(&mut field, &land, &cold, DVec2::ZERO, 300);
    assert!(field.columns[1].mass() == 0 && field.columns[7].mass_kg_m2() > 9.9);
    let rain = Falling { rain_mm_h: 6.0, ..Falling::NONE };
    let warm = Forcing::new(&weather(6.0, 5.0, 1.0), &rain, 0.0, STEP_S);
    lead(&mut field, &land, &warm, DVec2::ZERO, 60);
    assert!(field.columns[7].wetness() > 0.9 && field.runoff_mm_h > 4.0, "{}", field.runoff_mm_h);
    lead(&mut field, &land, &warm, DVec2::ZERO, 1200);
    assert!(!field.is_any() && field.lying() == 0 && field.books.balance() == 0);
}

#[test]
fn snow_settles_and_ages_towards_old_snow() {
    let mut column = Column::of(0.5, 80.0);
    let c = weather(-5.0, 0.0, 1.0);
    let forcing = Forcing::new(&c, &Falling::NONE, 0.0, STEP_S);
    let (mass, mut last) = (column.mass(), column.density_kg_m3());
    let day = |column: &mut Column| (0..1440).for_each(|_| assert_eq!(column.step(&forcing, 1.0).ran_off, 0));
    for _ in 0..10 {
        day(&mut column);
        assert!(column.density_kg_m3() > last);
        last = column.density_kg_m3();
    }
    println!("density after 10 days at -5 C: {last:.0} kg/m^3, albedo {:.3}", column.albedo());
    assert!(column.mass() == mass && (130.0..260.0).contains(&last), "{last}");
    let wanted = laws::OLD_ALBEDO + (laws::NEW_ALBEDO - laws::OLD_ALBEDO) * (-8.64e5f64 / 3.6e6).exp();
    assert!((column.albedo() - wanted).abs() < 1e-3, "{}", column.albedo());
}
