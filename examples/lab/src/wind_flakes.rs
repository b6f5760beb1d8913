//! Cost of flakes in a solved wind, compared with the snow simulator of the sources: by number of flakes and by number
//! of wind cells.

use std::{fmt::Write as _, time::Instant};

use glam::DVec3;
use welkin::{
    Result,
    flow::{FlowBox, FlowField, FlowObstacles, FlowSettings},
    snow::{SnowModel, SnowSettings},
};

use crate::{growth::Series, plot::short, rain, scenes, store::Table};

/// Cells of the wind; the last entry is the sources'.
const GRIDS: [[u32; 3]; 3] = [[64, 64, 16], [128, 64, 32], [128, 128, 32]];
const NUMBERS: [u32; 3] = [250_000, 1_000_000, 4_000_000];
const WIND: &str = "wind field";
const STATELESS: &str = "flakes";

fn stepped(cells: [u32; 3]) -> String {
    format!("flakes in {} cells", by(cells))
}

fn by([x, y, z]: [u32; 3]) -> String {
    format!("{x} x {y} x {z}")
}

/// Times frames of large flakes in a light wind, and steps of the wind around a house.
pub fn measure(series: &mut Series<'_>) -> Result<()> {
    let device = series.lab.device.clone();
    let host = |number| -> Result<rain::Host> {
        let mut host = rain::Host::new(&device, &scenes::snow()[0], (640, 360))?;
        let settings = SnowSettings { model: SnowModel::Flakes, most_flakes: Some(number), ..SnowSettings::default() };
        host.set_snow(settings)?;
        Ok(host)
    };
    for number in NUMBERS {
        series.point((STATELESS, "number", f64::from(number)), || {
            let mut host = host(number)?;
            Ok((move |_: usize| host.timed_on(), 0.0))
        })?;
    }
    for cells in GRIDS {
        for number in NUMBERS {
            series.point((&stepped(cells), "number", f64::from(number)), || {
                let mut host = host(number)?;
                host.solve_wind(cells)?;
                Ok((move |_: usize| host.timed_on(), 0.0))
            })?;
        }
    }
    for cells in GRIDS {
        series.point((WIND, "cells", count(cells)), || {
            let settings =
                FlowSettings { cells, tolerance: 1e-3, has_eddies: true, roughness_m: 0.03, ..FlowSettings::default() };
            let house = [FlowBox::level(DVec3::new(100.0, 100.0, 10.0), DVec3::new(20.0, 20.0, 12.0), 20.0)];
            let obstacles = FlowObstacles { terrain: None, boxes: &house };
            let mut field = FlowField::new(&settings, &obstacles, |p| DVec3::X * (4.0 + 0.1 * p.z))?;
            let work = move |_: usize| {
                let start = Instant::now();
                field.step(0.5)?;
                Ok(start.elapsed().as_secs_f64() * 1e3)
            };
            Ok((work, 0.0))
        })?;
    }
    Ok(())
}

fn count(cells: [u32; 3]) -> f64 {
    f64::from(cells.iter().product::<u32>())
}

/// Writes the table: ms on the chart's machine beside the sources' times on theirs.
pub fn section(out: &mut String, t: &Table) {
    let ms = |what: &str, against: &str, amount: f64| {
        let found = t.rows.iter().find(|r| r[1] == what && r[2] == against && t.number(r, "amount") == Some(amount))?;
        Some(short(t.number(found, "ms")?))
    };
    let row = |what: &str| NUMBERS.map(|n| ms(what, "number", f64::from(n)).unwrap_or("-".into())).join(" | ");
    out.push_str(
        "### Flakes in a wind\n\n\
         Milliseconds of a frame with fog and flakes at 640x360 on this software driver; a step of the wind leads over half a second, and is due \
         only while the wind changes or is asked to run.\n\n\
         | wind | its step | 250,000 flakes | 1 million | 4 million |\n|---|---|---|---|---|\n",
    );
    let _ = writeln!(out, "| the weather's | - | {} |", row(STATELESS));
    for cells in GRIDS {
        let step = ms(WIND, "cells", count(cells)).unwrap_or("-".into());
        let _ = writeln!(out, "| solved, {} cells | {step} | {} |", by(cells), row(&stepped(cells)));
    }
    out.push_str(
        "\nThe snow simulator of the sources, 4 million flakes in a wind of 128 x 32 x 128 cells on a GTX 480 at 1024x768: 13.8 ms for wind and \
         flakes, 33.8 ms with the picture. On a GPU Welkin's are in [gpu.md](gpu.md).\n\n",
    );
}
