//! Resampling: the mean stays, planes and means of blocks are exact, and smooth ground is met to third order.

use super::*;

fn of(columns: u32, rows: u32, height: impl Fn(f64, f64) -> f64) -> HeightMap {
    let heights = (0..rows).flat_map(|y| (0..columns).map(move |x| (f64::from(x), f64::from(y))));
    HeightMap::new(columns, rows, heights.map(|(x, y)| height(x, y) as f32).collect()).unwrap()
}

#[test]
fn resampling_keeps_the_mean_height() {
    let mut chance = RandomStream::new(3, 0);
    let mut side = || 1 + (chance.even() * 40.0) as u32;
    let sizes: Vec<[u32; 4]> = (0..300).map(|_| [side(), side(), side(), side()]).collect();
    for [columns, rows, new_columns, new_rows] in sizes {
        let map = random(columns, rows, [-400.0, 3000.0], 0, &mut chance);
        let new = map.resampled(new_columns, new_rows).unwrap();
        assert_eq!(([new.columns(), new.rows()], new.missing()), ([new_columns, new_rows], 0));
        let off = new.mean_m().unwrap() - map.mean_m().unwrap();
        assert!(off.abs() < 1e-3, "{columns} x {rows} to {new_columns} x {new_rows}: {off} m");
    }
}

#[test]
fn blocks_become_their_means_and_come_back() {
    let mut chance = RandomStream::new(4, 0);
    let map = random(12, 18, [0.0, 100.0], 0, &mut chance);
    assert_eq!(difference(&map, &map.resampled(12, 18).unwrap()), 0.0, "its own size");
    let coarse = map.resampled(4, 6).unwrap();
    for (x, y) in (0..4).flat_map(|x| (0..6).map(move |y| (x, y))) {
        let block = (0..9).map(|i| f64::from(map.height_m(3 * x + i % 3, 3 * y + i / 3).unwrap()));
        let mean = block.sum::<f64>() / 9.0;
        assert!((f64::from(coarse.height_m(x, y).unwrap()) - mean).abs() < 1e-5);
    }
    let back = map.resampled(12 * 5, 18 * 5).unwrap().resampled(12, 18).unwrap();
    assert!(difference(&map, &back) < 1e-4);
}

#[test]
fn planes_stay_planes_and_places_move_with_the_cells() {
    let plane = |x: f64, y: f64| 100.0 + 3.0 * x - 2.0 * y;
    let mut map = of(9, 6, plane).with_cell([10.0; 2]).unwrap();
    map = map.placed(Some([10.0; 2]), Some([500.0, 700.0]));
    let new = map.resampled(27, 4).unwrap();
    assert_eq!(new.cell(), Some([10.0 / 3.0, 15.0]));
    let [x0, y0] = new.south_west().unwrap();
    assert!((x0 - (500.0 - 10.0 / 3.0)).abs() < 1e-9 && (y0 - 702.5).abs() < 1e-9);
    for (i, height) in (0..).zip(new.heights_m()) {
        let place = [x0 + 10.0 / 3.0 * f64::from(i % 27), y0 + 15.0 * f64::from(i / 27)];
        let wanted = plane((place[0] - 500.0) / 10.0, (place[1] - 700.0) / 10.0);
        assert!((f64::from(*height) - wanted).abs() < 1e-4, "sample {i}: {height} {wanted}");
    }
}

/// The means of a wave over cells have a closed form. Heights on a grid four times finer are wrong by an error of third
/// order in the cell size.
#[test]
fn smooth_ground_is_met_to_third_order() {
    let error = |cells: u32| {
        let mean = |from: f64, to: f64| (to.sin() - from.sin()) / (to - from);
        let cell = 6.0 / f64::from(cells);
        let map = of(cells, 1, |x, _| 100.0 * mean(cell * x, cell * (x + 1.0)));
        let fine = map.resampled(4 * cells, 1).unwrap();
        let inner = cells..3 * cells;
        inner.fold(0.0_f64, |most, i| {
            let from = 0.25 * cell * f64::from(i);
            most.max((f64::from(fine.height_m(i, 0).unwrap()) - 100.0 * mean(from, from + 0.25 * cell)).abs())
        })
    };
    let (coarse, fine) = (error(30), error(60));
    assert!(coarse < 0.02 && coarse / fine > 7.0, "{coarse} {fine}");
}

#[test]
fn a_cliff_overshoots_by_less_than_a_fifth() {
    let cliff = of(12, 1, |x, _| if x < 6.0 { 0.0 } else { 100.0 });
    let [low, high] = cliff.resampled(12 * 16, 1).unwrap().range_m().unwrap();
    assert!(low > -18.0 && low < -12.0 && high < 118.0 && high > 112.0, "{low} {high}");
}

#[test]
fn holes_stay_holes_and_do_not_pull_their_neighbours() {
    let mut heights = vec![50.0; 64];
    (heights[27], heights[28], heights[35], heights[36]) = (f32::NAN, f32::NAN, f32::NAN, f32::NAN);
    let map = HeightMap::new(8, 8, heights).unwrap();
    for (columns, rows, missing) in [(8, 8, 4), (16, 16, 16), (4, 4, 0), (2, 2, 0), (24, 8, 12)] {
        let new = map.resampled(columns, rows).unwrap();
        assert_eq!(new.missing(), missing, "{columns} x {rows}");
        assert!(new.heights_m().iter().all(|h| h.is_nan() || (h - 50.0).abs() < 1e-4));
    }
    let none = HeightMap::new(3, 3, vec![f32::NAN; 9]).unwrap();
    assert_eq!((none.resampled(7, 2).unwrap().missing(), none.mean_m(), none.range_m()), (14, None, None));
    // The mean stays if each new sample is weighted by the known share of its cell, which is a third or all here.
    let row = HeightMap::new(6, 1, vec![10.0, f32::NAN, 20.0, 40.0, 60.0, 80.0]).unwrap();
    let new = row.resampled(2, 1).unwrap();
    assert!((new.heights_m()[0] - 15.0).abs() < 1e-4 && (new.heights_m()[1] - 60.0).abs() < 1e-4);
}
