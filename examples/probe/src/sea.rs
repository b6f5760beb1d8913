//! `probe sea` and `probe sea-at`: the waves of a sea, and its surface.

use glam::DVec2;
use welkin::{
    Result,
    sea::{SeaSettings, WindSea, probe::SeaProbe},
    weather::Weather,
};

use crate::csv::{Column, Table};

/// A sea of a significant height, m, and a peak period, s, over a depth, m. Its waves come from north.
///
/// # Errors
/// [`welkin::Status::InvalidArgument`], naming `--hs`, `--tp` or `--depth`: steeper seas break.
fn probe(hs_m: f64, tp_s: f64, depth_m: f64, seed: u64) -> Result<SeaProbe> {
    let wind_sea = WindSea::Height { significant_m: hs_m, peak_period_s: Some(tp_s), gamma: None };
    let settings = SeaSettings { wind_sea, depth_m, ..SeaSettings::default() };
    SeaProbe::new(settings, &Weather::default(), seed).map_err(|e| {
        e.renamed("wind_sea.significant_m", "--hs")
            .renamed("wind_sea.peak_period_s", "--tp")
            .renamed("depth_m", "--depth")
    })
}

/// The waves of a sea, one a line: wave number `k`, 1/m; the `direction` in which it travels, rad from east to north;
/// `variance` of its height, m^2.
///
/// # Errors
/// [`welkin::Status::InvalidArgument`], naming `--hs`, `--tp` or `--depth`.
pub fn modes(hs_m: f64, tp_s: f64, depth_m: f64, seed: u64) -> Result<String> {
    let mut out = String::from("k,direction,variance\n");
    for mode in probe(hs_m, tp_s, depth_m, seed)?.modes() {
        out.push_str(&format!("{:?},{:?},{:?}\n", mode.k_per_m, mode.direction, mode.variance_m2));
    }
    Ok(out)
}

/// Needs columns `x` and `y`, m east and north (\[-1e12, 1e12\]), and `t`, s (\[-1e10, 1e10\]). Answers with the height
/// of the surface there, `height_m`, its normal `nx,ny,nz` and the velocity `u,v,w` of the water, m/s; east, north, up.
///
/// # Errors
/// As [`modes`]; [`welkin::Status::Parse`] with line and column for wrong input.
pub fn surface(hs_m: f64, tp_s: f64, depth_m: f64, seed: u64, text: &str) -> Result<String> {
    let mut probe = probe(hs_m, tp_s, depth_m, seed)?;
    let table = Table::read(text, "x,y,t")?;
    let columns = [
        Column::new("x", [-1e12, 1e12], "m"),
        Column::new("y", [-1e12, 1e12], "m"),
        Column::new("t", [-1e10, 1e10], "s"),
    ];
    let mut answers = Vec::new();
    for [x, y, t] in table.numbers(&columns)? {
        let p = probe.at(DVec2::new(x, y), t)?;
        let (n, v) = (p.normal, p.velocity_m_s);
        answers.push(format!("{:?},{:?},{:?},{:?},{:?},{:?},{:?}", p.height_m, n.x, n.y, n.z, v.x, v.y, v.z));
    }
    Ok(table.answered("height_m,nx,ny,nz,u,v,w", answers))
}
